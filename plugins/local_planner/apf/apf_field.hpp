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

/// Alternatives to a direction: headings every 5 degrees to both sides, several climbs. They come
/// one by one, nearest first, since most often one of the first will do. Fixed in size: it
/// allocates nothing.
class Fan {
 public:
  static constexpr int kHalf = 36;
  static constexpr int kClimbs = 5;
  static constexpr int kMax = kClimbs * 2 * kHalf;

  Fan() {
    for (int k = 0; k <= kHalf; ++k) {
      cosine_[k] = std::cos(radians(5.0 * k));
      sine_[k] = std::sin(radians(5.0 * k));
    }
  }

  /// `side`: +1 or -1, which of two equally near headings comes first.
  void begin(const Vec3& wish, double max_climb, bool level, int side) {
    wish_ = wish;
    side_ = side;
    const double level_part = std::hypot(wish.x(), wish.y());
    heading_ = level_part > 0 ? Vec3(wish.x() / level_part, wish.y() / level_part, 0) : wish;
    const double own = std::atan2(wish.z(), level_part);
    cosine_own_ = std::cos(own);
    sine_own_ = std::sin(own);
    const double steep = std::min(max_climb * (1 - 1e-9), radians(45));
    const std::array<double, kClimbs> climbs{own, 0, steep, -steep, steep / 2};
    rows_ = level ? 1 : kClimbs;
    for (int c = 0; c < rows_; ++c) {
      row_[c] = {climbs[c], std::cos(climbs[c]), std::sin(climbs[c])};
      row_[c].deviation = deviation(row_[c]);
    }
  }

  /// The next direction; none where all have come. Along each climb they come in order, so that the
  /// nearest of all is the first of one of them.
  std::optional<Vec3> next() {
    Row* first = nullptr;
    for (int c = 0; c < rows_; ++c) {
      if (row_[c].count < 2 * kHalf && (first == nullptr || comes_before(row_[c], *first))) {
        first = &row_[c];
      }
    }
    if (first == nullptr) {
      return std::nullopt;
    }
    const Vec3 result = direction(*first);
    if (++first->count < 2 * kHalf) {
      first->deviation = deviation(*first);
    }
    return result;
  }

  /// The vector turned by so many fives of degrees to the left, as seen from above.
  Vec3 turned(const Vec3& v, int fives) const {
    const double sine = sine_[std::abs(fives)];
    return turned_left(v, cosine_[std::abs(fives)], fives < 0 ? -sine : sine);
  }

 private:
  /// Headings of one climb: straight on, then by k fives of degrees to the one and the other side.
  struct Row {
    double climb = 0;
    double cosine = 1;
    double sine = 0;
    int count = 0;         ///< that have come
    double deviation = 0;  ///< of the next from the wish

    int fives() const { return (count + 1) / 2; }
    int turn() const { return count % 2 == 1 ? fives() : -fives(); }  ///< positive: `side` first
  };

  double deviation(const Row& row) const {
    const double cosine = row.cosine * cosine_own_ * cosine_[row.fives()] + row.sine * sine_own_;
    return std::acos(std::clamp(cosine, -1.0, 1.0));
  }

  static bool comes_before(const Row& a, const Row& b) {
    if (a.deviation != b.deviation) {
      return a.deviation < b.deviation;
    }
    return a.turn() != b.turn() ? a.turn() > b.turn() : a.climb > b.climb;
  }

  Vec3 direction(const Row& row) const {
    return wish_.x() == 0 && wish_.y() == 0
               ? wish_
               : Vec3(turned(heading_, side_ * row.turn()) * row.cosine + Vec3(0, 0, row.sine));
  }

  Vec3 wish_{1, 0, 0};
  Vec3 heading_{1, 0, 0};
  int side_ = 1;
  double cosine_own_ = 1;
  double sine_own_ = 0;
  int rows_ = 0;
  std::array<Row, kClimbs> row_{};
  std::array<double, kHalf + 1> cosine_{};
  std::array<double, kHalf + 1> sine_{};
};
}  // namespace apf
