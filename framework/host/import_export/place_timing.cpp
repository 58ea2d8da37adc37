// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/place_timing.hpp"

#include <algorithm>

#include "altiplan/measures.hpp"

namespace altiplan::host {
namespace {

/// The slowest speed that a distance from obstacles along the leg asks for.
double slowest(const Leg& leg, const World& world, const Vehicle& vehicle) {
  double clearance = vehicle.speed_near.back().within_m;
  const std::vector<Vec3> points = leg.chords(kChordTolerance);
  for (std::size_t i = 1; i < points.size(); ++i) {
    for (const Layer& layer : world.layers()) {
      clearance = std::min(clearance,
                           leg_clearance(*layer.environment, points[i - 1], points[i], clearance));
    }
  }
  double speed = vehicle.speed_mps;
  for (const SpeedNear& near : vehicle.speed_near) {
    if (near.within_m >= clearance) {
      speed = std::min(speed, near.speed_mps);
    }
  }
  return speed;
}
}  // namespace

std::vector<PlaceTiming> timing_of(const std::vector<MissionPlace>& places,
                                   const Mission& mission) {
  const Request& request = mission.request;
  const JoinedRoute joined = joined_route(places, std::nullopt, request.limits);
  const Vehicle& vehicle = request.vehicle;
  std::vector<PlaceTiming> timing(places.size());
  double time_s = 0;
  for (std::size_t i = 0; i < joined.route.leg_count(); ++i) {
    const Leg leg = joined.route.leg(i);
    PlaceTiming& place = timing[joined.places[i + 1]];
    if (vehicle.speed_near.empty()) {
      time_s += leg_duration(leg, request.start.time_s + time_s, request);
    } else {
      const double speed = slowest(leg, *request.world, vehicle);
      place.speed_mps = place.speed_mps > 0 ? std::min(place.speed_mps, speed) : speed;
      time_s += leg.length() / speed;
    }
    place.time_s = time_s;
  }
  return timing;
}

std::size_t speed_changes(const std::vector<PlaceTiming>& timing, double speed_mps) {
  std::size_t count = 0;
  for (const PlaceTiming& place : timing) {
    if (place.speed_mps > 0 && place.speed_mps != speed_mps) {
      speed_mps = place.speed_mps;
      ++count;
    }
  }
  return count;
}
}  // namespace altiplan::host
