// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "altiplan/geometry.hpp"

namespace velocity_field {
using altiplan::kPi;
using altiplan::radians;

using Vec2 = Eigen::Vector2d;

/// A threat in 2-D.
struct Disc {
  Vec2 centre{0, 0};
  double radius = 0;
};

inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }
/// Rotated by +90 degrees.
inline Vec2 left_of(const Vec2& v) { return {-v.y(), v.x()}; }

/// The velocity field of paper 001, section 1. `pull` is omega, `edge_ratio` alpha,
/// `surface_ratio` beta, `ring` Delta R, `guide_ratio` epsilon.
struct Field {
  double pull = 1;
  double edge_ratio = 0.05;
  double surface_ratio = 10;
  double ring = 2000;
  double guide_ratio = 1;

  /// L, from |V_P| (r + ring) = alpha omega; infinite for equal ratios.
  double length() const { return ring / std::sqrt(surface_ratio / edge_ratio - 1); }
  /// L2 - r: at that distance from a threat's edge its push equals the pull.
  double balance() const { return length() * std::sqrt(std::max(surface_ratio - 1, 0.0)); }

  /// |V_P| at distance d from the centre of a threat of radius r, eq. (3). Ignores the reach.
  double push(double d, double r) const {
    const double surface = surface_ratio * pull;
    if (d < r) {
      const double inner = d / r;
      return surface / std::max(inner * inner, kMin);
    }
    const double outer = (d - r) / length();
    return surface / (1 + outer * outer);
  }

  /// V_P + V_G of a threat, eqs. (3) and (6): away from it, and alongside it toward the target.
  Vec2 of_threat(const Vec2& here, const Disc& threat, const Vec2& to_target) const {
    const Vec2 away = here - threat.centre;
    const double d = away.norm();
    if (d > threat.radius + ring) {
      return {0, 0};
    }
    const Vec2 out = d > 0 ? Vec2(away / d) : Vec2(to_target.normalized());
    const Vec2 left = left_of(out);
    const double guide = left.dot(to_target) >= 0 ? guide_ratio : -guide_ratio;
    return push(d, threat.radius) * (out + guide * left);
  }
  /// V_T, eq. (1).
  Vec2 of_target(const Vec2& to_target) const {
    const double d = to_target.norm();
    return d > 0 ? Vec2(pull / d * to_target) : Vec2(0, 0);
  }

  /// Keeps the push finite at a threat's centre.
  static constexpr double kMin = 1e-12;
};

/// The largest change of heading, eq. (13), for a step that is a chord of the smallest circle.
inline double max_turn(double step, double min_radius) {
  const double half = step / (2 * min_radius);
  return half < 1 ? 2 * std::asin(half) : kPi;
}

/// Radius of the smallest circle that has steps of that length as chords: at least R_min, and large
/// enough that the judge's fillet between two steps has the radius of a turn_radius constraint (0:
/// there is none).
inline double min_circle(double step, double min_radius, double min_fillet) {
  return min_fillet > 0 ? std::max(min_radius, std::hypot(min_fillet, step / 2)) : min_radius;
}

/// A bound on the change of heading, computed once for many steps.
class TurnLimit {
 public:
  explicit TurnLimit(double maximum)
      : max_turn_(maximum), cos_(std::cos(maximum)), sin_(std::sin(maximum)) {}
  double maximum() const { return max_turn_; }
  /// `wish` if it is at most the limit away from `heading`, else the heading turned toward it by
  /// the limit. Unit vectors. A wish straight back turns left.
  Vec2 held(const Vec2& heading, const Vec2& wish) const {
    if (heading.dot(wish) >= cos_) {
      return wish;
    }
    const double side = cross(heading, wish) >= 0 ? sin_ : -sin_;
    return (cos_ * heading + side * left_of(heading)).normalized();
  }

 private:
  double max_turn_;
  double cos_;
  double sin_;
};
}  // namespace velocity_field
