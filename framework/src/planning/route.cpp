// SPDX-License-Identifier: Apache-2.0
#include "altiplan/route.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan {
namespace {
Vec3 turned(const Vec3& v, double angle) {
  return {v.x() * std::cos(angle) - v.y() * std::sin(angle),
          v.x() * std::sin(angle) + v.y() * std::cos(angle), v.z()};
}
}  // namespace

void Route::push_back(const Vec3& to) {
  if (!legs_.empty()) {
    legs_.push_back(Leg::straight(back(), to));
  }
  waypoints_.push_back(to);
}

void Route::push_back(const Leg& leg) {
  if (empty()) {
    waypoints_.push_back(leg.from);
  }
  const bool is_more = leg.turns() || leg.waits();
  if (is_more && is_straight()) {
    for (std::size_t i = 0; i < leg_count(); ++i) {
      legs_.push_back(Leg::straight(waypoints_[i], waypoints_[i + 1]));
    }
  }
  if (is_more || !is_straight()) {
    legs_.push_back(leg);
  }
  waypoints_.push_back(leg.to);
}

void Route::append(const Route& next) {
  if (empty()) {
    *this = next;
    return;
  }
  for (std::size_t i = 0; i < next.leg_count(); ++i) {
    push_back(next.leg(i));
  }
}

Route Route::part(std::size_t first, std::size_t last) const {
  Route route{waypoints_[first]};
  for (std::size_t i = first; i < last; ++i) {
    route.push_back(leg(i));
  }
  return route;
}

bool Route::waits() const {
  return std::any_of(legs_.begin(), legs_.end(), [](const Leg& leg) { return leg.waits(); });
}

Polyline Route::chords(double tolerance) const {
  if (is_straight()) {
    return waypoints_;
  }
  Polyline points = {front()};
  for (const Leg& leg : legs_) {
    const Polyline part = leg.chords(tolerance);
    points.insert(points.end(), part.begin() + 1, part.end());
  }
  return points;
}

double length(const Polyline& points) {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    sum += (points[i] - points[i - 1]).norm();
  }
  return sum;
}

double length(const Route& route) {
  if (route.is_straight()) {
    return length(route.waypoints());
  }
  double sum = 0;
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    sum += route.leg(i).length();
  }
  return sum;
}

Polyline without_repeats(const Polyline& points) {
  Polyline out;
  for (const Vec3& p : points) {
    if (out.empty() || p != out.back()) {
      out.push_back(p);
    }
  }
  return out;
}

Route without_repeats(const Route& route) {
  if (route.is_straight()) {
    return without_repeats(route.waypoints());
  }
  Route out;
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Leg leg = route.leg(i);
    if (leg.turns() || leg.waits() || leg.from != leg.to) {
      out.push_back(leg);
    }
  }
  return out.empty() ? Route{route.front()} : out;
}

std::optional<Approach> onward(std::optional<Approach> before, const Leg& leg) {
  const bool is_nothing =
      leg.turns() ? std::hypot(leg.air_length(), leg.to.z() - leg.from.z()) < kLengthTolerance
                  : leg.to == leg.from;
  if (is_nothing) {
    if (before) {
      // The piece that a cut leaves of a turn of a metre or more turns no further than this.
      const double turn = std::abs(leg.turn) <= kLengthTolerance ? leg.turn : 0;
      before->from = leg.to - turned(leg.from - before->from, turn);
      before->heading = turned(before->heading, turn);
    }
    return before;
  }
  if (!leg.turns() || !leg.has_heading()) {
    return onward(before, leg.from);
  }
  Approach approach(leg.to - leg.track(1));
  approach.turning = true;
  return approach;
}

double horizontal_turn(const Approach& before, const Vec3& here, const Vec3& next,
                       bool turns_on_the_spot) {
  const Vec3 heading = turns_on_the_spot ? Vec3(here - before.from) : before.heading_at(here);
  return turn_angle_horizontal(heading, next - here);
}

double corner_radius(const Approach& before, const Vec3& here, const Vec3& next,
                     bool turns_on_the_spot) {
  const Vec3 incoming = here - before.from;
  const bool turned_on_the_spot =
      !has_heading(incoming) &&
      horizontal_turn(before, here, next, turns_on_the_spot) > kAngleTolerance;
  return turned_on_the_spot ? 0 : fillet_radius(incoming, next - here);
}

std::optional<Approach> approach(const Polyline& route, std::size_t to,
                                 const std::optional<Approach>& before) {
  std::size_t last = to;  // last point that differs from point number `to`
  while (last > 0 && route[last] == route[to]) {
    --last;
  }
  if (route[last] == route[to]) {
    return before;
  }
  std::size_t leg = last;  // start of the last leg with a heading before that point
  while (leg > 0 && !has_heading(route[leg] - route[leg - 1])) {
    --leg;
  }
  if (leg > 0) {
    return Approach(route[last], route[leg] - route[leg - 1]);
  }
  return Approach(route[last], before ? before->heading_at(route.front()) : Vec3::Zero());
}
}  // namespace altiplan
