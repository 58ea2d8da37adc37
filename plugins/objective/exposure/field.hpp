// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "altiplan/geometry.hpp"

namespace exposure {

using altiplan::kInfinity;
using altiplan::Vec3;

/// A scalar field over the plane: bilinear between posts, and one value where there are none
/// (beyond the posts, and in the cells around a post without a value).
class Field {
 public:
  /// Posts in rows from the south, each from the west, at (origin x + i dx, origin y + j dy);
  /// values >= 0, NaN: none. `elsewhere`: the value where there are none, may be infinite.
  Field(std::array<double, 2> origin, std::array<double, 2> step, int columns, int rows,
        std::vector<float> values, double elsewhere);

  /// Integral of the field over the length of the straight leg a–b, exact up to rounding: along a
  /// leg a bilinear cell is a quadratic, which Simpson's rule integrates.
  double integral(const Vec3& a, const Vec3& b) const;

  /// At most the integral along any path from a to b: the largest of the field's minimum times
  /// their distance, and of what crossing the columns, or rows, between them costs at least. Each
  /// is a metric that no leg undercuts, so bound(a, c) <= integral(a, b) + bound(b, c).
  double bound(const Vec3& a, const Vec3& b) const;

 private:
  float post(int i, int j) const { return values_[std::size_t(j) * std::size_t(counts_[0]) + i]; }
  std::array<double, 2> in_cells(const Vec3& p) const {
    return {(p.x() - origin_[0]) / step_[0], (p.y() - origin_[1]) / step_[1]};
  }
  /// Integral over a part of a leg that lies in one cell, per metre of it; positions in cells.
  double mean(const std::array<double, 2>& from, const std::array<double, 2>& to) const;
  double minimum_up_to(std::size_t axis, double at) const;

  std::array<double, 2> origin_;
  std::array<double, 2> step_;
  std::array<int, 2> counts_;
  std::vector<float> values_;
  double elsewhere_;
  double minimum_;
  /// Integral of the minimum of each column (row), from the first on: one entry per post.
  std::array<std::vector<double>, 2> minima_;
  std::array<std::vector<double>, 2> crossed_;
};
}  // namespace exposure
