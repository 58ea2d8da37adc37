// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "altiplan/shape.hpp"

namespace altiplan::zones {

// Relative to the largest coordinate: far more than the error of horizontal distances.
inline constexpr double kBeside = 1e-12;

// Fractions of the leg at which its depth in a zone may pass through `depth`: where it crosses the
// floor and ceiling moved inward by it, and where it is that far from an edge of the outline.
class Breaks {
 public:
  Breaks(const Vec3& a, const Vec3& b, double depth)
      : a_(a),
        b_(b),
        depth_(depth),
        reach_(std::abs(depth) + kBeside * (1 + a.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff())),
        near_(leg_box(a, b).grown(reach_)) {
    const double length = std::hypot(b.x() - a.x(), b.y() - a.y());
    if (length > 0) {
      across_ = {(a.y() - b.y()) / length, (b.x() - a.x()) / length};
    }
  }

  void add(const Shape& shape) {
    if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
      add_levels(cylinder->floor, cylinder->ceiling);
      add_circle({cylinder->x, cylinder->y}, cylinder->radius - depth_);
    } else if (const auto* prism = std::get_if<Prism>(&shape)) {
      add_levels(prism->floor, prism->ceiling);
      add_ring(prism->outline);
      std::for_each(prism->holes.begin(), prism->holes.end(),
                    [this](const auto& hole) { add_ring(hole); });
    }
  }

  std::vector<double> sorted() {
    std::sort(shares_.begin(), shares_.end());
    return shares_;
  }

 private:
  void add_share(double share) {
    if (share > 0 && share < 1) {
      shares_.push_back(share);
    }
  }
  void add_levels(double floor, double ceiling) {
    const double rise = b_.z() - a_.z();
    add_share((floor + depth_ - a_.z()) / rise);
    add_share((ceiling - depth_ - a_.z()) / rise);
  }
  void add_circle(const std::array<double, 2>& centre, double radius) {
    const double dx = b_.x() - a_.x();
    const double dy = b_.y() - a_.y();
    const double ox = a_.x() - centre[0];
    const double oy = a_.y() - centre[1];
    const double length2 = dx * dx + dy * dy;
    const double middle = -(ox * dx + oy * dy) / length2;
    const double off = (ox * dy - oy * dx) * (ox * dy - oy * dx) / length2;
    const double half = std::sqrt((radius * radius - off) / length2);  // NaN: no crossing
    add_share(middle - half);
    add_share(middle + half);
  }
  // True if the edge is too far from the leg to cause a break.
  bool is_far(const std::array<double, 2>& e, const std::array<double, 2>& f) const {
    const auto beside = [&](const std::array<double, 2>& p) {
      return across_[0] * (p[0] - a_.x()) + across_[1] * (p[1] - a_.y());
    };
    const auto both_beyond = [](double one, double other, double low, double high) {
      return (one < low && other < low) || (one > high && other > high);
    };
    return both_beyond(e[0], f[0], near_.min.x(), near_.max.x()) ||
           both_beyond(e[1], f[1], near_.min.y(), near_.max.y()) ||
           both_beyond(beside(e), beside(f), -reach_, reach_);
  }
  void add_ring(const std::vector<std::array<double, 2>>& ring) {
    for (std::size_t n = 0; n < ring.size(); ++n) {
      const std::array<double, 2>& e = ring[n];
      const std::array<double, 2>& f = ring[n + 1 < ring.size() ? n + 1 : 0];
      if (is_far(e, f)) {
        continue;
      }
      const double ex = f[0] - e[0];
      const double ey = f[1] - e[1];
      const double length = std::sqrt(ex * ex + ey * ey);
      const double from = ((a_.x() - e[0]) * ey - (a_.y() - e[1]) * ex) / length;
      const double to = ((b_.x() - e[0]) * ey - (b_.y() - e[1]) * ex) / length;
      add_share((depth_ - from) / (to - from));
      add_share((-depth_ - from) / (to - from));
      add_circle(e, depth_);
    }
  }

  const Vec3& a_;
  const Vec3& b_;
  double depth_;
  double reach_;
  Box near_;
  std::array<double, 2> across_{0, 0};
  std::vector<double> shares_{0, 1};
};
}  // namespace altiplan::zones
