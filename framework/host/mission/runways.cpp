// SPDX-License-Identifier: Apache-2.0
#include "host/mission/runways.hpp"

#include <cmath>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {
namespace {

constexpr double kRounded = 1;  // metres, by which files of missions are off

Vec3 course_of(double compass_deg) { return unit_heading(radians(90 - compass_deg)); }

double heading_on(const Request& request, double compass_deg, const Vec3& at, const char* key) {
  const auto heading = request.heading_on(course_of(compass_deg), at);
  if (!heading) {
    throw Error(std::string(key) + ": the wind does not let an aeroplane of " +
                with_digits(request.air_speed(), 4) + " m/s hold a course of " +
                with_digits(compass_deg, 4) + " degrees");
  }
  return *heading;
}
}  // namespace

LandingLine line_of(const LandingEntry& landing, const Vec3& touch) {
  const Vec3 along = course_of(landing.course_deg);
  const double glide_m = landing.height_m / std::tan(radians(landing.glide_deg));
  const Vec3 fix = touch - glide_m * along + Vec3(0, 0, landing.height_m);
  return {fix - landing.level_m * along, fix};
}

Vec3 end_of(const TakeOffEntry& takeoff, const Vec3& start) {
  const double climb_m = takeoff.height_m / std::tan(radians(takeoff.climb_deg));
  return start + (climb_m + takeoff.level_m) * course_of(takeoff.course_deg) +
         Vec3(0, 0, takeoff.height_m);
}

void add_runways(const ScenarioFile& file, Mission& mission) {
  Request& request = mission.request;
  if (const auto& takeoff = file.start.takeoff) {
    const Vec3 end = end_of(*takeoff, request.start.position);
    const double heading = heading_on(request, takeoff->course_deg, end, "start.takeoff");
    mission.runways.climbs_to = end;
    mission.via.insert(mission.via.begin(), {end, kRounded, heading, std::nullopt});
    const Vec3 velocity = request.ground_velocity({request.start.position, heading});
    request.start.velocity = mission.track_request.start.velocity = velocity;
  }
  if (const auto& landing = file.goal.landing) {
    const LandingLine line = line_of(*landing, request.goal.position);
    const double heading = heading_on(request, landing->course_deg, line.entry, "goal.landing");
    mission.runways.glides_from = line.fix;
    mission.via.push_back({line.entry, kRounded, heading, std::nullopt});
  }
}

std::optional<Polyline> runway_section(const Mission& mission, const Vec3& from, const Vec3& to) {
  const Runways& runways = mission.runways;
  if (runways.climbs_to && from == mission.request.start.position && to == *runways.climbs_to) {
    return Polyline{from, to};
  }
  if (runways.glides_from && to == mission.request.goal.position) {
    return *runways.glides_from == to ? Polyline{from, to}
                                      : Polyline{from, *runways.glides_from, to};
  }
  return std::nullopt;
}
}  // namespace altiplan::host
