// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/height_field.hpp"

namespace terrain {

/// True if ground of the field is nearer than `distance` to a leg that lies nowhere below it.
bool is_within(const altiplan::HeightField& field, const altiplan::Vec3& a, const altiplan::Vec3& b,
               double distance);
}  // namespace terrain
