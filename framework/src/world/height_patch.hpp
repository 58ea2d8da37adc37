// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace altiplan {

// A bilinear cell, by the fractions s (east) and w (north) of it.
struct Patch {
  double sw, se, nw, ne;

  bool has_ground() const { return !std::isnan(sw + se + nw + ne); }
  Patch scaled(double by) const { return {by * sw, by * se, by * nw, by * ne}; }
  double max() const { return std::max({sw, se, nw, ne}); }
  double at(double s, double w) const {
    return (1 - w) * ((1 - s) * sw + s * se) + w * ((1 - s) * nw + s * ne);
  }
  // Each component of the gradient varies between the slopes of two opposite edges, independently
  // of the other one: this is exactly the maximum.
  double squared_slope(const std::array<double, 2>& per_m) const {
    const double east = std::max(std::abs(se - sw), std::abs(ne - nw)) * per_m[0];
    const double north = std::max(std::abs(nw - sw), std::abs(ne - se)) * per_m[1];
    return east * east + north * north;
  }
};
}  // namespace altiplan
