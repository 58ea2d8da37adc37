// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "altiplan/geometry.hpp"
#include "altiplan/kit/layers/mean_cost.hpp"
#include "altiplan/objective.hpp"

namespace altiplan::kit {

/// Where the posts of a field lie: post (i, j, k) at origin + (i, j, k) step. At least 2 columns
/// and rows; a single level holds at all heights.
struct Posts {
  std::array<double, 3> origin{0, 0, 0};
  std::array<double, 3> step{1, 1, 1};
  std::array<int, 3> counts{2, 2, 1};
};

/// A scalar field: linear along each axis between posts, and one value where there are none
/// (beyond the posts, and in the cells around a post without a value).
class ALTIPLAN_API ScalarField {
 public:
  /// Values by levels from the lowest, rows from the south, each from the west; >= 0, NaN: none.
  /// `elsewhere`: the value where there are none, may be infinite.
  ScalarField(const Posts& posts, std::vector<float> values, double elsewhere);

  /// Integral of the field over the length of the straight leg a–b, exact up to rounding.
  double integral(const Vec3& a, const Vec3& b) const {
    const double length = (b - a).norm();
    return length == 0 ? 0 : length * mean(a, b);
  }
  /// Mean of the field along that leg.
  double mean(const Vec3& a, const Vec3& b) const {
    return is_flat() ? mean_in_plane(a, b) : mean_in_space(a, b);
  }
  /// True if heights do not matter.
  bool is_flat() const { return counts_[2] == 1; }

  /// At most the integral along any path from a to b: the largest of the field's minimum times
  /// their distance, and of what crossing the columns, rows, or levels, between them costs at
  /// least. Each is a metric that no leg undercuts, so bound(a, c) <= integral(a, b) + bound(b, c).
  double bound(const Vec3& a, const Vec3& b) const;

 private:
  double mean_in_plane(const Vec3& a, const Vec3& b) const;
  double mean_in_space(const Vec3& a, const Vec3& b) const;
  float post(int i, int j) const { return values_[std::size_t(j) * std::size_t(counts_[0]) + i]; }
  std::array<double, 2> in_cells(const Vec3& p) const {
    return {(p.x() - origin_[0]) / step_[0], (p.y() - origin_[1]) / step_[1]};
  }
  /// Mean over a part of a leg that lies in one cell of a field in space; positions in cells.
  double mean_within(const Vec3& from, const Vec3& to) const;
  /// Of one that is flat.
  double mean_within(const std::array<double, 2>& from, const std::array<double, 2>& to) const;
  /// No line between posts lies between them; positions in cells.
  bool are_in_one_cell(const std::array<double, 2>& a, const std::array<double, 2>& b) const;
  /// On the posts, or beside them by as much as what lies on the edge of a volume may.
  bool is_on(std::size_t axis, double at) const {
    const double slack = kLengthTolerance / step_[axis];
    return at >= -slack && at <= counts_[axis] - 1 + slack;
  }
  double minimum_up_to(std::size_t axis, double at) const;

  std::array<double, 3> origin_;
  std::array<double, 3> step_;
  std::array<int, 3> counts_;
  std::vector<float> values_;
  double elsewhere_;
  double minimum_;
  /// By axis the minimum of each column (row, level), and its integral from the first on.
  std::array<std::vector<double>, 3> minima_;
  std::array<std::vector<double>, 3> crossed_;
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
  bool is_mean() const override { return field_.is_flat(); }

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
