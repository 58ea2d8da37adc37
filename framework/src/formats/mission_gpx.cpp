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
    places_ += name == "wpt";
    if (name == "trkseg" && !track_.empty()) {
      begins_ = track_.size();
    }
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
    if (begins_ && name == "trkpt") {
      const MissionPoint& before = track_[*begins_ - 1].at;
      is_apart_ |= before.lon != lon || before.lat != lat;
      begins_.reset();
    }
    items.push_back({MissionItem::Kind::waypoint,
                     {lon, lat, altitude, AltitudeFrame::sea},
                     0,
                     "point " + std::to_string(items.size() + 1)});
    return true;
  }

  void finish() {
    if (routes_ + tracks_ > 1) {
      mission_.route_problem =
          "expected one rte or trk as the route, found " + std::to_string(routes_ + tracks_);
    } else if (routes_ + tracks_ == 0 && places_ > 0) {
      mission_.route_problem = "expected a rte or trk as the route, found places (wpt) alone: " +
                               std::to_string(places_);
    } else if (is_apart_) {
      mission_.route_problem =
          "expected a trk of one piece as the route, found a trkseg that begins elsewhere than the "
          "one before it ends";
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
  std::size_t places_ = 0;
  bool without_height_ = false;
  bool is_apart_ = false;
  std::optional<std::size_t> begins_{};  ///< index of the first point of a further piece
};
}  // namespace

MissionFile read_gpx(const pugi::xml_node& root, const std::string& file, const std::string& text) {
  MissionFile mission;
  mission.format = MissionFile::Format::gpx;
  read_elements<GpxReader>(mission, root, file, text);
  return mission;
}
}  // namespace altiplan::formats
