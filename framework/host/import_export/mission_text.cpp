// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/mission_text.hpp"

#include <charconv>
#include <cmath>

#include "altiplan/frame.hpp"
#include "altiplan/geometry.hpp"

namespace altiplan::host {

double rounded(double value, int decimals) {
  const std::string text = rounded_text(value, decimals);
  double result = 0;
  std::from_chars(text.data(), text.data() + text.size(), result);
  return result;
}

const char* name(formats::AltitudeFrame frame) {
  switch (frame) {
    case formats::AltitudeFrame::sea:
      return "sea";
    case formats::AltitudeFrame::ground:
      return "ground";
    case formats::AltitudeFrame::home:
      break;
  }
  return "home";
}

formats::Polygon polygon_of(const formats::Zone& zone) {
  constexpr int kCorners = 64;
  const formats::ZoneVolume& circle = zone.volumes.front();
  if (!circle.polygon.outline.empty()) {
    return circle.polygon;
  }
  const double radius =
      zone.keeps_in() ? circle.radius_m : circle.radius_m / std::cos(kPi / kCorners);
  formats::Polygon polygon;
  for (int n = 0; n < kCorners; ++n) {
    const auto [lon, lat] = geodesic_end(circle.centre, -360.0 * n / kCorners, radius);
    polygon.outline.push_back({longitude_near(lon, 0), lat});
  }
  return polygon;
}

std::string mission_text(const MissionText& mission) {
  using Format = formats::MissionFile::Format;
  switch (mission.mission.format) {
    case Format::qgc_plan:
      return qgc_plan_text(mission);
    case Format::waypoints:
      return waypoints_text(mission);
    case Format::kml:
      return kml_text(mission);
    case Format::gpx:
      return gpx_text(mission);
    case Format::geojson:
      break;
  }
  return geojson_text(mission);
}
}  // namespace altiplan::host
