// SPDX-License-Identifier: Apache-2.0
// The parameter of everything here is the length s flown through the air. Up to whole circles, the
// length of each word is a continuous function l(s) of the goal's place by then:
//   LSL: |m| + r phi;  RSL: p + r (2 t + phi);  LRL: r (2 p + phi),
// in the terms of dubins.cpp, with t not wrapped. Where s - l(s) is a whole number of circles, and
// the word with its turns wrapped is not longer than s, is a path. For words with a straight part
// s - l(s) increases, as l changes by less than the goal moves. For three turns it is convex, as
// the distance of the outer centres is convex in s and the angle at the base of the triangle
// concave; in wind the path with the shorter middle turn can be the quickest too, for which it is
// concave. So each number of circles has one root or two, which are bracketed.
#include "altiplan/kit/dubins/wind.hpp"

#include <algorithm>

#include "lanes.hpp"
#include "roots.hpp"

namespace altiplan::kit {
namespace {

double turned_part(double angle) {
  const double rest = angle - kCircle * std::floor(angle / kCircle);
  return rest < kCircle - 1e-12 ? rest : 0;
}

/// A vector that moves with the length flown.
struct Moving {
  double x;
  double y;
  double dx;
  double dy;

  double x_at(double s) const { return x + s * dx; }
  double y_at(double s) const { return y + s * dy; }
  double squared(double s) const { return x_at(s) * x_at(s) + y_at(s) * y_at(s); }
  /// When it is shortest.
  double nearest() const { return -(x * dx + y * dy) / (dx * dx + dy * dy); }
  /// Half of the interval around `nearest` where it is shorter than that; negative if it never is.
  double half_interval(double length) const {
    const double rest = length * length - squared(nearest());
    return rest < 0 ? -1 : std::sqrt(rest / (dx * dx + dy * dy));
  }
};

class WindSearch {
 public:
  /// `wind` in units of the airspeed. Paths are at least `begin` long, and shorter than `end`.
  WindSearch(const PosePair& pair, double radius, const Vec3& wind, double begin, double end)
      : pair_(pair),
        radius_(radius),
        wind_(wind),
        circle_(kCircle * radius),
        begin_(begin),
        best_(end) {
    const PosePair moved = pair.displaced(-wind);
    for (const bool right : {false, true}) {
      const double sign = right ? -1 : 1;
      Moving& m = m_[right];
      m = {pair.ahead - sign * radius * pair.sin, sign * pair.left - radius * pair.versed,
           moved.ahead - pair.ahead, sign * (moved.left - pair.left)};
      turn_[right] = right && pair.turn > 0 ? kCircle - pair.turn : pair.turn;
    }
  }

  std::optional<DubinsPath> run() {
    for (const bool right : {false, true}) {
      try_same(right);
    }
    for (const bool right : {false, true}) {
      try_cross(right);
      try_triple(right, 1);
      try_triple(right, -1);
    }
    return best_path_;
  }

 private:
  /// No word's turns sum up to so many circles less than the continuous length has.
  static constexpr double kFewest = -4;

  std::optional<DubinsPath> word_at(double s, DubinsWord word) const {
    return pair_.displaced(-s * wind_).path(radius_, word);
  }

  /// Takes the path of that length if it is the shortest so far, adding the circles it lacks.
  bool take(double s, std::optional<DubinsPath> path) {
    if (!path) {
      return false;
    }
    const double lacking = (s - path->length()) / circle_;
    const double circles = std::round(lacking);
    if (circles < 0 || !(std::abs(lacking - circles) < 1e-6)) {
      return false;
    }
    path->parts[0] += kCircle * circles;
    best_ = s;
    best_path_ = *path;
    return true;
  }

  /// |m(s)| = s - S for a sum S of the turns: a quadratic equation.
  void try_same(bool right) {
    const Moving& m = m_[right];
    const double a = 1 - m.dx * m.dx - m.dy * m.dy;
    const double towards = m.x * m.dx + m.y * m.dy;
    const double minimum =
        std::floor((begin_ - std::sqrt(m.squared(begin_)) - radius_ * turn_[right]) / circle_);
    // With one circle more than the least, there is a path.
    for (int more = 0; more < 3; ++more) {
      const double sum = radius_ * turn_[right] + (std::max(0.0, minimum) + more) * circle_;
      const double b = sum + towards;
      const double c = sum * sum - m.squared(0);
      const double s = (b + std::sqrt(std::max(0.0, b * b - a * c))) / a;
      if (s >= best_ ||
          (s >= begin_ && take(s, word_at(s, right ? DubinsWord::rsr : DubinsWord::lsl)))) {
        return;
      }
    }
  }

  void try_cross(bool right) {
    const DubinsWord word = right ? DubinsWord::lsr : DubinsWord::rsl;
    Moving centres = m_[right];
    centres.y += 2 * radius_;
    const double half = centres.half_interval(2 * radius_);
    const double middle = centres.nearest();
    const double from = std::atan2(centres.y_at(begin_), centres.x_at(begin_));
    const auto lead = [&](double s) {
      const double p = std::sqrt(std::max(0.0, centres.squared(s) - 4 * radius_ * radius_));
      const double angle = std::atan2(centres.y_at(s), centres.x_at(s));
      const double t = std::atan2(2 * radius_, p) - from - std::remainder(angle - from, kCircle);
      return s - p - radius_ * (2 * t + turn_[right]);
    };
    const auto path = [&](double s) { return word_at(s, word); };
    if (half < 0) {
      first_root(lead, begin_, best_, path);
    } else {
      first_root(lead, begin_, middle - half, path);
      first_root(lead, middle + half, best_, path);
    }
  }

  /// The middle turn is π + 2 times the angle at the base, or with the sign -1 π - 2 times.
  void try_triple(bool right, int sign) {
    const Moving& m = m_[right];
    const double half = m.half_interval(4 * radius_);
    const double low = std::max(begin_, m.nearest() - half);
    const double high = std::min(best_, m.nearest() + half);
    if (half < 0 || !(low <= high)) {
      return;
    }
    const auto lead = [&](double s) {
      return s - radius_ * (2 * kPi + sign * 4 * base(m.squared(s)) + turn_[right]);
    };
    // Positive where the lead increases.
    const auto slope = [&](double s) {
      const double d = m.squared(s);
      const double approach = m.dx * m.x_at(s) + m.dy * m.y_at(s);
      return std::sqrt(std::max(0.0, d * (16 * radius_ * radius_ - d))) +
             sign * 4 * radius_ * approach;
    };
    const double at_low = slope(low);
    const double at_high = slope(high);
    const bool both_ways = (at_low < 0) != (at_high < 0);
    const double extreme = both_ways ? root_between(slope, low, at_low, high, at_high) : high;
    const auto path = [&](double s) { return triple_at(s, right, sign); };
    first_root(lead, low, extreme, path);
    first_root(lead, extreme, high, path);
  }

  /// The angle at the base of the triangle of the centres.
  double base(double squared) const {
    return std::acos(std::min(1.0, std::sqrt(squared) / (4 * radius_)));
  }

  DubinsPath triple_at(double s, bool right, int sign) const {
    const Moving& m = m_[right];
    const double angle = sign * base(m.squared(s));
    const double t = turned_part(kPi / 2 + angle + std::atan2(m.y_at(s), m.x_at(s)));
    const double p = kPi + 2 * angle;
    const DubinsWord word = right ? DubinsWord::rlr : DubinsWord::lrl;
    return {word, radius_, {t, p, turned_part(p - t + turn_[right])}};
  }

  /// Takes the first path between two lengths between which the lead is monotonous.
  template <class Lead, class Path>
  void first_root(const Lead& lead, double low, double high, const Path& path) {
    low = std::max(low, begin_);
    high = std::min(high, best_);
    if (!(low <= high)) {
      return;
    }
    const double a = lead(low) / circle_;
    const double b = lead(high) / circle_;
    const double step = b >= a ? 1 : -1;
    // Roots at the ends count even if rounding hides them.
    double circles = step * std::ceil(step * a - 1e-9);
    circles = step > 0 ? std::max(circles, kFewest) : circles;
    for (; step * (circles - b) <= 1e-9 && circles >= kFewest; circles += step) {
      const auto f = [&](double s) { return lead(s) / circle_ - circles; };
      const double fa = step * (a - circles);
      const double fb = step * (b - circles);
      const double s = fa >= 0   ? low
                       : fb <= 0 ? high
                                 : root_between(f, low, step * fa, high, step * fb);
      if (s < best_ && take(s, path(s))) {
        return;
      }
    }
  }

  const PosePair& pair_;
  double radius_;
  Vec3 wind_;
  double circle_;
  double begin_;
  std::array<Moving, 2> m_;
  std::array<double, 2> turn_;
  double best_;
  std::optional<DubinsPath> best_path_;
};

bool can_fly(const Air& air) { return air.wind.head<2>().norm() < air.speed; }
}  // namespace

namespace {
std::optional<WindPath> quickest_path(const Pose& from, const Pose& to, double radius,
                                      const Air& air, double end) {
  if (!can_fly(air)) {
    return std::nullopt;
  }
  const PosePair pair(from, to);
  if (air.wind.head<2>().norm() <= 1e-12 * air.speed) {
    const DubinsPath path = pair.path(radius);
    return path.length() < end ? std::optional(WindPath{{path}, air}) : std::nullopt;
  }
  const auto path = WindSearch(pair, radius, air.wind / air.speed, 0, end).run();
  return path ? std::optional(WindPath{{*path}, air}) : std::nullopt;
}
}  // namespace

std::optional<WindPath> wind_path(const Pose& from, const Pose& to, double radius, const Air& air) {
  return quickest_path(from, to, radius, air, kInfinity);
}

std::optional<WindPath> wind_path(const Pose& from, const Pose& to, const AirplaneLimits& limits,
                                  const Air& air, double at_most) {
  const double minimum = limits.min_length(to.position.z() - from.position.z());
  if (minimum == kInfinity || minimum > at_most) {
    return std::nullopt;
  }
  const double end = at_most * (1 + 1e-12);
  const auto quickest = quickest_path(from, to, limits.radius, air, end);
  if (!quickest || quickest->through_air.length() >= minimum) {
    return quickest;
  }
  const PosePair pair(from, to);
  const Vec3 wind = air.wind / air.speed;
  const AirplanePath path = path_of_length(pair.displaced(-minimum * wind), limits.radius, minimum);
  if (path.length() <= minimum * (1 + 1e-9)) {
    return WindPath{path, air};
  }
  const auto longer = WindSearch(pair, limits.radius, wind, minimum, end).run();
  return longer ? std::optional(WindPath{{*longer}, air}) : std::nullopt;
}
}  // namespace altiplan::kit
