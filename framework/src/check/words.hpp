// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/constraint.hpp"

namespace altiplan {

/// A number for a message; absurdly large ones are abbreviated.
std::string fixed(double value, int digits = 2);
/// A distance, with enough digits for any magnitude.
std::string distance_text(double value);
std::string place(const Vec3& p);
/// A violation for a quantity beyond its limit, with its message. `unit` as in Violation.
Violation beyond(const char* rule, std::size_t at, double value, double limit, const char* unit,
                 const std::string& what, bool too_small);
}  // namespace altiplan
