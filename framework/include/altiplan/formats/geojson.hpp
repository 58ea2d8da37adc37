// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/formats/zone.hpp"

namespace altiplan::formats {

/// A Polygon of a GeoJSON file, or one of a MultiPolygon; longitude and latitude in degrees.
struct ALTIPLAN_API GeoFeature {
  std::string id;  ///< the feature's id or name, else its number
  Polygon polygon;
  std::map<std::string, std::string> properties;  ///< as JSON; null values are omitted
  std::string problem = {};                       ///< as that of a Zone

  /// The property as text; "" where the feature has none.
  std::string text(const std::string& property) const;
  /// The property in metres, a number or text; throws Error if it is neither.
  std::optional<double> metres(const std::string& property) const;
};

struct ALTIPLAN_API GeoJson {
  std::vector<GeoFeature> features;
  /// What lies within the distance of a point or a line that a property gives, such as
  /// "Bufferzone": "5 km"; several polygons for each.
  std::vector<GeoFeature> surroundings;
  std::vector<NamedPoint> points;   ///< by the id or name of their feature, else its number
  std::vector<Ring> lines;          ///< of LineStrings and MultiLineStrings
  std::size_t skipped = 0;          ///< features without an area: points, lines, no geometry
  std::vector<std::string> places;  ///< of these the points and lines: "mast at 25.05, 60.05"
  std::vector<std::string> flat;    ///< names of polygons that are degenerate, wholly or in part
  std::string copyright;            ///< copyright notice of the file, "" where there is none

  /// "3 features without an area skipped ('pier')"
  std::string skipped_text() const;
};

/// Reads GeoJSON (RFC 7946). Throws Error, naming the feature, for damaged text, rings that are
/// open, coordinates out of range, and a radius or buffer that is no length. A number without a
/// unit is in metres from 100 on, below in kilometres, which closes more.
ALTIPLAN_API GeoJson read_geojson(const std::string& file);

/// The property `role` of zones that we wrote, keep_in or keep_out; unspecified for others.
ALTIPLAN_API Restriction role_of(const GeoFeature& feature);
/// The feature as a zone, without the hours that other properties may give; with a role, its
/// limits.
ALTIPLAN_API Zone zone_of(const GeoFeature& feature);

/// Throws Error, listing the existing names, for a property that no feature has: most likely a
/// typing error, which would otherwise silently drop data.
ALTIPLAN_API void expect_properties(const std::string& file, const GeoJson& json,
                                    const std::vector<std::string>& names);
}  // namespace altiplan::formats
