// SPDX-License-Identifier: Apache-2.0
// track_in_band MISSION copter|plane|vtol PARAMETERS|- RUNWAY|- TERRAIN|- TRACK [WIND [RADIUS]]:
// which share of a track that ArduPilot flew lies in the band that is predicted for the mission.
// TRACK has lines "longitude,latitude,altitude,item" (degrees, metres above sea level), RUNWAY is
// the heading of an aeroplane's take-off, WIND the strongest one in m/s. With RADIUS (metres) the
// track is that of a failsafe's return, from within so much of its first place, and "joins" tells
// at which items it may join the mission. Prints a line of JSON: the lengths flown and outside, of
// the whole track and of each item, and the place that is farthest outside.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>

#include "altiplan/error.hpp"
#include "altiplan/formats/mission_file.hpp"
#include "host/autopilot/failsafe_return.hpp"
#include "host/mission/mission.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::host {
namespace {

constexpr double kStep = 1;  // metres between places that are looked at

/// How far a place lies outside of a strip, metres; negative inside.
double outside_of(const Strip& strip, const Vec3& place) {
  const Eigen::Vector2d along = (strip.to - strip.from).head<2>();
  const Eigen::Vector2d off = (place - strip.from).head<2>();
  const double square = along.squaredNorm();
  const double share = square > 0 ? std::clamp(off.dot(along) / square, 0.0, 1.0) : 0;
  const bool is_column = square == 0;  // between its ends, whatever their order
  const double low = is_column ? std::min(strip.from.z(), strip.to.z())
                               : strip.from.z() + share * (strip.to.z() - strip.from.z());
  const double high = is_column ? std::max(strip.from_high_m, strip.to_high_m)
                                : strip.from_high_m + share * (strip.to_high_m - strip.from_high_m);
  const double above = std::max({low - place.z(), place.z() - high, 0.0});
  return std::hypot((off - share * along).norm(), above) - strip.reach_m;
}

/// The band of a flight.
class Band {
 public:
  explicit Band(const FlownMission& flown) {
    for (const FlownPart& part : flown.parts) {
      for (const Strip& strip : part.strips) {
        strips_.push_back(&strip);
        parts_.push_back(&part);
      }
    }
  }

  struct Found {
    double outside_m = kInfinity;
    const FlownPart* part = nullptr;
  };
  /// The nearest strip, or one that contains the place.
  Found nearest(const Vec3& place) {
    Found found;
    for (std::size_t n = 0; n < strips_.size() && found.outside_m > 0; ++n) {
      const std::size_t i = (last_ + n) % strips_.size();  // the next place is mostly in the same
      const double outside = outside_of(*strips_[i], place);
      if (outside < found.outside_m) {
        found = {outside, parts_[i]};
        last_ = outside <= 0 ? i : last_;
      }
    }
    return found;
  }

 private:
  std::vector<const Strip*> strips_;
  std::vector<const FlownPart*> parts_;
  std::size_t last_ = 0;
};

struct Sample {
  Vec3 at{0, 0, 0};
  int item = 0;
};

std::vector<Sample> read_track(const std::string& file, const Frame& frame) {
  std::ifstream lines(file);
  std::vector<Sample> track;
  std::string line;
  while (std::getline(lines, line)) {
    double lon = 0;
    double lat = 0;
    double altitude = 0;
    int item = 0;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%d", &lon, &lat, &altitude, &item) != 4) {
      throw Error(file + ": expected longitude, latitude, altitude and item, found '" + line + "'");
    }
    const auto [x, y] = frame.to_local(lon, lat);
    track.push_back({{x, y, altitude}, item});
  }
  return track;
}

World world_of(const std::string& terrain, const formats::MissionPoint& home) {
  if (terrain == "-") {
    return World().with_frame(Frame::geographic(home.lon, home.lat, home.lat));
  }
  const std::string at =
      "[" + exact_json_text(home.lon) + ", " + exact_json_text(home.lat) + ", 0]";
  const std::string file = std::filesystem::absolute(terrain).string();
  return build_mission(
             load_scenario_text(
                 "altiplan: 1\nenvironment:\n  - terrain: {file: " + exact_json_text(file) +
                     ", voids: fill_m, fill_m: 10000}\n"
                     "volume: {min_m: [-1e8, -1e8, -1e4], max_m: [1e8, 1e8, 1e5]}\n"
                     "vehicle: {radius_m: 1}\nstart: {at_lonlat: " +
                     at + "}\ngoal: {at_lonlat: " + at + "}\n",
                 "the world of the track", {}),
             1)
      .truth;
}

Json compare(const formats::MissionFile& plan, const FlownMission& flown, const World& world,
             const std::vector<Sample>& track) {
  struct Lengths {
    double flown_m = 0;
    double outside_m = 0;
    double farthest_m = 0;
  };
  Band band(flown);
  Lengths all;
  std::map<int, Lengths> by_item;
  Json worst;
  for (std::size_t n = 1; n < track.size(); ++n) {
    const Vec3 way = track[n].at - track[n - 1].at;
    const int steps = std::max(1, int(std::ceil(way.norm() / kStep)));
    Lengths& here = by_item[track[n].item];
    for (int step = 1; step <= steps; ++step) {
      const Vec3 place = track[n - 1].at + way * (double(step) / steps);
      const double length = way.norm() / steps;
      const Band::Found found = band.nearest(place);
      for (Lengths* lengths : {&all, &here}) {
        lengths->flown_m += length;
        lengths->outside_m += found.outside_m > 0 ? length : 0;
        lengths->farthest_m = std::max(lengths->farthest_m, found.outside_m);
      }
      if (found.part != nullptr && found.outside_m > 0 && found.outside_m == all.farthest_m) {
        const auto [lon, lat] = world.frame().to_lonlat(place.x(), place.y());
        worst = {{"outside_m", found.outside_m},
                 {"lonlat", {lon, lat}},
                 {"local_m", {place.x(), place.y(), place.z()}},
                 {"flown_to", track[n].item},
                 {"nearest_item", name_of_command(plan.commands[found.part->command])},
                 {"nearest_part", found.part->what}};
      }
    }
  }
  Json items = Json::array();
  for (const auto& [item, lengths] : by_item) {
    if (lengths.outside_m > 0) {
      items.push_back({{"item", item},
                       {"flown_m", lengths.flown_m},
                       {"outside_m", lengths.outside_m},
                       {"farthest_m", lengths.farthest_m}});
    }
  }
  Json remarks = Json::array();
  for (const Remark& remark : flown.remarks) {
    if (remark.weight != Remark::Weight::note) {
      remarks.push_back(remark.rule + " at " + name_of_command(plan.commands[remark.command]));
    }
  }
  return {{"flown_m", all.flown_m},
          {"outside_m", all.outside_m},
          {"items", items},
          {"worst", worst},
          {"remarks", remarks}};
}

int run(const std::vector<std::string>& words) {
  if (words.size() < 6 || words.size() > 8) {
    throw Error(
        "expected MISSION copter|plane|vtol PARAMETERS|- RUNWAY|- TERRAIN|- TRACK [WIND [RADIUS]]");
  }
  const formats::MissionFile plan = formats::read_mission(words[0]);
  if (!plan.home || plan.commands.empty()) {
    throw Error(words[0] + ": expected a home and commands");
  }
  const formats::Airframe airframe = words[1] == "copter"  ? formats::Airframe::copter
                                     : words[1] == "plane" ? formats::Airframe::plane
                                                           : formats::Airframe::vtol;
  FlightOptions options;
  if (words[2] != "-") {
    options.parameters = read_parameters(words[2]);
  }
  if (words[3] != "-") {
    options.runway_deg = std::stod(words[3]);
  }
  options.wind_mps = words.size() > 6 ? std::stod(words[6]) : 0;
  const World world = world_of(words[4], *plan.home);
  const formats::Autopilot autopilot{formats::Firmware::ardupilot, airframe};
  const std::vector<Sample> track = read_track(words[5], world.frame());
  if (words.size() == 8) {
    const FailsafeReturns returns(plan, autopilot, world, options);
    const double radius = std::stod(words[7]);
    const Sample& begin = track.at(0);
    std::size_t command = 0;
    while (command + 1 < plan.commands.size() && plan.commands[command].item < begin.item) {
      ++command;
    }
    FlownMission flown = returns.from(
        command, {begin.at.head<2>(), radius, begin.at.z() - radius, begin.at.z() + radius});
    // Until it has stopped or turned it is where the mission may be.
    std::copy_if(returns.mission().parts.begin(), returns.mission().parts.end(),
                 std::back_inserter(flown.parts),
                 [&](const FlownPart& part) { return part.command == command; });
    Json json = compare(plan, flown, world, track);
    json["joins"] = Json::array();
    for (const FlownPart& part : flown.parts) {
      if (part.what == "the way back to the mission") {
        json["joins"].push_back(plan.commands[part.command].item);
      }
    }
    std::cout << json.dump() << "\n";
    return 0;
  }
  const FlownMission flown = fly_mission(plan, autopilot, world, options);
  std::cout << compare(plan, flown, world, track).dump() << "\n";
  return 0;
}
}  // namespace
}  // namespace altiplan::host

int main(int count, char** words) {
  try {
    return altiplan::host::run({words + 1, words + count});
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
}
