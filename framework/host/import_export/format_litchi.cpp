// SPDX-License-Identifier: Apache-2.0
// Litchi's CSV, as https://www.litchiutilities.com/docs/litchiCsv.php describes it.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "altiplan/earth.hpp"
#include "altiplan/error.hpp"
#include "host/base/words.hpp"
#include "host/import_export/format_functions.hpp"

namespace altiplan::host {
namespace {

using formats::MissionItem;

constexpr std::string_view kLitchiBegin = "latitude,longitude,altitude(";
constexpr double kLowest = -200;  // metres from the place of take-off
constexpr double kHighest = 500;
constexpr double kLongestLeg = 1999;
constexpr double kFastest = 15;
constexpr double kFootInMetres = 0.3048;
constexpr std::size_t kFlownAtOnce = 99;

std::string litchi_head() {
  std::string head =
      "latitude,longitude,altitude(m),heading(deg),curvesize(m),rotationdir,gimbalmode,"
      "gimbalpitchangle";
  for (int n = 1; n <= 15; ++n) {
    head += ",actiontype" + std::to_string(n) + ",actionparam" + std::to_string(n);
  }
  return head +
         ",altitudemode,speed(m/s),poi_latitude,poi_longitude,poi_altitude(m),poi_altitudemode,"
         "photo_timeinterval,photo_distinterval\n";
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  while (line.ends_with('\r')) {
    line.remove_suffix(1);
  }
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find(',', at), line.size());
    cells.push_back(line.substr(at, end - at));
    at = end + 1;
  }
  return cells;
}

double litchi_number(std::string_view cell, const char* what) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value)) {
    throw Error(std::string("expected ") + what + ", found " + excerpt(cell));
  }
  return value;
}

/// The column of that name.
std::size_t column(const std::vector<std::string_view>& head, std::string_view name) {
  const auto found = std::find(head.begin(), head.end(), name);
  if (found == head.end()) {
    throw Error("expected the column '" + std::string(name) + "' in the first line");
  }
  return std::size_t(found - head.begin());
}

MissionItem litchi_item(const std::vector<std::string_view>& head,
                        const std::vector<std::string_view>& cells, std::size_t line) {
  if (cells.size() != head.size()) {
    throw Error("expected " + std::to_string(head.size()) + " columns, found " +
                std::to_string(cells.size()));
  }
  const double lat = litchi_number(cells[column(head, "latitude")], "a latitude");
  const double lon = litchi_number(cells[column(head, "longitude")], "a longitude");
  if (std::abs(lat) > 90 || std::abs(lon) > 180) {
    throw Error("expected a latitude in [-90, 90] and a longitude in [-180, 180]");
  }
  const bool is_metric = std::find(head.begin(), head.end(), "altitude(m)") != head.end();
  const double height =
      litchi_number(cells[column(head, is_metric ? "altitude(m)" : "altitude(ft)")],
                    "an altitude") *
      (is_metric ? 1 : kFootInMetres);
  if (litchi_number(cells[column(head, "altitudemode")], "an altitudemode") != 0) {
    throw Error(
        "altitudes above the ground, by Litchi's own model, are not read: expected the "
        "altitudemode 0");
  }
  return {MissionItem::Kind::waypoint,
          {lon, lat, height, formats::AltitudeFrame::home},
          0,
          "line " + std::to_string(line)};
}

/// Whether a curve is flown depends on the path mode, which the file does not hold.
std::string curve_problem(const std::vector<std::string_view>& head,
                          const std::vector<std::string_view>& cells) {
  for (std::size_t n = 0; n < std::min(head.size(), cells.size()); ++n) {
    if (head[n].starts_with("curvesize(") && litchi_number(cells[n], "a curvesize") != 0) {
      return "how Litchi flies the curvesize " + excerpt(cells[n]) + " is not judged, only 0";
    }
  }
  return "";
}
}  // namespace

bool is_litchi(std::string_view text) { return text.starts_with(kLitchiBegin); }

std::string litchi_text(const MissionText& text) {
  std::string out = litchi_head();
  const std::vector<MissionItem>& items = text.mission.items;
  for (std::size_t n = 0; n < items.size(); ++n) {
    const formats::MissionPoint& at = items[n].at;
    const double next = items[std::min(n + 1, items.size() - 1)].speed_mps;
    const double speed = next > 0 ? next : text.speed_mps;
    out += rounded_text(at.lat, text.decimals.degrees) + "," +
           rounded_text(at.lon, text.decimals.degrees) + "," +
           rounded_text(at.altitude_m, text.decimals.metres) + ",0,0,0,0,0";
    for (int action = 0; action < 15; ++action) {
      out += ",-1,0";
    }
    out += ",0," + rounded_text(speed, text.decimals.metres) + ",0,0,0,0,-1,-1\n";
  }
  return out;
}

formats::MissionFile read_litchi(const std::string& file, const std::string& text) {
  formats::MissionFile mission;
  mission.format = formats::MissionFile::Format::other;
  std::vector<std::string_view> head;
  std::size_t line = 0;
  try {
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      const std::string_view content = std::string_view(text).substr(at, end - at);
      at = end + 1;
      ++line;
      if (content.empty() || content == "\r") {
        continue;
      }
      if (head.empty()) {
        head = split(content);
        continue;
      }
      const std::vector<std::string_view> cells = split(content);
      mission.items.push_back(litchi_item(head, cells, line));
      if (mission.route_problem.empty()) {
        mission.route_problem = curve_problem(head, cells);
      }
    }
  } catch (const Error& error) {
    throw Error(file + ":" + std::to_string(line) + ": " + error.what());
  }
  return mission;
}

std::vector<std::string> litchi_notes(const MissionText& text) {
  const std::vector<MissionItem>& items = text.mission.items;
  std::vector<std::string> notes{
      "heights count from where the aircraft takes off: take off at " +
          rounded_text(text.mission.home.value().altitude_m, 1) + " m above sea level",
      "set Path Mode to straight lines after the import: curved turns are not what was judged"};
  double low = kInfinity;
  double high = -kInfinity;
  double longest = 0;
  double fastest = text.speed_mps;
  for (std::size_t n = 0; n < items.size(); ++n) {
    low = std::min(low, items[n].at.altitude_m);
    high = std::max(high, items[n].at.altitude_m);
    fastest = std::max(fastest, items[n].speed_mps);
    if (n > 0) {
      const auto& before = items[n - 1].at;
      longest = std::max(
          longest,
          geodesic_course({before.lon, before.lat}, {items[n].at.lon, items[n].at.lat}).metres);
    }
  }
  if (low < kLowest || high > kHighest) {
    notes.push_back(
        "warning: Litchi flies between -200 and 500 m from the place of take-off, the "
        "route between " +
        rounded_text(low, 0) + " and " + rounded_text(high, 0) + " m");
  }
  if (longest > kLongestLeg) {
    notes.push_back("warning: Litchi flies legs of at most 1,999 m, the route one of " +
                    rounded_text(longest, 0) + " m");
  }
  if (fastest > kFastest) {
    notes.push_back("warning: Litchi flies at most 15 m/s, the route " + rounded_text(fastest, 1) +
                    " m/s");
  }
  if (items.size() > kFlownAtOnce) {
    notes.push_back("warning: " + counted(items.size(), "waypoint") +
                    ": Litchi uploads 99 at a time, and needs the link for it");
  }
  return notes;
}
}  // namespace altiplan::host
