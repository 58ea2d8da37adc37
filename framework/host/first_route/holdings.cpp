// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "host/base/words.hpp"
#include "host/first_route/file_info.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::host {
namespace {

using Datum = formats::ZoneLimit::Datum;

std::string joined(const std::map<std::string, std::size_t>& counts) {
  std::string text;
  for (const auto& [what, count] : counts) {
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  }
  return text;
}

std::string words(const formats::ZoneLimit& limit) {
  switch (limit.datum) {
    case Datum::ground:
      return "above ground";
    case Datum::sea:
      return "above sea level";
    case Datum::standard:
      return "as flight levels";
    default:
      return "unlimited";
  }
}

/// Longitudes and latitudes met so far.
class Extent {
 public:
  void add(double lon, double lat) {
    box_ = box_.with({box_.is_empty() ? lon : longitude_near(lon, box_.min.x()), lat, 0});
  }
  void add(const std::vector<formats::Zone>& zones) {
    for (const formats::Point2& p : formats::corners_of(zones)) {
      add(p[0], p[1]);
    }
  }
  std::string text() const {
    const auto range = [](double low, double high) {
      return with_digits(low, 7) + " to " + with_digits(high, 7);
    };
    return "longitude " + range(box_.min.x(), box_.max.x()) + ", latitude " +
           range(box_.min.y(), box_.max.y());
  }
  bool is_empty() const { return box_.is_empty(); }

 private:
  Box box_ = Box::empty();
};

const char* word(formats::MissionItem::Kind kind) {
  static constexpr const char* kWords[] = {"take-offs", "waypoints", "loiters", "landings"};
  return kWords[int(kind)];
}

const char* word(formats::AltitudeFrame frame) {
  return frame == formats::AltitudeFrame::sea      ? "above sea level"
         : frame == formats::AltitudeFrame::ground ? "above ground"
                                                   : "above home";
}

/// "heights 50 to 80 m above home"
std::vector<std::string> heights_of(const formats::MissionFile& mission) {
  std::map<std::string, std::pair<double, double>> ranges;
  for (const formats::MissionItem& item : mission.items) {
    const double z = item.at.altitude_m;
    const auto [found, is_new] = ranges.try_emplace(word(item.at.frame), z, z);
    found->second = {std::min(found->second.first, z), std::max(found->second.second, z)};
  }
  std::vector<std::string> texts;
  for (const auto& [frame, range] : ranges) {
    texts.push_back("heights " + with_digits(range.first, 6) + " to " +
                    with_digits(range.second, 6) + " m " + frame);
  }
  return texts;
}

void add_fence(const formats::MissionFile& mission, Extent& extent, FileInfo& info) {
  std::size_t keep_in = 0;
  for (const formats::Zone& zone : mission.zones) {
    keep_in += zone.keeps_in();
  }
  extent.add(mission.zones);
  if (!mission.zones.empty()) {
    info.facts.push_back("fence: " + counted(keep_in, "keep-in zone") + ", " +
                         counted(mission.zones.size() - keep_in, "keep-out zone"));
  }
  if (!mission.rally.empty()) {
    info.facts.push_back(counted(mission.rally.size(), "rally point"));
  }
}
}  // namespace

std::vector<std::string> facts_of(const formats::Airspace& airspace) {
  std::map<std::string, std::size_t> lower;
  std::map<std::string, std::size_t> upper;
  std::size_t with_hours = 0;
  std::size_t with_period = 0;
  Extent extent;
  extent.add(airspace.zones);
  for (const formats::Zone& zone : airspace.zones) {
    for (const formats::ZoneVolume& volume : zone.volumes) {
      ++lower[words(volume.lower)];
      ++upper[words(volume.upper)];
    }
    const auto has = [&](auto what) {
      return std::any_of(zone.periods.begin(), zone.periods.end(), what);
    };
    with_hours += has([](const auto& period) { return !period.hours.empty(); });
    with_period +=
        has([](const auto& p) { return std::isfinite(p.from) || std::isfinite(p.until); });
  }
  std::vector<std::string> facts{
      "lower limits: " + joined(lower) + "; upper limits: " + joined(upper),
      std::to_string(with_hours) + " zones with hours, " + std::to_string(with_period) +
          " with a first or last day"};
  if (!extent.is_empty()) {
    facts.push_back(extent.text());
  }
  return facts;
}

FileInfo info_of(const formats::MissionFile& mission, const std::string& file) {
  FileInfo info;
  info.kind = mission.items.empty() && !mission.zones.empty() ? "fence" : "mission";
  std::map<std::string, std::size_t> kinds;
  Extent extent;
  for (const formats::MissionItem& item : mission.items) {
    ++kinds[word(item.kind)];
    extent.add(item.at.lon, item.at.lat);
  }
  info.facts.push_back(counted(mission.items.size(), "item") +
                       (kinds.empty() ? "" : ": " + joined(kinds)));
  if (!mission.lacks_heights) {
    const std::vector<std::string> heights = heights_of(mission);
    info.facts.insert(info.facts.end(), heights.begin(), heights.end());
  }
  if (mission.home) {
    info.facts.push_back("home at longitude " + with_digits(mission.home->lon, 9) + ", latitude " +
                         with_digits(mission.home->lat, 9) + ", " +
                         with_digits(mission.home->altitude_m, 6) + " m above sea level");
  }
  add_fence(mission, extent, info);
  if (!extent.is_empty()) {
    info.facts.push_back(extent.text());
  }
  if (!mission.route_problem.empty()) {
    info.facts.push_back((mission.items.empty() ? "no route: " : "its items are not a route: ") +
                         mission.route_problem);
  } else if (mission.items.empty() && mission.zones.empty() && mission.rally.empty()) {
    info.facts.emplace_back("no route: it holds no position to fly to");
  }
  info.facts.insert(info.facts.end(), mission.notes.begin(), mission.notes.end());
  if (mission.format == formats::MissionFile::Format::other) {
    return info;  // which scenarios do not read
  }
  const std::string name = exact_json_text(file);
  if (!mission.zones.empty()) {
    info.scenario.insert(info.scenario.end(), {"environment:", "  - zones: {file: " + name + "}"});
  }
  if (!mission.items.empty() && mission.route_problem.empty()) {
    info.scenario.push_back("mission: " + name);
  }
  return info;
}
}  // namespace altiplan::host
