// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

namespace altiplan::kit {

/// EPSG code of the zone of the Universal Transverse Mercator system, or near the poles of the
/// polar stereographic one, that holds a place (degrees in WGS 84): "EPSG:32632". The exceptions
/// of Norway and Svalbard are left out.
inline std::string utm_crs(double lon, double lat) {
  constexpr double kNorth = 84;
  constexpr double kSouth = -80;
  const int zone =
      lat > kNorth || lat < kSouth ? 61 : std::clamp(int(std::floor((lon + 180) / 6)) + 1, 1, 60);
  return "EPSG:" + std::to_string((lat < 0 ? 32700 : 32600) + zone);
}
}  // namespace altiplan::kit
