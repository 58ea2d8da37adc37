// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan::kit {

/// A clamped uniform cubic B-spline: it begins at the first control point and ends at the last.
/// Piece i runs from the knot near control point i to that near i + 1 and stays within the convex
/// hull of the control points i - 1 to i + 2.
class ALTIPLAN_API CubicSpline {
 public:
  /// Throws Error for fewer than two control points.
  explicit CubicSpline(std::vector<Vec3> control);

  std::size_t pieces() const { return control_.size() - 3; }
  /// Point of piece i at u in [0, 1].
  Vec3 at(std::size_t piece, double u) const;

 private:
  std::vector<Vec3> control_;  ///< with one more at either end, mirrored there
};
}  // namespace altiplan::kit
