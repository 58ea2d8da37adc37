// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/mission_text.hpp"

#include <charconv>
#include <cmath>

#include "altiplan/formats/iso_time.hpp"
#include "altiplan/frame.hpp"
#include "altiplan/geometry.hpp"
#include "host/import_export/map_parts.hpp"

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

const char* words_of(formats::AltitudeFrame frame) {
  return frame == formats::AltitudeFrame::sea      ? "above mean sea level"
         : frame == formats::AltitudeFrame::ground ? "above the ground below each point"
                                                   : "relative to the home position";
}

const char* role_of(const formats::Zone& zone) { return zone.keeps_in() ? "keep_in" : "keep_out"; }

std::optional<double> altitude_of(const formats::ZoneLimit& limit) {
  return limit.datum == formats::ZoneLimit::Datum::none ? std::nullopt
                                                        : std::optional(limit.metres);
}

std::string iso_time(const MissionText& text, std::size_t n) {
  if (!text.start_time_s || n >= text.times_s.size()) {
    return "";
  }
  return formats::iso_time(*text.start_time_s + text.times_s[n]);
}
}  // namespace altiplan::host
