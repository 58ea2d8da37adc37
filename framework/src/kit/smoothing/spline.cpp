// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/smoothing/spline.hpp"

#include <utility>

#include "altiplan/error.hpp"

namespace altiplan::kit {

CubicSpline::CubicSpline(std::vector<Vec3> control) : control_(std::move(control)) {
  if (control_.size() < 2) {
    throw Error("a spline needs at least 2 control points, got " + std::to_string(control_.size()));
  }
  // At a knot the curve is (P[i-1] + 4 P[i] + P[i+1]) / 6: with the neighbour mirrored at the end,
  // that is the end itself.
  const Vec3 first = 2 * control_[0] - control_[1];
  const Vec3 last = 2 * control_[control_.size() - 1] - control_[control_.size() - 2];
  control_.insert(control_.begin(), first);
  control_.push_back(last);
}

Vec3 CubicSpline::at(std::size_t piece, double u) const {
  const double v = 1 - u;
  const double b0 = v * v * v / 6;
  const double b1 = (3 * u * u * u - 6 * u * u + 4) / 6;
  const double b2 = (3 * v * v * v - 6 * v * v + 4) / 6;
  const double b3 = u * u * u / 6;
  return b0 * control_[piece] + b1 * control_[piece + 1] + b2 * control_[piece + 2] +
         b3 * control_[piece + 3];
}
}  // namespace altiplan::kit
