// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "xml_parts.hpp"

namespace altiplan::formats {
namespace {

/// GPX: the points of one route or one track, heights above sea level.
class GpxReader {
 public:
  explicit GpxReader(MissionFile& mission) : mission_(mission) {}

  bool take(const pugi::xml_node& node) {
    const std::string_view name = local_name(node);
    routes_ += name == "rte";
    tracks_ += name == "trk";
    if (name != "rtept" && name != "trkpt") {
      return false;
    }
    std::vector<MissionItem>& items = name == "rtept" ? route_ : track_;
    const double lat = number_of(node.attribute("lat").value());
    const double lon = number_of(node.attribute("lon").value());
    expect_position(lon, lat);
    const std::string_view height = text_of(node, "ele");
    without_height_ |= height.empty();
    const double altitude = height.empty() ? 0 : number_of(height);
    expect_altitude(altitude);
    items.push_back({MissionItem::Kind::waypoint,
                     {lon, lat, altitude, AltitudeFrame::sea},
                     0,
                     "point " + std::to_string(items.size() + 1)});
    return true;
  }

  void finish() {
    if (routes_ > 1 || (routes_ == 0 && tracks_ > 1)) {
      mission_.route_problem = "expected one rte or trk as the route, found " +
                               std::to_string(routes_ > 1 ? routes_ : tracks_);
    } else if (without_height_) {
      mission_.route_problem = "a route needs heights: an ele in each point";
      mission_.lacks_heights = true;
    }
    mission_.items = routes_ > 0 ? std::move(route_) : std::move(track_);
  }

 private:
  MissionFile& mission_;
  std::vector<MissionItem> route_;
  std::vector<MissionItem> track_;
  std::size_t routes_ = 0;
  std::size_t tracks_ = 0;
  bool without_height_ = false;
};
}  // namespace

MissionFile read_gpx(const pugi::xml_node& root, const std::string& file, const std::string& text) {
  MissionFile mission;
  mission.format = MissionFile::Format::gpx;
  read_elements<GpxReader>(mission, root, file, text);
  return mission;
}
}  // namespace altiplan::formats
