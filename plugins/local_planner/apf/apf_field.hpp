// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "altiplan/geometry.hpp"

/// Formulas of the potential field that need no world. Every one of them commutes with a mirror to
/// the last bit: directions are turned by (cos, sin), never by adding angles.
namespace apf {
using namespace altiplan;

/// Horizontal part turned to the left by the angle whose cosine and sine are given.
inline Vec3 turned_left(const Vec3& v, double cosine, double sine) {
  return {cosine * v.x() - sine * v.y(), sine * v.x() + cosine * v.y(), v.z()};
}

/// Angle from a to b as seen from above, positive to the left, in [-pi, pi].
inline double bearing_change(const Vec3& a, const Vec3& b) {
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.x() * b.x() + a.y() * b.y());
}

/// Repulsion's size at distance d of the influence d0, eq. (18), times k_r; d and d0 in the gains'
/// unit of length.
inline double repulsion(double k_r, double d, double d0) {
  return d < d0 ? k_r * (1 / d - 1 / d0) / (d * d) : 0;
}

/// Where the vehicle that came from p1 goes instead of p3, so that its turn at p2 is the limit
/// exactly, eqs. (21)–(24); p3 itself where the turn is within the limit. The sine rule's ratio
/// sin(theta) / sin(alpha) is 1 / (2 sin(alpha / 2)), which has no 0 / 0 near a full turn. Of an
/// exact reversal the chord passes through p2, and p2 is returned.
inline Vec3 clamp_turn(const Vec3& p1, const Vec3& p2, const Vec3& p3, double alpha_2) {
  const double step1 = (p2 - p1).norm();
  const double step2 = (p3 - p2).norm();
  const double alpha = turn_angle_in_space(p2 - p1, p3 - p2);
  if (!(step1 > 0) || alpha <= alpha_2) {
    return p3;
  }
  const double theta = (kPi - alpha) / 2;
  const double beta = kPi - alpha_2 - theta;
  const double x1_by_x = std::sin(alpha_2) / (2 * std::sin(alpha / 2) * std::sin(beta));
  const Vec3 temp = p2 + (p2 - p1) * (step2 / step1);
  return temp + (p3 - temp) * x1_by_x;
}

/// The direction, no steeper than the limit; where it is vertical it climbs along `heading`.
inline Vec3 within_climb(Vec3 direction, double max_climb, const Vec3& heading) {
  if (climb_angle(direction) <= max_climb) {
    return direction.normalized();
  }
  const double up = direction.z() > 0 ? 1 : -1;
  double level = std::hypot(direction.x(), direction.y());
  if (level < 1e-9 * std::abs(direction.z())) {
    direction = heading;
    level = std::hypot(direction.x(), direction.y());
  }
  if (level == 0) {
    return {0, 0, up};
  }
  const double climb = max_climb * (1 - 1e-9);
  return {direction.x() / level * std::cos(climb), direction.y() / level * std::cos(climb),
          up * std::sin(climb)};
}

/// Alternatives to a direction: headings every 5 degrees to both sides, several climbs, nearest
/// first. Fixed in size: filling it allocates nothing.
class Fan {
 public:
  struct Blade {
    double deviation = 0;
    int turn = 0;  ///< in fives of degrees, to the left
    double climb = 0;
  };

  Fan() {
    for (int k = 0; k <= kHalf; ++k) {
      cosine_[k] = std::cos(radians(5.0 * k));
      sine_[k] = std::sin(radians(5.0 * k));
    }
  }

  /// `side`: +1 or -1, which of two equally near headings comes first.
  void fill(const Vec3& wish, double max_climb, bool level, int side) {
    wish_ = wish;
    size_ = 0;
    const double level_part = std::hypot(wish.x(), wish.y());
    const double own = std::atan2(wish.z(), level_part);
    const double steep = std::min(max_climb * (1 - 1e-9), radians(45));
    const std::array<double, 5> climbs{own, 0, steep, -steep, steep / 2};
    for (std::size_t c = 0; c < (level ? 1 : climbs.size()); ++c) {
      for (int k = 0; k <= kHalf; ++k) {
        const double cosine =
            std::cos(climbs[c]) * std::cos(own) * cosine_[k] + std::sin(climbs[c]) * std::sin(own);
        const double deviation = std::acos(std::clamp(cosine, -1.0, 1.0));
        blades_[size_++] = {deviation, side * k, climbs[c]};
        if (k > 0 && k < kHalf) {
          blades_[size_++] = {deviation, -side * k, climbs[c]};
        }
      }
    }
    // A stable order by hand: std::stable_sort may allocate.
    std::sort(blades_.begin(), blades_.begin() + size_, [side](const Blade& a, const Blade& b) {
      if (a.deviation != b.deviation) {
        return a.deviation < b.deviation;
      }
      return a.turn != b.turn ? side * a.turn > side * b.turn : a.climb > b.climb;
    });
  }

  int size() const { return size_; }
  Vec3 direction(int index) const {
    const Blade& blade = blades_[index];
    const double level_part = std::hypot(wish_.x(), wish_.y());
    if (level_part == 0) {
      return wish_;
    }
    const int k = std::abs(blade.turn);
    const Vec3 heading(wish_.x() / level_part, wish_.y() / level_part, 0);
    const Vec3 turned = turned_left(heading, cosine_[k], blade.turn < 0 ? -sine_[k] : sine_[k]);
    return turned * std::cos(blade.climb) + Vec3(0, 0, std::sin(blade.climb));
  }

 private:
  static constexpr int kHalf = 36;
  Vec3 wish_{1, 0, 0};
  int size_ = 0;
  std::array<double, kHalf + 1> cosine_{};
  std::array<double, kHalf + 1> sine_{};
  std::array<Blade, 5 * 2 * (kHalf + 1)> blades_{};
};
}  // namespace apf
