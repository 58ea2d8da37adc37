// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "altiplan/geometry.hpp"

/// \file The Earth (the ellipsoid of WGS 84), by GeographicLib (C. F. F. Karney, Algorithms for
/// geodesics, Journal of Geodesy 87, 2013): right to nanometres, everywhere. Positions are
/// longitude and latitude in degrees.
namespace altiplan {

using LonLat = std::array<double, 2>;

/// Where a geodesic leads. Its longitude runs on beyond 180 degrees, without a jump.
ALTIPLAN_API LonLat geodesic_end(const LonLat& from, double bearing_deg, double metres);

struct GeodesicCourse {
  double metres;
  double bearing_deg;  ///< at the beginning, clockwise from north
};
/// The shortest line between two positions.
ALTIPLAN_API GeodesicCourse geodesic_course(const LonLat& from, const LonLat& to);

/// The same longitude, at most 180 degrees from another.
ALTIPLAN_API double longitude_near(double lon, double other);

/// Metres on the ground for each radian of longitude and of latitude.
struct GroundRadii {
  double east;
  double north;
};
ALTIPLAN_API GroundRadii ground_radii(double lat);
}  // namespace altiplan
