// SPDX-License-Identifier: Apache-2.0
// Let m be the vector from the centre of the left circle at the start to that of the left circle at
// the end, in units of the radius, seen along the heading at the start. With the angle phi between
// the headings, m and phi determine the three words that end to the left:
//   LSL: the straight part is m itself;
//   RSL: it is the tangent from the right circle, m + (0, 2) away, that crosses to the left one;
//   LRL: its three centres are an isosceles triangle with base m and sides 2.
// The other three are these in a mirror, and so are computed beside them, in the second lane.
#include "altiplan/kit/dubins/dubins.hpp"

#include <algorithm>

#include "lanes.hpp"
#include "part_legs.hpp"

namespace altiplan::kit {
namespace {

constexpr double kAngleSlack = 1e-12;

/// An angle in [0, 2π); what lacks less than the slack to a circle is 0.
double wrapped(double angle) {
  const double rest = angle - kCircle * std::floor(angle / kCircle);
  return rest < kCircle - kAngleSlack ? rest : 0;
}

/// The same of angles in [-2π, 4π).
Two wrapped(Two angle) {
  const Two rest = angle + only(angle < 0, both(kCircle)) - only(angle >= kCircle, both(kCircle));
  return only(rest < kCircle - kAngleSlack, rest);
}

/// A heading of moderate size.
double moderate(double heading) {
  return std::abs(heading) < 1e5 ? heading : std::remainder(heading, kCircle);
}

int side_of(DubinsWord word) { return int(word) & 1; }

struct Parts {
  Two t;
  Two p;
  Two q;

  Two sum() const { return t + p + q; }
};

/// What the words that end on one side depend on: the left one, and the right one in a mirror.
struct Sides {
  Sides(const PosePair& pair, double radius)
      : slack(1e-11 + 1e-15 * (std::abs(pair.ahead) + std::abs(pair.left)) / radius),
        turn{pair.turn, pair.turn == 0 ? 0 : kCircle - pair.turn},
        sin{pair.sin, -pair.sin},
        cos(both(pair.cos)),
        x(pair.ahead / radius - sin),
        y(Two{pair.left, -pair.left} / radius - pair.versed),
        squared(x * x + y * y) {}

  double slack;
  Two turn;  ///< phi
  Two sin;
  Two cos;
  Two x;  ///< m
  Two y;
  Two squared;  ///< |m|²

  /// The sum of the turns of LSL is phi if the direction of m is one that a turn by phi passes.
  Two sum_of_same() const {
    const Two across = cos * y - sin * x;
    const Two along = cos * x + sin * y;
    const Mask starts_along = (abs(y) <= slack) & (x >= -slack);
    const Mask ends_along = (abs(across) <= slack) & (along >= -slack);
    const Mask up = y >= 0;
    const Mask same_half = ~(up ^ (sin >= 0));
    const Mask passed = (same_half & (across <= 0)) | (~same_half & up);
    return turn + only(~(starts_along | ends_along | passed), both(kCircle));
  }
  Two same() const { return sqrt(squared) + sum_of_same(); }
  Parts same_parts() const {
    const Two sum = sum_of_same();
    const Two t = wrapped(angle_of(x, y));
    const Two rounded = only(t - sum < kCircle - t, sum);
    const Two first = select(t <= sum, t, rounded);
    return {first, sqrt(squared), sum - first};
  }

  Parts cross() const {
    const Two p_squared = squared + 4 * y;
    const Two p = sqrt(max(p_squared, both(0)));
    const Two t = wrapped(angle_of(x * p + 2 * (y + 2), 2 * x - (y + 2) * p));
    return {t, select(p_squared < -slack, both(kInfinity), p), wrapped(t + turn)};
  }

  bool have_triple() const { return std::min(squared[0], squared[1]) <= 16 + slack; }
  Parts triple() const {
    const Mask missing = squared > 16 + slack;
    const Two base_angle = angle_of(sqrt(squared), sqrt(max(16 - squared, both(0))));
    const Two t = wrapped(kPi / 2 + base_angle + angle_of(x, y));
    const Two p = kPi + 2 * base_angle;
    return {t, select(missing, both(kInfinity), p), wrapped(wrapped(p - t) + turn)};
  }
};

}  // namespace

int turn_sense(DubinsWord word, int part) {
  const int last = side_of(word) == 0 ? 1 : -1;
  switch (word) {
    case DubinsWord::lsl:
    case DubinsWord::rsr:
      return part == 1 ? 0 : last;
    case DubinsWord::rsl:
    case DubinsWord::lsr:
      return (part - 1) * last;
    case DubinsWord::lrl:
    case DubinsWord::rlr:
      return part == 1 ? -last : last;
  }
  return 0;
}

std::vector<Leg> DubinsPath::legs(const Pose& from, const Vec3& to) const {
  const std::array<PathPart, 3> all{{{turn_sense(word, 0), parts[0]},
                                     {turn_sense(word, 1), parts[1]},
                                     {turn_sense(word, 2), parts[2]}}};
  return part_legs(all, radius, from, to);
}

PosePair::PosePair(const Pose& from, const Pose& to) : turn(wrapped(to.heading - from.heading)) {
  const SinCos angles = sin_cos(Two{turn, moderate(from.heading)});
  set_turn(angles.sin[0], angles.cos[0]);
  from_sin = angles.sin[1];
  from_cos = angles.cos[1];
  const Vec3 apart = to.position - from.position;
  ahead = apart.x() * from_cos + apart.y() * from_sin;
  left = apart.y() * from_cos - apart.x() * from_sin;
}

void PosePair::set_turn(double s, double c) {
  sin = s;
  cos = c;
  versed = c > 0 ? s * s / (1 + c) : 1 - c;
}

PosePair PosePair::displaced(const Vec3& by) const {
  PosePair pair = *this;
  pair.ahead += by.x() * from_cos + by.y() * from_sin;
  pair.left += by.y() * from_cos - by.x() * from_sin;
  return pair;
}

PosePair PosePair::reversed() const {
  PosePair pair = *this;
  pair.ahead = ahead * cos + left * sin;
  pair.left = left * cos - ahead * sin;
  pair.turn = turn == 0 ? 0 : kCircle - turn;
  pair.sin = -sin;
  pair.from_sin = -(from_sin * cos + from_cos * sin);
  pair.from_cos = from_sin * sin - from_cos * cos;
  return pair;
}

PosePair PosePair::after_turn(double angle, double radius) const {
  PosePair pair = *this;
  pair.turn = wrapped(turn - angle);
  const SinCos angles = sin_cos(Two{pair.turn, angle});
  pair.set_turn(angles.sin[0], angles.cos[0]);
  const double s = angles.sin[1];
  const double c = angles.cos[1];
  // The centre of the turn stays where it is.
  const double centre = std::copysign(radius, angle);
  pair.ahead = ahead * c + (left - centre) * s;
  pair.left = (left - centre) * c - ahead * s + centre;
  pair.from_sin = from_sin * c + from_cos * s;
  pair.from_cos = from_cos * c - from_sin * s;
  return pair;
}

double PosePair::length(double radius) const {
  const Sides sides(*this, radius);
  Two minimum = min(sides.same(), sides.cross().sum());
  if (sides.have_triple()) {
    minimum = min(minimum, sides.triple().sum());
  }
  return radius * std::min(minimum[0], minimum[1]);
}

double PosePair::length(double radius, DubinsWord word) const {
  const Sides sides(*this, radius);
  const int kind = int(word) / 2;
  const Two all = kind == 0 ? sides.same() : (kind == 1 ? sides.cross() : sides.triple()).sum();
  return radius * all[side_of(word)];
}

std::array<double, 6> PosePair::lengths(double radius) const {
  const Sides sides(*this, radius);
  const Two same = radius * sides.same();
  const Two cross = radius * sides.cross().sum();
  const Two triple = sides.have_triple() ? radius * sides.triple().sum() : both(kInfinity);
  return {same[0], same[1], cross[0], cross[1], triple[0], triple[1]};
}

DubinsPath PosePair::path(double radius) const {
  const std::array<double, 6> all = lengths(radius);
  const auto best = std::min_element(all.begin(), all.end()) - all.begin();
  return *path(radius, kDubinsWords[std::size_t(best)]);
}

std::optional<DubinsPath> PosePair::path(double radius, DubinsWord word) const {
  const Sides sides(*this, radius);
  const int kind = int(word) / 2;
  const Parts parts = kind == 0 ? sides.same_parts() : kind == 1 ? sides.cross() : sides.triple();
  const int side = side_of(word);
  if (parts.p[side] == kInfinity) {
    return std::nullopt;
  }
  return DubinsPath{word, radius, {parts.t[side], parts.p[side], parts.q[side]}};
}
}  // namespace altiplan::kit
