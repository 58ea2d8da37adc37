// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/dubins/steering.hpp"

#include <algorithm>
#include <string>

#include "altiplan/check.hpp"

namespace altiplan::kit {
namespace {

/// A vertical climb has no heading.
constexpr double kSteepest = radians(75);

/// Length through the air, in units of the airspeed the time, of a straight displacement in a wind
/// that is given in the same units and is slower than 1.
double straight_through_air(const Vec3& displacement, const Vec3& wind) {
  const double squared = displacement.head<2>().squaredNorm();
  const double along = displacement.head<2>().dot(wind.head<2>());
  const double a = 1 - wind.head<2>().squaredNorm();
  return (std::sqrt(along * along + a * squared) - along) / a;
}

bool are_one(const Leg& a, const Leg& b) {
  if (!a.turns() || !b.turns()) {
    const bool straight = !a.turns() && !b.turns();
    return straight && turn_angle_in_space(a.to - a.from, b.to - b.from) <= kAngleTolerance / 10;
  }
  const double slope_a = (a.to.z() - a.from.z()) / a.air_length();
  const double slope_b = (b.to.z() - b.from.z()) / b.air_length();
  return a.turn * b.turn > 0 && std::abs(a.radius - b.radius) <= 1e-9 * a.radius &&
         std::abs(slope_a - slope_b) <= 1e-9 &&
         (a.drift / a.air_length() - b.drift / b.air_length()).norm() <= 1e-9;
}

/// The same path with equal pieces in a row as one leg.
std::vector<Leg> joined(const std::vector<Leg>& legs) {
  std::vector<Leg> all;
  for (const Leg& leg : legs) {
    if (!all.empty() && are_one(all.back(), leg)) {
      Leg& last = all.back();
      last.turn += leg.turn;
      last.drift += leg.drift;
      last.to = leg.to;
    } else {
      all.push_back(leg);
    }
  }
  return all;
}

Route chained(const std::vector<Leg>& legs, const Vec3& start) {
  Route route{start};
  for (const Leg& leg : legs) {
    route.push_back(leg);
  }
  return route;
}
}  // namespace

Steering::Steering(const Request& request, double radius)
    : speed_(request.air_speed()), wind_(request.wind), goal_(request.goal) {
  const Limits& limits = request.limits;
  limits_.radius = radius;
  limits_.climb = request.level_m ? 0 : std::min(limits.max_climb, kSteepest);
  limits_.sink = request.level_m ? 0 : std::min(limits.max_descent(), kSteepest);
  is_layered_ = !wind_.is_uniform(request.volume);
  for (std::size_t i = 0; i < wind_.layers.size(); ++i) {
    const bool is_below =
        i + 1 < wind_.layers.size() && wind_.layers[i + 1].above_m < request.volume.min.z();
    if (!is_below && wind_.layers[i].above_m <= request.volume.max.z()) {
      strongest_ = std::max(strongest_, wind_.layers[i].max_speed());
    }
  }
}

std::optional<Pose> Steering::in_wind(const Pose& pose, const Vec3& wind) const {
  const Vec3 there = wind_.at(pose.position);
  if (there == wind) {
    return pose;
  }
  const auto heading = heading_on(speed_ * unit_heading(pose.heading) + there, speed_, wind);
  return heading ? std::optional(Pose{pose.position, *heading}) : std::nullopt;
}

Pose Steering::pose_on(const Leg& leg, double share, double heading) const {
  const Vec3 at = leg.at(share);
  if (is_layered_ && leg.has_heading()) {
    heading = heading_on(leg.track(share), speed_, wind_.at(at)).value_or(heading);
  }
  return {at, heading};
}

Leg Steering::piece(const Pose& from, double length, double turn, double gradient) const {
  const Vec3 drift = length / speed_ * wind_.at(from.position);
  const double climb = gradient * length;
  if (turn != 0) {
    return Leg::turning(from, turn, length / std::abs(turn), climb, drift);
  }
  return Leg::straight(from.position, from.position + length * unit_heading(from.heading) + drift +
                                          Vec3(0, 0, climb));
}

Leg Steering::piece_to(const Pose& to, double length, double turn, double gradient) const {
  const Vec3 drift = length / speed_ * wind_.at(to.position);
  const double climb = gradient * length;
  if (turn != 0) {  // flown backwards, in the reversed wind
    const Pose back{to.position, to.heading + kPi};
    return Leg::turning(back, -turn, length / std::abs(turn), -climb, -drift).reversed();
  }
  return Leg::straight(to.position - length * unit_heading(to.heading) - drift - Vec3(0, 0, climb),
                       to.position);
}

std::optional<PosePath> Steering::path(const Pose& from, const Pose& to) const {
  const Vec3 wind = wind_between(from, to);
  const auto a = in_wind(from, wind);
  const auto b = in_wind(to, wind);
  if (!a || !b) {
    return std::nullopt;
  }
  if (wind.isZero(0)) {
    const auto path = airplane_path(*a, *b, limits_);
    return path ? std::optional(PosePath{path->legs(*a, to.position), path->length()})
                : std::nullopt;
  }
  const auto path = wind_path(*a, *b, limits_, {speed_, wind});
  return path ? std::optional(PosePath{path->legs(*a, to.position), path->through_air.length()})
              : std::nullopt;
}

double Steering::length(const Pose& from, const Pose& to, double at_most) const {
  const Vec3 wind = wind_between(from, to);
  const auto a = in_wind(from, wind);
  const auto b = in_wind(to, wind);
  if (!a || !b) {
    return kInfinity;
  }
  if (wind.isZero(0)) {
    return airplane_length(*a, *b, limits_, at_most);
  }
  const auto path = wind_path(*a, *b, limits_, {speed_, wind}, at_most);
  return path ? path->through_air.length() : kInfinity;
}

double Steering::min_length(const Pose& from, const Pose& to) const {
  const Vec3 apart = to.position - from.position;
  const Vec3 wind = wind_between(from, to);
  const double straight = is_calm()        ? apart.head<2>().norm()
                          : is_too_windy() ? 0
                                           : straight_through_air(apart, wind / speed_);
  const auto a = in_wind(from, wind);
  const auto b = in_wind(to, wind);
  if (!a || !b) {
    return kInfinity;
  }
  const double turn = std::abs(std::remainder(b->heading - a->heading, 2 * kPi));
  return std::max({straight, limits_.radius * turn, limits_.min_length(apart.z())});
}

double Steering::min_length_to_goal(const Pose& from, double over_ground) const {
  if (goal_.tolerance_m > 0) {
    return std::max(0.0, over_ground - goal_.tolerance_m);
  }
  const double rise = goal_.position.z() - from.position.z();
  const double length = std::max(over_ground, limits_.min_length(rise));
  return is_calm() && goal_.heading
             ? std::max(length, airplane_length(from, {goal_.position, *goal_.heading}, limits_))
             : length;
}

Pose Steering::pose_at(const Pose& from, const PosePath& path, double length) const {
  // A path has one straight leg at most, whose length through the air is what the turns leave.
  double straight = path.length;
  for (const Leg& leg : path.legs) {
    straight -= leg.turns() ? leg.air_length() : 0;
  }
  double heading = from.heading;
  for (const Leg& leg : path.legs) {
    const double flown = leg.turns() ? leg.air_length() : straight;
    if (length < flown) {
      const double part = length / flown;
      return pose_on(leg, part, heading + part * leg.turn);
    }
    length -= flown;
    heading += leg.turn;
  }
  return path.legs.empty() ? from : pose_on(path.legs.back(), 1, heading);
}

Route route_of(const std::vector<Leg>& legs, const Vec3& alone, const Request& request) {
  const Vec3& start = legs.empty() ? alone : legs.front().from;
  const Route whole = chained(joined(legs), start);
  return check(whole, request).ok() ? whole : chained(legs, start);
}

PlanResult too_windy() {
  PlanResult result;
  result.status = PlanStatus::no_route;
  result.message = "the wind is as fast as the aeroplane: no circle leads back to its start";
  result.counters = {{"expanded", 0}};
  return result;
}

std::optional<PlanResult> unsolvable(const Request& request, double turn_radius) {
  if (turn_radius > 0) {
    return Steering(request, turn_radius).is_too_windy() ? std::optional(too_windy())
                                                         : std::nullopt;
  }
  if (!request.start.loiter && !request.goal.loiter) {
    return std::nullopt;
  }
  PlanResult result;
  result.status = PlanStatus::invalid_problem;
  result.reason = request.start.loiter ? Reason::start : Reason::goal;
  result.message = std::string("the ") + name(result.reason) +
                   " is a loiter circle, which straight legs do not meet tangentially: give the "
                   "vehicle a wing, or the planner `steering: dubins` and a radius_m";
  result.counters = {{"expanded", 0}};
  return result;
}
}  // namespace altiplan::kit
