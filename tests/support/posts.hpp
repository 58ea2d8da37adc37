// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>

#include "altiplan/environment.hpp"
#include "altiplan/ground.hpp"
#include "altiplan/height_field.hpp"

namespace altiplan::testing {

/// An elevation model as a layer that blocks what is below it.
class Posts final : public Environment, public Ground {
 public:
  explicit Posts(HeightField field) : field_(std::move(field)) {}

 private:
  Box do_bounds() const override {
    const auto& [x, y] = field_.origin();
    const auto& [dx, dy] = field_.spacing();
    return {{x, y, -kInfinity},
            {x + (field_.columns() - 1) * dx, y + (field_.rows() - 1) * dy, field_.max_height()}};
  }
  double do_clearance(const Vec3& p) const override { return p.z() - field_.max_height(); }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    return field_.gap(a, b) < r - kLengthTolerance;
  }
  const Ground* do_ground() const override { return this; }
  bool do_is_all() const override { return true; }
  std::optional<double> do_height(double x, double y) const override { return field_.at(x, y); }
  double do_gap(const Vec3& a, const Vec3& b, double enough) const override {
    return field_.gap(a, b, enough);
  }
  double do_gap_max(const Vec3& a, const Vec3& b) const override { return field_.gap_max(a, b); }
  const HeightField* do_height_field() const override { return &field_; }

  HeightField field_;
};
}  // namespace altiplan::testing
