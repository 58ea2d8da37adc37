// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "altiplan/api.hpp"

namespace altiplan::formats {

/// Seconds since 1970-01-01 UTC of an ISO 8601 time: a date, or date and time of day, seconds and
/// their fraction optional, ending in Z or an offset (+02:00); none if the text is not such a time.
ALTIPLAN_API std::optional<double> parse_iso_time(std::string_view text);
/// The reverse, to the nearest second: 2026-05-01T10:00:00Z.
ALTIPLAN_API std::string iso_time(double seconds);
}  // namespace altiplan::formats
