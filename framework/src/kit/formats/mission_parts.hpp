// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>

#include "altiplan/error.hpp"
#include "altiplan/kit/formats/mission_file.hpp"

/// \file What the readers of mission files share.
namespace pugi {
class xml_node;
}

namespace altiplan::kit {

// Each reads one format. The first two throw messages without the file's name.
MissionFile read_qgc_plan(const nlohmann::json& json);
MissionFile read_geojson_route(const nlohmann::json& json);
MissionFile read_waypoints(const std::string& file, const std::string& text);
MissionFile read_kml_or_gpx(const std::string& file, const std::string& text);
MissionFile read_kml(const pugi::xml_node& root, const std::string& file, const std::string& text);
MissionFile read_gpx(const pugi::xml_node& root, const std::string& file, const std::string& text);

/// Throws Error where the place is not on the Earth; swapped axes are named where they show.
void expect_position(double lon, double lat);
/// Throws Error where the height is not finite or beyond 100 km.
void expect_altitude(double altitude_m);
/// The frame of a MAV_FRAME number that gives a place on the Earth; throws Error for others.
AltitudeFrame frame_of(int mav_frame);
/// Repeated points dropped; throws Error for a polygon that is none.
void check_zone(MissionZone& zone);

/// Mission commands as the autopilots count them, one after the other.
class CommandList {
 public:
  struct Command {
    int number = 0;
    int frame = 0;
    double acceptance_m = 0;
    double lon = 0;  ///< both 0, or not finite: at the place where the vehicle is then
    double lat = 0;
    double altitude_m = 0;
    std::string place;
  };

  explicit CommandList(MissionFile& mission) : mission_(mission) {}
  /// Adds the item that the command stands for, if it is a place to fly to. Throws Error for a
  /// place that is none.
  void add(const Command& command);
  void skip_complex() { ++complex_; }
  void take_complex(std::size_t items) { taken_ += items; }
  /// Notes what was left out.
  void finish();

 private:
  MissionPoint place_of(const Command& command, MissionItem::Kind kind) const;

  MissionFile& mission_;
  std::size_t skipped_ = 0;
  std::set<int> skipped_numbers_;
  std::size_t complex_ = 0;
  std::size_t taken_ = 0;
};
}  // namespace altiplan::kit
