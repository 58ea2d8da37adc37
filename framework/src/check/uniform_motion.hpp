// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "altiplan/request.hpp"

namespace altiplan {

/// Calls `use(begin, end, seconds)`, in metres along the straight leg a–b, for each part that the
/// vehicle flies at one speed, by its speed profile, or as fast as its rates of climb and sink
/// allow. With such rates its speed is that over the ground, as of autopilots that hover: along a
/// slope it is faster.
template <class Use>
void at_its_speeds(const World& world, const Vehicle& vehicle, const Vec3& a, const Vec3& b,
                   const Use& use) {
  const double total = (b - a).norm();
  const double changes_height_s = vehicle.climb_time(b.z() - a.z());
  const double level = total > 0 ? vehicle.counted_m(b - a) / total : 1;
  if (vehicle.speed_near.empty()) {
    use(0, total, std::max(level * total / vehicle.speed_mps, changes_height_s));
    return;
  }
  // Clearance changes by at most a metre per metre: the speed is constant until a threshold can be
  // reached.
  constexpr double kMinStep = 1;
  double along = 0;
  while (along < total) {
    const double clearance = world.clearance(a + along / total * (b - a));
    double step = kInfinity;
    for (const SpeedNear& near : vehicle.speed_near) {
      step = std::min(step, std::abs(clearance - near.within_m));
    }
    step = std::min(std::max(step, kMinStep), total - along);
    use(along, along + step,
        std::max(level * step / vehicle.speed_at(clearance), step / total * changes_height_s));
    along += step;
  }
}

/// Calls `use(a, t0, b, t1)` for each part of a straight leg, or of a wait, that begins at `time_s`
/// and is in uniform straight motion in one wind; until it returns false. False if it did. An
/// aeroplane keeps its airspeed, a vehicle that hovers its speed over the ground, in any wind, as
/// autopilots do.
template <class Use>
bool in_uniform_motion(const Leg& leg, double time_s, const Request& request, const Use& use) {
  const Vec3 way = leg.to - leg.from;
  bool goes_on = true;
  const auto in_one_wind = [&](double begin, double end, double seconds) {
    const double t1 = time_s + seconds;
    goes_on = goes_on && use(leg.from + begin * way, time_s,
                             end == 1 ? leg.to : Vec3(leg.from + end * way), t1);
    time_s = t1;
  };
  const auto wind_until = [&](double at_s) { return request.wind.in_force_until(at_s); };
  // Flies a part until it ends, or the wind changes: returns where that is.
  const auto part = [&](double begin, double end, double seconds) {
    const double left_s = wind_until(time_s) - time_s;
    if (seconds > left_s && std::isfinite(seconds)) {
      end = begin + (end - begin) * left_s / seconds;
      seconds = left_s;
    }
    in_one_wind(begin, end, seconds);
    return end;
  };
  if (request.vehicle.wing && !leg.waits()) {
    const bool changes = !request.wind.changes.empty();
    for (double begin = 0; begin < 1 && goes_on;) {
      const Wind then = changes ? request.wind.in_force(time_s) : Wind{};
      const Wind& wind = changes ? then : request.wind;
      const double until_s = wind_until(time_s);
      std::vector<double> ends = wind.crossings(leg.from, leg.to);
      ends.push_back(1);
      for (auto end = std::upper_bound(ends.begin(), ends.end(), begin);
           end != ends.end() && wind_until(time_s) == until_s; ++end) {
        const Vec3 from = leg.from + begin * way;
        const Vec3 to = leg.from + *end * way;
        const double seconds = flight_time(from, to, request.air_speed(), wind);
        begin = part(begin, *end,
                     std::max(seconds, request.vehicle.climb_time((*end - begin) * way.z())));
      }
    }
    return goes_on;
  }
  const auto steadily = [&](double begin, double end, double seconds) {
    for (double reached = begin; begin < end; begin = reached) {
      reached = part(begin, end, seconds);
      seconds *= (end - reached) / (end - begin);
    }
  };
  const double total = way.norm();
  if (leg.waits()) {
    steadily(0, 1, leg.hold_s);
    return goes_on;
  }
  at_its_speeds(*request.world, request.vehicle, leg.from, leg.to,
                [&](double begin, double end, double seconds) {
                  total > 0 ? steadily(begin / total, end / total, seconds)
                            : steadily(0, 1, seconds);
                });
  return goes_on;
}
}  // namespace altiplan
