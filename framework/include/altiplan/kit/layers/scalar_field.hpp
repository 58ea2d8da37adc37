// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "altiplan/geometry.hpp"
#include "altiplan/kit/layers/mean_cost.hpp"
#include "altiplan/objective.hpp"

namespace altiplan::kit {

/// A scalar field over the plane: bilinear between posts, and one value where there are none
/// (beyond the posts, and in the cells around a post without a value).
class ALTIPLAN_API ScalarField {
 public:
  /// Posts in rows from the south, each from the west, at (origin x + i dx, origin y + j dy), at
  /// least 2 of each; values >= 0, NaN: none. `elsewhere`: the value where there are none, may be
  /// infinite.
  ScalarField(std::array<double, 2> origin, std::array<double, 2> step, int columns, int rows,
              std::vector<float> values, double elsewhere);

  /// Integral of the field over the length of the straight leg a–b, exact up to rounding.
  double integral(const Vec3& a, const Vec3& b) const {
    const double length = (b - a).norm();
    return length == 0 ? 0 : length * mean(a, b);
  }
  /// Mean of the field along that leg, whatever the heights of its ends.
  double mean(const Vec3& a, const Vec3& b) const;

  /// At most the integral along any path from a to b: the largest of the field's minimum times
  /// their distance, and of what crossing the columns, or rows, between them costs at least. Each
  /// is a metric that no leg undercuts, so bound(a, c) <= integral(a, b) + bound(b, c).
  double bound(const Vec3& a, const Vec3& b) const;

 private:
  float post(int i, int j) const { return values_[std::size_t(j) * std::size_t(counts_[0]) + i]; }
  std::array<double, 2> in_cells(const Vec3& p) const {
    return {(p.x() - origin_[0]) / step_[0], (p.y() - origin_[1]) / step_[1]};
  }
  /// Mean over a part of a leg that lies in one cell; positions in cells.
  double mean_within(const std::array<double, 2>& from, const std::array<double, 2>& to) const;
  /// No line between posts lies between them; positions in cells.
  bool are_in_one_cell(const std::array<double, 2>& a, const std::array<double, 2>& b) const;
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

/// The integral of a scalar field along the route; turns by chords within 0.1 mm.
class ALTIPLAN_API FieldIntegral : public Objective, public MeanCost {
 public:
  /// `unit`: of a value times a metre, for people.
  FieldIntegral(ScalarField field, std::string unit)
      : field_(std::move(field)), unit_(std::move(unit)) {}
  double per_metre(const Vec3& from, const Vec3& to) const override {
    return field_.mean(from, to);
  }

 private:
  double do_cost(const Leg& leg, double time_s, const Request& request) const override;
  double do_bound(const Vec3& from, const Vec3& to, const Request&) const override {
    return field_.bound(from, to);
  }
  std::string do_unit() const override { return unit_; }

  ScalarField field_;
  std::string unit_;
};
}  // namespace altiplan::kit
