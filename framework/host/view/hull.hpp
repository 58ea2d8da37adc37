// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan::host {

/// The surface of the convex hull of points: indices of three corners a triangle, counter-clockwise
/// from outside; empty where the points have no volume. Exact to a millionth of their extent.
std::vector<std::array<std::size_t, 3>> hull_triangles(const std::vector<Vec3>& points);
}  // namespace altiplan::host
