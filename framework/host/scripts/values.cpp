// SPDX-License-Identifier: Apache-2.0
#include "host/scripts/values.hpp"

#include <cmath>

#include "altiplan/error.hpp"

namespace altiplan::host {
namespace {

Json numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// JSON has no infinity.
Json bound(double value) { return std::isfinite(value) ? Json(value) : Json(); }

template <class T>
Json maybe(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json limits_of(const Limits& limits) {
  Json bands = Json::array();
  for (const AltitudeBand& band : limits.altitude) {
    bands.push_back({{"above_ground", band.datum == AltitudeBand::Datum::ground},
                     {"min_m", bound(band.min)},
                     {"max_m", bound(band.max)}});
  }
  return {{"min_clearance_m", limits.min_clearance},
          {"min_ground_clearance_m", maybe(limits.min_ground_clearance)},
          {"altitude", bands},
          {"min_leg_m", limits.min_leg},
          {"max_leg_m", bound(limits.max_leg)},
          {"max_turn", limits.max_turn_horizontal},
          {"max_turn_in_space", limits.max_turn_space},
          {"min_turn_radius_m", limits.min_turn_radius},
          {"max_climb", limits.max_climb},
          {"max_descent", limits.max_descent()},
          {"max_route_m", bound(limits.max_route_length)}};
}

Json vehicle_of(const Vehicle& vehicle) {
  Json json = {{"radius_m", vehicle.radius_m},
               {"speed_mps", vehicle.speed_mps},
               {"sensing_m", bound(vehicle.sensing_m)},
               {"wing", Json()}};
  if (vehicle.wing) {
    const Wing& wing = *vehicle.wing;
    json["wing"] = {{"airspeed_mps", wing.airspeed_mps},
                    {"bank", wing.bank},
                    {"climb", wing.climb},
                    {"sink", wing.sink},
                    {"turn_radius_m", wing.turn_radius()}};
  }
  return json;
}

Json wind_of(const Wind& wind) {
  if (!wind.changes.empty()) {
    throw Error("wind that changes (wind.hours) is not known to plugins in Python");
  }
  Json layers = Json::array();
  for (const Wind::Layer& layer : wind.layers) {
    if (layer.grid) {
      throw Error("wind of a grid (wind.grid) is not known to plugins in Python");
    }
    layers.push_back({{"above_m", bound(layer.above_m)}, {"velocity", numbers(layer.velocity)}});
  }
  return layers;
}

Json budget_of(const Budget& budget) {
  Json json = {{"deadline", Json()}, {"max_iterations", budget.max_iterations}};
  if (budget.deadline) {  // of the clock that Python calls monotonic
    json["deadline"] = std::chrono::duration<double>(budget.deadline->time_since_epoch()).count();
  }
  return json;
}

/// Numbers of the corners; null where one is open.
Json corners_of(const Box& box) {
  Json json = Json::array();
  for (const Vec3& corner : {box.min, box.max}) {
    for (const double number : corner) {
      json.push_back(bound(number));
    }
  }
  return json;
}
}  // namespace

Json script_values(const Request& request) {
  RandomStream random = request.random;
  const bool is_moving = !request.start.velocity.isZero(0);
  return {{"start", numbers(request.start.position)},
          {"start_velocity", is_moving ? numbers(request.start.velocity) : Json()},
          {"goal", numbers(request.goal.position)},
          {"goal_tolerance_m", request.goal.tolerance_m},
          {"goal_heading", maybe(request.goal.heading)},
          {"volume", corners_of(request.volume)},
          {"level_m", maybe(request.level_m)},
          {"vehicle", vehicle_of(request.vehicle)},
          {"limits", limits_of(request.limits)},
          {"wind", wind_of(request.wind)},
          {"threads", request.threads},
          {"seed", random()},
          {"budget", budget_of(request.budget)}};
}

Json script_values(const Site& site) {
  RandomStream random = site.random;
  const auto point = [](const std::optional<Vec3>& p) { return p ? numbers(*p) : Json(); };
  return {{"volume", corners_of(site.volume)},
          {"start", point(site.start)},
          {"goal", point(site.goal)},
          {"vehicle", vehicle_of(site.vehicle)},
          {"start_time_s", site.has_start_time ? Json(site.start_time_s) : Json()},
          {"seed", random()}};
}
}  // namespace altiplan::host
