// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>

#include "altiplan/error.hpp"
#include "altiplan/formats/mission_file.hpp"

/// \file Common parts of the readers of mission files.
namespace pugi {
class xml_node;
}

namespace altiplan::formats {

// Each reads one format. The first two throw messages without the file's name.
MissionFile read_qgc_plan(const nlohmann::json& json);
MissionFile read_geojson_route(const nlohmann::json& json);
MissionFile read_waypoints(const std::string& file, const std::string& text);
MissionFile read_kml_or_gpx(const std::string& file, const std::string& text);
MissionFile read_kml(const pugi::xml_node& root, const std::string& file, const std::string& text);
MissionFile read_gpx(const pugi::xml_node& root, const std::string& file, const std::string& text);

/// Throws Error if the position is not on the Earth; the message suspects swapped axes where they
/// fit.
void expect_position(double lon, double lat);
/// Throws Error if the height is not finite or beyond 100 km.
void expect_altitude(double altitude_m);
/// True for 0, 0, which ground stations write where they know no place, and for no numbers.
bool is_nowhere(double lon, double lat);
/// The altitude frame of a global MAV_FRAME number; throws Error for others.
AltitudeFrame frame_of(int mav_frame);
/// Drops repeated points; throws Error for an invalid polygon.
void check_volume(ZoneVolume& volume);

/// Mission commands in the numbering of the autopilots, one after the other.
class CommandList {
 public:
  explicit CommandList(MissionFile& mission) : mission_(mission) {}
  /// Adds the item of the command, if it is a position to fly to. Throws Error for an invalid
  /// position.
  void add(const MissionCommand& command);
  void skip_complex(const std::string& place);
  void take_complex(std::size_t items) { taken_ += items; }
  /// Adds the notes on skipped commands.
  void finish();

 private:
  MissionPoint place_of(const MissionCommand& command) const;

  MissionFile& mission_;
  std::size_t moves_ = 0;
  std::set<int> moves_numbers_;
  std::size_t skipped_ = 0;
  std::set<int> skipped_numbers_;
  std::size_t complex_ = 0;
  std::size_t taken_ = 0;
};
}  // namespace altiplan::formats
