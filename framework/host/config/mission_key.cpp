// SPDX-License-Identifier: Apache-2.0
#include "host/config/mission_key.hpp"

#include <algorithm>
#include <charconv>

#include "altiplan/error.hpp"
#include "altiplan/formats/mission_file.hpp"
#include "altiplan/params.hpp"
#include "host/base/machine_fault.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;
namespace {

using formats::AltitudeFrame;
using formats::MissionItem;
using formats::MissionPoint;

struct Named {
  Path file;
  void describe(Fields& f) { f("mission", file); }
};

Value number(double value, const Location& where) {
  char text[32];
  Value node;
  node.text.assign(text, std::to_chars(text, text + sizeof text, value).ptr);
  node.where = where;
  return node;
}

void add(Value& map, const char* key, Value value) {
  const Location where = value.where;
  map.entries.push_back({key, where, std::move(value)});
}

/// Converts an item to a point of a scenario.
class Writer {
 public:
  Writer(const formats::MissionFile& mission, std::string file)
      : mission_(mission), file_(std::move(file)) {}

  Value point(const MissionItem& item) const {
    Value map;
    map.kind = Value::Kind::map;
    map.where = where(item);
    add_place(map, item);
    return map;
  }

  void add_place(Value& map, const MissionItem& item) const {
    const Location from = where(item);
    Value place;
    place.kind = Value::Kind::list;
    place.where = from;
    place.items = {number(item.at.lon, from), number(item.at.lat, from)};
    const bool above_ground = item.at.frame == AltitudeFrame::ground;
    if (!above_ground) {
      place.items.push_back(number(height(item), from));
    }
    add(map, "at_lonlat", std::move(place));
    if (above_ground) {
      add(map, "above_ground_m", number(item.at.altitude_m, from));
    }
  }

  Location where(const MissionItem& item) const {
    return Location{file_, 0, 0, file_ + ": " + item.place};
  }

 private:
  double height(const MissionItem& item) const {
    if (item.at.frame == AltitudeFrame::sea) {
      return item.at.altitude_m;
    }
    if (!mission_.home) {
      throw Error(file_ + ": " + item.place +
                  ": its altitude is relative to home, and the file has no home position");
    }
    return mission_.home->altitude_m + item.at.altitude_m;
  }

  const formats::MissionFile& mission_;
  std::string file_;
};

/// True if both are within 2 cm horizontally, the rounding of degrees to seven decimals.
bool same_place(const MissionPoint& a, const MissionPoint& b) {
  constexpr double kDegrees = 2e-7;
  return std::abs(a.lon - b.lon) <= kDegrees && std::abs(a.lat - b.lat) <= kDegrees;
}

bool has_place(const Value& map) {
  return map.kind != Value::Kind::map ||
         std::any_of(map.entries.begin(), map.entries.end(), [](const Value::Entry& entry) {
           return entry.key == "at_m" || entry.key == "at_lonlat" || entry.key == "at_cell" ||
                  entry.key == "above_ground_m";
         });
}

void add_points(Value& scenario, const formats::MissionFile& mission, const std::string& file) {
  const std::vector<MissionItem> items = route_items(mission);
  if (items.size() < 2) {
    throw Error(file + ": expected at least two points, found " + std::to_string(items.size()));
  }
  const Writer writer(mission, file);
  if (scenario.find("start") == nullptr) {
    add(scenario, "start", writer.point(items.front()));
  }
  if (Value* goal = scenario.find("goal"); goal == nullptr) {
    add(scenario, "goal", writer.point(items.back()));
  } else if (!has_place(*goal)) {
    writer.add_place(*goal, items.back());
  }
  if (scenario.find("via") == nullptr && items.size() > 2) {
    Value via;
    via.kind = Value::Kind::list;
    via.where = writer.where(items[1]);
    for (std::size_t n = 1; n + 1 < items.size(); ++n) {
      Value point = writer.point(items[n]);
      if (items[n].acceptance_m > 0) {
        add(point, "tolerance_m", number(items[n].acceptance_m, point.where));
      }
      via.items.push_back(std::move(point));
    }
    add(scenario, "via", std::move(via));
  }
}
}  // namespace

std::vector<MissionItem> route_items(const formats::MissionFile& mission) {
  if (!mission.route_problem.empty()) {
    throw Error(mission.route_problem);
  }
  if (mission.items.empty()) {
    throw Error("it contains no route" +
                std::string(mission.zones.empty() ? "" : ": it contains only zones"));
  }
  std::vector<MissionItem> items = mission.items;
  if (items.size() > 1 && items.back().kind == MissionItem::Kind::land &&
      same_place(items.back().at, items[items.size() - 2].at)) {
    items.pop_back();
  }
  return items;
}

std::vector<std::string> add_mission(Value& scenario, std::vector<fs::path>& files) {
  const Value* written = scenario.find("mission");
  if (written == nullptr) {
    return {};
  }
  std::vector<std::string> notes;
  Value alone;
  alone.kind = Value::Kind::map;
  alone.where = scenario.where;
  alone.entries = {{"mission", written->where, *written}};
  Named named;
  if (const ParamReport report = bind(named, &alone); !report.problems.empty()) {
    throw ConfigError(report.problems);
  }
  const std::string& file = named.file.text;
  const Location where = written->where;
  if (!is_there(file)) {
    throw ConfigError(where, "mission", "file not found: '" + file + "'");
  }
  try {
    const formats::MissionFile mission = formats::read_mission(file);
    for (const std::string& note : mission.notes) {
      notes.push_back("mission: " + note);
    }
    try {
      add_points(scenario, mission, file);
    } catch (const Error& error) {
      const std::string message = error.what();
      throw Error(message.starts_with(file) ? message : file + ": " + message);
    }
  } catch (const Error& error) {
    throw ConfigError(where, "mission", error.what());
  }
  files.emplace_back(file);
  return notes;
}
}  // namespace altiplan::host
