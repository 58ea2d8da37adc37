// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/kit/layers/polygon.hpp"

namespace altiplan::kit {

/// A Polygon of a GeoJSON file, or one of a MultiPolygon; longitude and latitude in degrees.
struct ALTIPLAN_API GeoFeature {
  std::string id;  ///< the feature's id or name, else its number
  Polygon polygon;
  std::map<std::string, std::string> properties;  ///< as JSON; null ones are left out

  /// "" where the feature has no such property.
  std::string text(const std::string& property) const;
  /// Metres, written as a number or as text. Throws Error where it is neither.
  std::optional<double> metres(const std::string& property) const;
};

struct ALTIPLAN_API GeoJson {
  std::vector<GeoFeature> features;
  std::size_t skipped = 0;        ///< features without an area: points, lines, no geometry
  std::vector<std::string> flat;  ///< names of polygons that are flat, wholly or in part
  std::string copyright;          ///< what the file says of its makers, "" where nothing

  /// "3 features without an area skipped ('pier')"
  std::string skipped_text() const;
};

/// Reads GeoJSON (RFC 7946). Throws Error, with the feature to blame, for what is not: damaged
/// text, rings that are open or meet themselves, coordinates out of range.
ALTIPLAN_API GeoJson read_geojson(const std::string& file);

/// A name that no feature has is a slip: what it stands for would silently be left out. Throws
/// Error with the names that there are.
ALTIPLAN_API void expect_properties(const std::string& file, const GeoJson& json,
                                    const std::vector<std::string>& names);
}  // namespace altiplan::kit
