// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "polygon.hpp"

namespace altiplan::zones {

/// Names of the properties that carry a zone's limits; "" where the file has none.
struct PropertyNames {
  std::string floor;
  std::string ceiling;
  std::string from;
  std::string until;
};

/// A Polygon of the file, or one of a MultiPolygon; longitude and latitude in degrees.
struct Feature {
  std::string id;
  Polygon polygon;
  std::optional<double> floor_m;
  std::optional<double> ceiling_m;
  std::string from;
  std::string until;
};

struct GeoJson {
  std::vector<Feature> features;
  std::size_t skipped = 0;  ///< features without an area: points, lines, no geometry
};

/// Reads GeoJSON (RFC 7946). Throws Error, with the feature to blame, for what is not: damaged
/// text, rings that are open or meet themselves, coordinates out of range, heights that are no
/// numbers.
GeoJson read_geojson(const std::string& file, const PropertyNames& names);
}  // namespace altiplan::zones
