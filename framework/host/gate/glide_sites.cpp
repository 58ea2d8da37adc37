// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "altiplan/error.hpp"
#include "altiplan/formats/geojson.hpp"
#include "altiplan/formats/input_file.hpp"
#include "host/gate/glide.hpp"

namespace altiplan::host {
namespace {

using formats::Point2;
using formats::Polygon;
using formats::Ring;

/// Longitudes at which the rings cross a latitude, ascending: the polygon lies between the first
/// and the second, the third and the fourth, …
std::vector<double> crossings(const Polygon& polygon, double lat) {
  std::vector<double> lons;
  const auto add = [&](const Ring& ring) {
    for (std::size_t n = 0; n < ring.size(); ++n) {
      const Point2& a = ring[n];
      const Point2& b = ring[(n + 1) % ring.size()];
      if ((a[1] > lat) != (b[1] > lat)) {
        lons.push_back(a[0] + (lat - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
      }
    }
  };
  add(polygon.outline);
  std::for_each(polygon.holes.begin(), polygon.holes.end(), add);
  std::sort(lons.begin(), lons.end());
  return lons;
}

/// On five lines from west to east, three on each piece of a line.
std::vector<Point2> points_in(const Polygon& polygon) {
  const auto [south, north] =
      std::minmax_element(polygon.outline.begin(), polygon.outline.end(),
                          [](const Point2& a, const Point2& b) { return a[1] < b[1]; });
  std::vector<Point2> points;
  for (const double share : {0.5, 0.3, 0.7, 0.1, 0.9}) {
    const double lat = (*south)[1] + share * ((*north)[1] - (*south)[1]);
    const std::vector<double> lons = crossings(polygon, lat);
    for (std::size_t n = 0; n + 1 < lons.size(); n += 2) {
      for (const double along : {0.5, 0.2, 0.8}) {
        points.push_back({lons[n] + along * (lons[n + 1] - lons[n]), lat});
      }
    }
  }
  return points;
}

class SiteReader {
 public:
  explicit SiteReader(std::string file) : file_(std::move(file)) {}

  void add_area(const std::string& name, const Polygon& polygon, const std::string& problem,
                formats::Restriction restriction) {
    if (!problem.empty()) {
      refuse("'" + name + "', " + problem);
    }
    if (restriction != formats::Restriction::unspecified) {
      refuse("the zone '" + name + "'");
    }
    sites_.push_back({named(name), points_in(polygon)});
  }
  void add_points(const std::vector<formats::NamedPoint>& points) {
    for (const formats::NamedPoint& point : points) {
      sites_.push_back({named(point.name), {point.at}});
    }
  }
  [[noreturn]] void refuse(const std::string& found) const {
    throw Error(file_ + ": expected points or areas where an aeroplane may come down (GeoJSON, " +
                "KML), found " + found);
  }
  std::vector<GlideSite> sites() {
    if (sites_.empty()) {
      refuse("none");
    }
    return std::move(sites_);
  }

 private:
  std::string named(const std::string& name) const {
    return name.empty() ? "site " + std::to_string(sites_.size() + 1) : name;
  }

  std::string file_;
  std::vector<GlideSite> sites_;
};
}  // namespace

std::vector<GlideSite> read_glide_sites(const std::string& file) {
  SiteReader reader(file);
  const std::string text = formats::read_file(file);
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  std::vector<std::string> flat;
  if (first != text.npos && text[first] == '{') {
    const formats::GeoJson json = formats::read_geojson(file);
    for (const formats::GeoFeature& feature : json.features) {
      reader.add_area(feature.id, feature.polygon, feature.problem, role_of(feature));
    }
    reader.add_points(json.points);
    flat = json.flat;
  } else {
    const formats::MissionFile map = formats::read_mission(file, text);
    if (map.format != formats::MissionFile::Format::kml) {
      reader.refuse("a mission");
    }
    for (const formats::Zone& zone : map.zones) {
      reader.add_area(zone.name, zone.volumes.front().polygon, zone.problem, zone.restriction);
    }
    reader.add_points(map.points);
    flat = map.flat;
  }
  if (!flat.empty()) {
    reader.refuse("polygons without an area, " + formats::names_text(flat));
  }
  return reader.sites();
}
}  // namespace altiplan::host
