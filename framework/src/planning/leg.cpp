// SPDX-License-Identifier: Apache-2.0
#include "altiplan/leg.hpp"

#include <array>

namespace altiplan {
namespace {

/// Displacement along a circle from a heading: the chord of the turn, without cancellation for
/// small turns.
Vec3 along_circle(double heading, double turn, double radius) {
  const double chord = 2 * radius * std::sin(std::abs(turn) / 2);
  return chord * unit_heading(heading + turn / 2);
}

/// Integral of f over [a, b] by Gauss-Legendre quadrature with eight points.
template <class Function>
double integral(double a, double b, const Function& f) {
  constexpr std::array<double, 4> kAt{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                      0.9602898564975363};
  constexpr std::array<double, 4> kWeight{0.3626837833783620, 0.3137066458778873,
                                          0.2223810344533745, 0.1012285362903763};
  const double middle = (a + b) / 2;
  const double half = (b - a) / 2;
  double sum = 0;
  for (std::size_t i = 0; i < kAt.size(); ++i) {
    sum += kWeight[i] * (f(middle - half * kAt[i]) + f(middle + half * kAt[i]));
  }
  return half * sum;
}
}  // namespace

Leg Leg::turning(const Pose& from, double turn, double radius, double climb, const Vec3& drift) {
  const Vec3 to = from.position + along_circle(from.heading, turn, radius) + drift;
  return {from.position, to + Vec3(0, 0, climb), turn, radius, from.heading, drift};
}

Vec3 Leg::at(double t) const {
  if (t <= 0 || t >= 1) {
    return t <= 0 ? from : to;
  }
  if (!turns()) {
    return from + t * (to - from);
  }
  const Vec3 climb(0, 0, to.z() - from.z());
  return from + along_circle(heading, t * turn, radius) + t * (drift + climb);
}

Vec3 Leg::rate(double t) const {
  if (!turns()) {
    return to - from;
  }
  const Vec3 climb(0, 0, to.z() - from.z());
  return air_length() * unit_heading(heading + t * turn) + drift + climb;
}

Vec3 Leg::track(double t) const {
  const Vec3 way = has_heading() ? rate(t) : Vec3(to - from);
  if (!has_heading() || altiplan::has_heading(way)) {
    return way;
  }
  const double flat = way.head<2>().norm();
  // Where it stands still it comes from the side and leaves to the side.
  return flat > 0 ? Vec3(way / flat)
                  : unit_heading(heading + t * turn + std::copysign(kPi / 2, (0.5 - t) * turn));
}

double Leg::length() const {
  if (kind() != Kind::trochoid) {
    return turns() ? std::hypot(air_length(), to.z() - from.z()) : (to - from).norm();
  }
  // A piece of an eighth of a turn is smooth enough for eight points at any wind that the vehicle
  // can fly against.
  const double pieces = std::ceil(std::abs(turn) / (kPi / 4));
  double sum = 0;
  for (double i = 0; i < pieces; ++i) {
    sum += integral(i / pieces, (i + 1) / pieces, [&](double t) { return rate(t).norm(); });
  }
  return sum;
}

double Leg::air_length() const {
  return turns() ? radius * std::abs(turn) : (to - from).head<2>().norm();
}

Box Leg::box() const {
  Box box = leg_box(from, to);
  for (const int axis : {0, 1}) {
    // On an axis, the position is extreme where the rate is 0: where the cosine of the angle
    // between the heading and the axis is -drift / air_length.
    const double cosine = turns() ? -drift[axis] / air_length() : 2;
    if (std::abs(cosine) > 1) {
      continue;
    }
    const double along = axis == 0 ? 0 : kPi / 2;
    for (const double angle : {along + std::acos(cosine), along - std::acos(cosine)}) {
      const double first = std::min(heading, heading + turn);
      const double last = std::max(heading, heading + turn);
      double at_heading = angle + 2 * kPi * std::ceil((first - angle) / (2 * kPi));
      for (; at_heading <= last; at_heading += 2 * kPi) {
        box = box.with(at((at_heading - heading) / turn));
      }
    }
  }
  return box;
}

Leg Leg::piece(double begin, double end) const {
  const double share = end - begin;
  return {at(begin),     at(end),       share * turn, radius, heading + begin * turn,
          share * drift, share * hold_s};
}

std::vector<Vec3> Leg::chords(double tolerance) const {
  std::vector<Vec3> points = {from};
  const double pieces = std::ceil(std::sqrt(sagitta() / tolerance));
  for (double i = 1; i < pieces; ++i) {
    points.push_back(at(i / pieces));
  }
  points.push_back(to);
  return points;
}

Leg Leg::reversed() const {
  return {to, from, -turn, radius, heading + turn + kPi, -drift, hold_s};
}
bool Loiter::passes(const Vec3& centre, const Vec3& p) const {
  return std::abs(std::hypot(p.x() - centre.x(), p.y() - centre.y()) - radius) <=
             kLengthTolerance &&
         std::abs(p.z() - centre.z()) <= kLengthTolerance;
}
}  // namespace altiplan
