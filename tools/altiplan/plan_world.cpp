// SPDX-License-Identifier: Apache-2.0
#include "plan_world.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "altiplan/formats/geojson.hpp"
#include "altiplan/formats/mission_commands.hpp"
#include "host/first_route/tiles.hpp"
#include "host/first_route/zones.hpp"
#include "host/gate/plan_report.hpp"
#include "host/result/result_json.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::cli {
namespace {

using host::Json;

/// Of a flight without an end, seconds.
constexpr double kLongest = 86400;
/// Its time is known before its world is, but for what the ground adds.
constexpr double kMargin = 1.1;
/// The scenario that options describe, in messages.
constexpr std::string_view kWorld = "the world of --terrain";

std::filesystem::path absolute(const std::string& file) {
  return std::filesystem::absolute(file).lexically_normal();
}

/// Quoted, absolute; JSON's strings are YAML's.
std::string path_text(const std::string& file) {
  return host::exact_json_text(absolute(file).string());
}

std::string name_of(const std::string& file) {
  return std::filesystem::path(file).filename().string();
}

/// True if the mission has a fence for the autopilot; of other formats polygons are areas of work.
bool has_fence(const formats::MissionFile& mission) {
  using Format = formats::MissionFile::Format;
  return !mission.zones.empty() &&
         (mission.format == Format::qgc_plan || mission.format == Format::waypoints);
}

/// Those that a KML or GeoJSON file has beside its line.
std::vector<formats::Zone> zones_beside(const std::string& file,
                                        const formats::MissionFile& mission) {
  using Format = formats::MissionFile::Format;
  if (mission.format == Format::kml) {
    return mission.zones;
  }
  std::vector<formats::Zone> zones;
  if (mission.format == Format::geojson) {
    const formats::GeoJson json = formats::read_geojson(file);
    for (const auto* features : {&json.features, &json.surroundings}) {
      std::transform(features->begin(), features->end(), std::back_inserter(zones),
                     formats::zone_of);
    }
  }
  return zones;
}

bool is_airspace(const PlanCheck& plan) {
  return std::any_of(plan.airspace.begin(), plan.airspace.end(), [&](const std::string& file) {
    return absolute(file) == absolute(plan.plan);
  });
}

/// A polygon with a role is a zone; another one may be an area of work.
bool has_roles(const std::vector<formats::Zone>& zones) {
  return std::any_of(zones.begin(), zones.end(), [](const formats::Zone& zone) {
    return zone.restriction != formats::Restriction::unspecified;
  });
}

std::string point_text(const char* key, const formats::MissionItem& item) {
  return std::string(key) + ": {at_lonlat: [" + host::exact_json_text(item.at.lon) + ", " +
         host::exact_json_text(item.at.lat) + ", 0]}\n";
}

}  // namespace

std::vector<LonLat> positions_of(const formats::MissionFile& mission) {
  std::vector<LonLat> positions;
  const auto add = [&](double lon, double lat) {
    if (lon != 0 || lat != 0) {
      positions.push_back({lon, lat});
    }
  };
  for (const formats::MissionItem& item : mission.items) {
    add(item.at.lon, item.at.lat);
  }
  for (const formats::MissionCommand& command : mission.commands) {
    if (formats::flies_to_position(formats::command_task(command.number).task)) {
      add(command.lon, command.lat);
    }
  }
  for (const formats::MissionPoint& rally : mission.rally) {
    add(rally.lon, rally.lat);
  }
  if (mission.home) {
    add(mission.home->lon, mission.home->lat);
  }
  return positions;
}

namespace {

/// Seconds for which zones with hours are looked at.
double horizon_s(const PlanCheck& plan, const formats::MissionFile& mission) {
  return std::min(plan.flown_s
                      ? *plan.flown_s
                      : kMargin * time_of(host::flights_of(mission, nullptr, plan.gate)).max_s,
                  kLongest);
}

/// The models, first the one below the most of the mission: it gives the world its frame. Throws
/// Error for one that names no coordinate system, and none is given.
std::vector<host::Tile> models_about(const PlanCheck& plan, const formats::MissionFile& mission,
                                     const host::Overrides& overrides) {
  host::Registry registry(host::Registry::search_path(overrides.plugin_path));
  host::RouteWish wish;
  wish.terrain.assign(plan.terrain.begin(), plan.terrain.end());
  if (!plan.crs.empty()) {
    wish.crs = plan.crs;
  }
  std::vector<host::Tile> tiles = host::read_tiles(wish, registry);
  for (const host::Tile& tile : tiles) {
    if (plan.crs.empty() && !tile.crs.empty()) {  // guessed
      throw Error("--terrain: " + tile.file.string() +
                  ": the file names no coordinate system: give --crs EPSG:CODE, EPSG:4326 for "
                  "longitude and latitude");
    }
  }
  const std::vector<LonLat> positions = positions_of(mission);
  if (tiles.size() > 1 && !positions.empty()) {
    constexpr double kReach = 30'000;  // metres that no flight leaves its positions
    const Frame frame = Frame::local(positions.front());
    Box reached = Box::empty();
    for (const LonLat& at : positions) {
      const auto [x, y] = frame.to_local(at[0], at[1]);
      reached = reached.with({x, y, 0});
    }
    std::vector<host::Tile> near = tiles;
    host::drop_distant(near, frame, reached.grown(kReach));
    tiles = near.empty() ? tiles : std::move(near);
  }
  const auto held = [&](const host::Tile& tile) {
    return std::count_if(positions.begin(), positions.end(),
                         [&](const LonLat& at) { return tile.holds(at[0], at[1]); });
  };
  std::stable_sort(tiles.begin(), tiles.end(),
                   [&](const host::Tile& a, const host::Tile& b) { return held(a) > held(b); });
  tiles = host::united(std::move(tiles), registry);
  for (host::Tile& tile : tiles) {  // whose names the scenario's folder does not change
    tile.file = absolute(tile.file);
    std::transform(tile.more.begin(), tile.more.end(), tile.more.begin(),
                   [](const std::filesystem::path& file) { return absolute(file); });
  }
  return tiles;
}

/// The scenario that the options describe.
std::string world_text(const PlanCheck& plan, const formats::MissionFile& mission,
                       const host::Overrides& overrides) {
  // A void is closed: whatever flies over it flies into the ground.
  const std::string voids =
      plan.fills_voids ? "voids: neighbours"
                       : "voids: fill_m, fill_m: " + host::exact_json_text(host::kClosedGround);
  std::string text = "altiplan: 1\nenvironment:\n";
  std::set<std::string> ids;
  for (const host::Tile& model : models_about(plan, mission, overrides)) {
    std::string id = "terrain";
    while (!ids.insert(id).second) {
      id = "terrain " + std::to_string(ids.size() + 1);
    }
    text += "  - terrain: {" + host::files_text(model) +
            (plan.crs.empty() ? "" : ", crs: " + host::exact_json_text(plan.crs)) + ", " + voids +
            "}\n    id: " + host::exact_json_text(id) + "\n";
  }
  const auto add_zones = [&](const std::string& file, std::string name, const std::string& more) {
    while (!ids.insert(name).second) {
      name += "'";  // of another folder
    }
    text += "  - zones: {file: " + path_text(file) + more +
            "}\n    id: " + host::exact_json_text(name) + "\n";
  };
  const host::ZoneUse use{plan.start_time.has_value(), plan.buffer_m, plan.permitted};
  const double seconds = plan.start_time ? horizon_s(plan, mission) : 0;
  for (const std::string& file : plan.airspace) {
    const std::string hours = plan.start_time  // else zones count at all hours
                                  ? ", horizon_s: " + host::exact_json_text(seconds)
                                  : "";
    add_zones(file, name_of(file), hours + host::zone_parameters(absolute(file), use));
  }
  if (has_fence(mission)) {
    add_zones(plan.plan, "fence of the mission", host::zone_parameters(absolute(plan.plan), use));
  } else if (!is_airspace(plan) && has_roles(zones_beside(plan.plan, mission))) {
    add_zones(plan.plan, "zones of the mission", host::zone_parameters(absolute(plan.plan), use));
  }
  // The ground and the zones alone bound a mission.
  text += "volume: {min_m: [-1e8, -1e8, -1e4], max_m: [1e8, 1e8, 1e5]}\n";
  text += "vehicle: {radius_m: " + host::exact_json_text(plan.radius_m) + "}\n";
  // Heights are the mission's own; the judge is told.
  text += point_text("start", mission.items.front()) + point_text("goal", mission.items.back());
  if (plan.start_time) {
    text += "start_time: " + host::exact_json_text(*plan.start_time) + "\n";
  }
  std::string constraints;
  const auto add = [&](const char* words, const std::optional<double>& metres) {
    if (metres) {
      constraints += std::string("  - ") + words + ": " + host::exact_json_text(*metres) + "}\n";
    }
  };
  add("ground_clearance: {min_m", plan.min_above_ground_m);
  add("altitude: {datum: ground, max_m", plan.max_above_ground_m);
  add("ground_distance: {max_m", plan.max_ground_distance_m);
  return text + "constraints:\n" + (constraints.empty() ? "  []\n" : constraints);
}
}  // namespace

std::vector<std::string> zones_not_judged(const PlanCheck& plan,
                                          const formats::MissionFile& mission) {
  const std::vector<formats::Zone> zones = zones_beside(plan.plan, mission);
  std::vector<std::string> names;
  if (!is_airspace(plan) && (plan.scenario || !has_roles(zones))) {
    for (const formats::Zone& zone : zones) {
      names.push_back(zone.name.empty() ? "a polygon without a name" : "'" + zone.name + "'");
    }
  }
  return names;
}

std::string about_file(const Error& error) {
  const auto* of_file = dynamic_cast<const ConfigError*>(&error);
  if (of_file == nullptr || of_file->problems().size() != 1) {
    return error.what();
  }
  const Problem& problem = of_file->problems().front();
  return problem.where.file == kWorld && problem.key.ends_with(".file") ? problem.message
                                                                        : error.what();
}

std::vector<std::string> models_of(const PlanCheck& plan) {
  std::vector<std::string> files;
  for (const std::string& given : plan.terrain) {
    for (const std::filesystem::path& file : host::model_files(given)) {
      files.push_back(file.string());
    }
  }
  return files;
}

host::Config world_of(const PlanCheck& plan, const formats::MissionFile& mission,
                      const host::Overrides& overrides) {
  host::Config config = host::load_scenario_text(world_text(plan, mission, overrides),
                                                 std::string(kWorld), overrides);
  config.is_only_judged = true;
  config.about = positions_of(mission);
  return config;
}
}  // namespace altiplan::cli
