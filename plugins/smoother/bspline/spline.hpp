// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan::bspline {

/// A clamped uniform cubic B-spline: it begins at the first control point and ends at the last.
/// Piece i runs from the knot near control point i to that near i + 1 and stays within the convex
/// hull of the control points i - 1 to i + 2.
class CubicSpline {
 public:
  /// At least two control points.
  explicit CubicSpline(std::vector<Vec3> control) : control_(std::move(control)) {
    // At a knot the curve is (P[i-1] + 4 P[i] + P[i+1]) / 6: with the neighbour mirrored at the
    // end, that is the end itself.
    const Vec3 first = 2 * control_[0] - control_[1];
    const Vec3 last = 2 * control_[control_.size() - 1] - control_[control_.size() - 2];
    control_.insert(control_.begin(), first);
    control_.push_back(last);
  }

  std::size_t pieces() const { return control_.size() - 3; }
  /// Point of piece i at u in [0, 1].
  Vec3 at(std::size_t piece, double u) const {
    const double v = 1 - u;
    const double b0 = v * v * v / 6;
    const double b1 = (3 * u * u * u - 6 * u * u + 4) / 6;
    const double b2 = (3 * v * v * v - 6 * v * v + 4) / 6;
    const double b3 = u * u * u / 6;
    return b0 * control_[piece] + b1 * control_[piece + 1] + b2 * control_[piece + 2] +
           b3 * control_[piece + 3];
  }

 private:
  std::vector<Vec3> control_;  ///< with one more at either end, mirrored there
};
}  // namespace altiplan::bspline
