// SPDX-License-Identifier: Apache-2.0
#include "mission_options.hpp"

#include "altiplan/formats/iso_time.hpp"
#include "altiplan/formats/mission_file.hpp"
#include "host/first_route/zones.hpp"
#include "host/import_export/route_format.hpp"

namespace altiplan::cli {
namespace {

/// A mission in a world that options describe, in place of a scenario.
void add_world_options(App& command, Option* terrain, PlanCheck& plan) {
  const auto metres = [&](const char* name, auto& value, const char* what) {
    command.add_option(std::string(name) + " METRES", value, what)
        ->check(number_from(0, 1e5))
        ->needs(terrain);
  };
  command.add_option("--airspace FILE", plan.airspace, "zones over it; repeatable")
      ->take_all()
      ->one_at_a_time()
      ->needs(terrain);
  command.add_option("--crs EPSG:CODE", plan.crs, "coordinate system of a model that names none")
      ->needs(terrain);
  add_permission(command, plan.permitted)->needs(terrain);
  add_buffer(command, plan.buffer_m)->needs(terrain);
  command
      .add_flag(
          "--fill-voids", plan.fills_voids,
          "fill voids of the elevation model from their neighbours; else nothing may fly over "
          "them")
      ->needs(terrain);
  metres("--radius", plan.radius_m, "radius of the vehicle (m, default 0)");
  metres("--agl", plan.above_ground_m,
         "height above ground at the points of a line that has none, such as one clamped to the "
         "ground (m)");
  metres("--min-agl", plan.min_above_ground_m, "minimum height above ground (m)");
  metres("--max-agl", plan.max_above_ground_m, "greatest height above ground (m)");
  metres("--max-distance", plan.max_ground_distance_m,
         "greatest distance from the nearest point of the ground (m)");
  command
      .add_option("--start-time TIME", plan.start_time,
                  "UTC, 2026-05-01T10:00:00Z: for zones with hours")
      ->needs(terrain);
  command
      .add_option("--speed M/S", plan.gate.drawn_mps,
                  "along lines of a file without commands, for zones with hours (m/s, default 5)")
      ->check(number_from(0.01, 1000))
      ->needs(terrain);
}

/// Who flies a mission, where its file does not say.
void add_autopilot_options(App& command, MissionOptions& mission) {
  command.add_option("--autopilot NAME", mission.autopilot, "who flies it: ardupilot or px4")
      ->check(Check::one_of({"ardupilot", "px4"}));
  command.add_option("--vehicle NAME", mission.vehicle, "what flies: copter, plane or vtol")
      ->check(Check::one_of({"copter", "plane", "vtol"}));
  command.add_option("--params FILE", mission.plan.parameters,
                     "the autopilot's parameters (.param, .params), in place of its defaults");
  command
      .add_option("--runway DEGREES", mission.plan.gate.flight.runway_deg,
                  "heading of an aeroplane's take-off, and of ArduPilot's VTOL then, clockwise "
                  "from north")
      ->check(number_from(0, 360));
  command
      .add_option("--wind M/S", mission.plan.gate.flight.wind_mps,
                  "strongest wind that an aeroplane is judged in, from anywhere (m/s, default 0)")
      ->check(number_from(0, 100));
}
}  // namespace

Option* add_basemap(App& command, std::optional<std::string>& file) {
  return command.add_option(
      "--basemap FILE", file,
      "show this image on the ground of the page: GeoTIFF, or MBTiles of PNG or "
      "JPEG tiles");
}

Option* add_permission(App& command, std::vector<std::string>& permitted) {
  return command
      .add_option("--permission [ZONE]", permitted,
                  "the zone of this name or identifier is open, because you have the permission "
                  "that it takes; without one, all that take a permission; repeatable")
      ->take_all()
      ->otherwise(host::kEveryZone);
}

Option* add_buffer(App& command, double& buffer_m) {
  return command
      .add_option("--buffer METRES", buffer_m,
                  "distance to keep from all zones, in any direction, and from the border of those "
                  "to stay in (m, default 0)")
      ->check(number_from(0, 1e5));
}

void expect_permissions(const std::vector<std::string>& permitted,
                        const std::vector<std::string>& files) {
  std::string problem;
  try {
    problem = host::permission_problem(permitted, {files.begin(), files.end()});
  } catch (const Error&) {
    return;  // who uses the file says what is wrong with it
  }
  if (!problem.empty()) {
    throw UsageError{"--permission: " + problem};
  }
}

Option* add_mission_options(App& command, MissionOptions& mission) {
  Option* terrain =
      command
          .add_option("--terrain FILE", mission.plan.terrain,
                      "elevation model over which to judge a mission, or a folder of tiles; "
                      "repeatable")
          ->take_all()
          ->one_at_a_time();
  add_world_options(command, terrain, mission.plan);
  add_autopilot_options(command, mission);
  return terrain;
}

PlanCheck checked_plan(const MissionOptions& mission, const std::string& file) {
  using formats::Airframe;
  PlanCheck plan = mission.plan;
  plan.plan = file;
  if (plan.start_time && (plan.start_time->find('T') == std::string::npos ||
                          !formats::parse_iso_time(*plan.start_time))) {
    throw UsageError{"--start-time: expected a time such as 2026-05-01T10:00:00Z, found '" +
                     *plan.start_time + "'"};
  }
  if (plan.min_above_ground_m && plan.max_above_ground_m &&
      !(*plan.min_above_ground_m < *plan.max_above_ground_m)) {
    throw UsageError{"--min-agl: expected less than --max-agl"};
  }
  expect_permissions(plan.permitted, plan.airspace);
  if (mission.autopilot) {
    plan.gate.firmware =
        *mission.autopilot == "px4" ? formats::Firmware::px4 : formats::Firmware::ardupilot;
  }
  if (mission.vehicle) {
    plan.gate.airframe = *mission.vehicle == "copter"  ? Airframe::copter
                         : *mission.vehicle == "plane" ? Airframe::plane
                                                       : Airframe::vtol;
  }
  return plan;
}

bool is_mission(const MissionOptions& mission, const std::string& file) {
  if (mission.plan.terrain.empty() && host::is_mission_name(file) &&
      std::filesystem::exists(file)) {
    throw UsageError{file + " is a mission: add --terrain DEM, over which it is judged"};
  }
  return !mission.plan.terrain.empty();
}
}  // namespace altiplan::cli
