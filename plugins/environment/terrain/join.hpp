// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/height_field.hpp"
#include "altiplan/world.hpp"

namespace terrain {

/// True if some ground ends within a post's spacing of one of the sides of a grid of posts.
bool may_join(const std::array<double, 2>& origin, const std::array<double, 2>& spacing,
              int columns, int rows, const altiplan::World& world);

/// Tiles often leave a post's spacing between the last post of one and the first of the next. If
/// ground of the world ends within a spacing of a whole side, adds a row of posts there, with that
/// ground's heights. Returns true if it did.
bool join(altiplan::HeightField& field, const altiplan::World& world);
}  // namespace terrain
