// SPDX-License-Identifier: Apache-2.0
#include "host/gate/changed_plan.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>

#include "altiplan/error.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::host {
namespace {

constexpr double kDegrees = 1e7;  // a centimetre, as autopilots store them
constexpr double kMetres = 1e3;

double of_degrees(double value) { return std::round(value * kDegrees) / kDegrees; }
double of_metres(double value) { return std::round(value * kMetres) / kMetres; }

/// "mission.items.3" as a JSON pointer.
Json::json_pointer pointer_of(std::string place) {
  for (char& letter : place) {
    letter = letter == '.' ? '/' : letter;
  }
  return Json::json_pointer("/" + place);
}

void raise(Json& number, double by) {
  if (number.is_number() && by != 0) {
    number = of_metres(number.get<double>() + by);
  }
}

std::string changed_json(const std::string& text, const std::vector<ChangedItem>& changes) {
  Json plan = parse_json(text);
  for (const ChangedItem& change : changes) {
    Json& item = plan.at(pointer_of(change.place));
    const bool old_form = item.contains("coordinate");
    Json& place = old_form ? item.at("coordinate") : item.at("params");
    const std::size_t first = old_form ? 0 : 4;
    if (change.lonlat) {
      place.at(first) = of_degrees(change.lonlat->at(1));
      place.at(first + 1) = of_degrees(change.lonlat->at(0));
    }
    raise(place.at(first + 2), change.raised_by_m);
    for (const char* key : {"Altitude", "AMSLAltAboveTerrain"}) {  // the ground station's own
      if (item.contains(key)) {
        raise(item.at(key), change.raised_by_m);
      }
    }
  }
  return plan.dump(4) + "\n";
}

std::string number(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

/// Columns 9 to 11 of a line, latitude, longitude and altitude, replaced.
std::string changed_line(const std::string& line, const ChangedItem& change) {
  std::string result;
  std::size_t at = 0;
  for (int column = 0; at < line.size(); ++column) {
    const std::size_t begin = std::min(line.find_first_not_of(" \t\r", at), line.size());
    const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
    const std::string word = line.substr(begin, end - begin);
    double altitude = 0;
    std::from_chars(word.data(), word.data() + word.size(), altitude);
    result += line.substr(at, begin - at);
    const bool is_moved = change.lonlat && (column == 8 || column == 9);
    const bool is_raised = column == 10 && change.raised_by_m != 0;
    result += is_moved    ? number(change.lonlat->at(column == 8 ? 1 : 0), 7)
              : is_raised ? number(altitude + change.raised_by_m, 3)
                          : word;
    at = end;
  }
  return result;
}

std::string changed_lines(const std::string& text, const std::vector<ChangedItem>& changes) {
  std::string result;
  std::size_t at = 0;
  for (int n = 1; at < text.size(); ++n) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string line = text.substr(at, end - at);
    for (const ChangedItem& change : changes) {
      if (change.place == "line " + std::to_string(n)) {
        line = changed_line(line, change);
      }
    }
    result += line + (end < text.size() ? "\n" : "");
    at = end + 1;
  }
  return result;
}
}  // namespace

std::string changed_plan(const std::string& text, formats::MissionFile::Format format,
                         const std::vector<ChangedItem>& changes) {
  switch (format) {
    case formats::MissionFile::Format::qgc_plan:
      return changed_json(text, changes);
    case formats::MissionFile::Format::waypoints:
      return changed_lines(text, changes);
    default:
      throw Error("expected a .plan or .waypoints file: in other formats no item can be changed");
  }
}

std::string with_rally_points(const std::string& text,
                              const std::vector<formats::MissionPoint>& points) {
  Json plan = parse_json(text);
  Json& rally = plan["rallyPoints"];
  rally["version"] = 2;
  rally["points"] = Json::array();
  for (const formats::MissionPoint& point : points) {
    rally["points"].push_back({point.lat, point.lon, point.altitude_m});
  }
  return plan.dump(4) + "\n";
}
}  // namespace altiplan::host
