// SPDX-License-Identifier: Apache-2.0
#include "host/result/stored_result.hpp"

#include "host/result/legs_json.hpp"

#include <algorithm>
#include <set>

#include "altiplan/formats/input_file.hpp"
#include "host/base/machine_fault.hpp"
#include "host/base/sha256.hpp"
#include "host/result/stored_shape.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;
namespace {

bool is_point(const Json& json, std::size_t numbers) {
  return json.is_array() && json.size() == numbers &&
         std::all_of(json.begin(), json.end(), [](const Json& n) { return n.is_number(); });
}

Track track_of(const Json& json, const std::string& file) {
  Track track;
  if (!json.is_array()) {
    throw Error(file + ": expected the flight's track as a list of [t, x, y, z]");
  }
  for (const Json& point : json) {
    if (!is_point(point, 4)) {
      throw Error(file + ": flight.track." + std::to_string(track.size()) +
                  ": expected [t, x, y, z] in seconds and metres, found " + found_text(point));
    }
    track.emplace_back(
        point.at(0).get<double>(),
        Vec3(point.at(1).get<double>(), point.at(2).get<double>(), point.at(3).get<double>()));
    expect_reachable({track.back().second}, file);
    if (track.size() > 1 && track.back().first < track[track.size() - 2].first) {
      throw Error(file + ": point " + std::to_string(track.size() - 1) +
                  " of the flight's track is earlier than the one before it");
    }
  }
  if (track.empty()) {
    throw Error(file + ": the flight has no track");
  }
  return track;
}

/// The overrides of a stored run.
Overrides stored_overrides(const Json& json, Overrides overrides) {
  overrides.scenario = json.at("scenario").get<std::string>();
  overrides.seed = json.at("seed").get<std::int64_t>();
  for (const std::string& assignment : set_texts(json.at("overrides"))) {
    overrides.set.push_back(assignment);
  }
  return overrides;
}

/// Parses; throws Error if an object has a key twice, which is ambiguous.
Json parse_unique(std::istream& in, const std::string& file) {
  std::vector<std::set<std::string>> open;
  return parse_json(in, [&](int, Json::parse_event_t event, const Json& parsed) {
    if (event == Json::parse_event_t::object_start) {
      open.emplace_back();
    } else if (event == Json::parse_event_t::object_end) {
      open.pop_back();
    } else if (event == Json::parse_event_t::key) {
      const auto& key = parsed.get_ref<const std::string&>();
      if (!open.back().insert(key).second) {
        throw Error(file + ": the key " + excerpt(key) + " is given twice in one object");
      }
    }
    return true;
  });
}
}  // namespace

Json read_json(const std::string& file, const std::string& expected) {
  formats::InputFile in(file);
  try {
    return parse_unique(in, file);
  } catch (const Json::parse_error& error) {
    in.clear();
    in.seekg(0);
    std::string before(error.byte > 0 ? error.byte - 1 : 0, '\0');
    in.read(before.data(), std::streamsize(before.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const auto column = before.size() - before.rfind('\n');  // of no line break: from the beginning
    throw Error(file + ":" + std::to_string(line) + ":" + std::to_string(column) +
                ": this is not JSON: expected " + expected);
  } catch (const Json::out_of_range&) {
    throw Error(file + ": holds a number that is too large (beyond 1.8e308)");
  }
}

void expect_reachable(const Polyline& route, const std::string& file) {
  constexpr double kFarthest = 1e8;  // metres
  for (std::size_t n = 0; n < route.size(); ++n) {
    if (!(route[n].cwiseAbs().maxCoeff() <= kFarthest)) {
      throw Error(file + ": point " + std::to_string(n) +
                  " lies beyond 1e8 m, farther away than anything flies");
    }
  }
}

namespace {
/// A result has its route twice; if they differ, which one was flown is unknown.
void expect_equal(const Polyline& route, const Polyline& legs, const std::string& file) {
  const std::size_t common = std::min(route.size(), legs.size());
  std::size_t n = 0;
  while (n < common && (route[n] - legs[n]).norm() <= kLengthTolerance) {
    ++n;
  }
  if (n < common || route.size() != legs.size()) {
    throw Error(file + ": route and legs disagree at point " + std::to_string(n));
  }
}
}  // namespace

Route route_of(const Json& holder, const std::string& file) {
  const Json& json = holder.is_object() ? holder.at("route") : holder;
  Polyline route;
  try {
    for (const Json& p : json.get_ref<const Json::array_t&>()) {  // or it throws
      if (!is_point(p, 3)) {
        throw Error(file + ": point " + std::to_string(route.size()) +
                    " of the route: expected [x, y, z] in metres, found " + found_text(p));
      }
      route.emplace_back(p.at(0).get<double>(), p.at(1).get<double>(), p.at(2).get<double>());
    }
  } catch (const Json::exception&) {
    throw Error(file + ": expected a route as a list of [x, y, z] in metres");
  }
  if (route.empty()) {
    throw Error(file + ": it contains no route");
  }
  expect_reachable(route, file);
  if (!holder.is_object() || !holder.contains("legs") || holder.at("legs").is_null()) {
    return route;
  }
  const Route legs = route_of_legs(route.front(), holder.at("legs"), file + ": legs");
  expect_reachable(legs.waypoints(), file);
  if (legs.is_straight()) {
    return route;
  }
  expect_equal(route, legs.chords(kChordTolerance), file);
  return legs;
}

namespace {
/// The file that the result was made from, where both were copied or moved together.
void take_along(Json& path, const fs::path& from, const fs::path& to) {
  const fs::path way = fs::path(path.get<std::string>()).lexically_relative(from);
  const fs::path moved = (to / way).lexically_normal();
  if (!way.empty() && is_there(moved)) {
    path = moved.string();
  }
}

/// The same for all files of a result.
void take_files_along(Json& json, const std::string& file) {
  if (!json.contains("folder")) {
    return;
  }
  const fs::path to = fs::absolute(file).lexically_normal().parent_path();
  const fs::path from = json.at("folder").get<std::string>();  // where it was written
  if (to == from) {
    return;
  }
  take_along(json.at("pipeline"), from, to);
  take_along(json.at("scenario"), from, to);
  for (Json& used : json.at("files")) {
    take_along(used.at("path"), from, to);
  }
}
}  // namespace

namespace {
/// Those that do something, of a result's task.
std::vector<PlacedStop> stops_of(const Json& json, const std::string& file) {
  std::vector<PlacedStop> stops;
  if (!json.contains("task") || !json.at("task").contains("stops")) {
    return stops;
  }
  for (const Json& each : json.at("task").at("stops")) {
    const std::string place = file + ": task.stops." + std::to_string(stops.size());
    const bool is_whole = each.is_object() && each.contains("at_m") && is_point(each["at_m"], 3) &&
                          each.value("hold_s", Json()).is_number() &&
                          each.value("lands", Json()).is_boolean() &&
                          each.value("drops", Json()).is_boolean();
    if (!is_whole || !(each["hold_s"].get<double>() >= 0)) {
      throw Error(place + ": expected at_m, hold_s, lands and drops, found " + found_text(each));
    }
    const Json& at = each["at_m"];
    stops.push_back(
        {{at[0].get<double>(), at[1].get<double>(), at[2].get<double>()},
         {each["hold_s"].get<double>(), each["lands"].get<bool>(), each["drops"].get<bool>()}});
  }
  return stops;
}
}  // namespace

StoredResult read_result(const std::string& file, const Overrides& overrides) {
  return stored_result(file, read_json(file, "a result of altiplan run"), overrides);
}

StoredResult stored_result(const std::string& file, Json content, const Overrides& overrides) {
  StoredResult stored;
  stored.file = file;
  stored.json = std::move(content);
  Json& json = stored.json;
  try {
    if (!json.is_object() || !json.contains("altiplan") || json.at("altiplan") != kFileFormat) {
      throw Error(file + ": expected a result of format 1");
    }
    expect_shape(json, file);
    take_files_along(json, file);
    stored.overrides = stored_overrides(json, overrides);
    stored.pipeline = json.at("pipeline").get<std::string>();
    for (const Json& used : json.at("files")) {
      const std::string path = used.at("path").get<std::string>();
      const std::string sum = is_there(path) ? sha256_of_present(path) : "";
      if (sum != used.at("sha256")) {
        stored.changed.push_back(path);
      }
    }
    if (!json.at("route").is_null()) {
      stored.route = route_of(json, file);
      stored.stops = stops_of(json, file);
    }
    if (!json.at("flight").is_null()) {
      const Json& flight = json.at("flight");
      stored.track = track_of(flight.at("track"), file);
      stored.telemetry = flight.contains("link") && !flight.at("link").is_null();
    }
  } catch (const Json::exception& error) {
    const std::string why = error.what();  // "[json.exception.type_error.302] type must be …"
    throw Error(file + ": expected a result of altiplan run: " + why.substr(why.find("] ") + 2));
  }
  return stored;
}

void take_open_ends(const Mission& mission, const Route& route, Request& request) {
  if (!mission.task) {
    return;
  }
  if (!mission.ends.start) {
    request.start.position = route.front();
  }
  if (!mission.ends.goal) {
    request.goal.position = route.back();
  }
}
}  // namespace altiplan::host
