// SPDX-License-Identifier: Apache-2.0
#include "altiplan/earth.hpp"

#include <GeographicLib/Ellipsoid.hpp>
#include <GeographicLib/Geodesic.hpp>
#include <cmath>

namespace altiplan {

using GeographicLib::Ellipsoid;
using GeographicLib::Geodesic;

LonLat geodesic_end(const LonLat& from, double bearing_deg, double metres) {
  double lat = 0;
  double lon = 0;
  double unused = 0;
  Geodesic::WGS84().GenDirect(from[1], from[0], bearing_deg, false, metres,
                              Geodesic::LATITUDE | Geodesic::LONGITUDE | Geodesic::LONG_UNROLL, lat,
                              lon, unused, unused, unused, unused, unused, unused);
  return {lon, lat};
}

GeodesicCourse geodesic_course(const LonLat& from, const LonLat& to) {
  double metres = 0;
  double begin = 0;
  double end = 0;
  Geodesic::WGS84().Inverse(from[1], from[0], to[1], to[0], metres, begin, end);
  return {metres, begin};
}

double longitude_near(double lon, double other) {
  return lon - 360 * std::round((lon - other) / 360);
}

GroundRadii ground_radii(double lat) {
  const Ellipsoid& earth = Ellipsoid::WGS84();
  return {earth.CircleRadius(lat), earth.MeridionalCurvatureRadius(lat)};
}
}  // namespace altiplan
