// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "altiplan/formats/earth_polygon.hpp"
#include "altiplan/formats/geojson.hpp"
#include "altiplan/world.hpp"
#include "buildings.hpp"

namespace altiplan::city {
namespace {

/// Determines each building's height and counts its sources.
class HeightRule {
 public:
  explicit HeightRule(const Heights& heights) : heights_(heights) {}

  double height(const formats::GeoFeature& feature) {
    if (const auto metres = feature.metres(heights_.height_property)) {
      ++measured_;
      return positive(*metres, heights_.height_property);
    }
    if (const auto levels = feature.metres(heights_.levels_property)) {
      ++by_levels_;
      return positive(*levels, heights_.levels_property) * heights_.metres_per_level;
    }
    if (heights_.default_height_m) {
      ++by_default_;
      return *heights_.default_height_m;
    }
    throw Error(
        "has no '" + heights_.height_property + "'" +
        (heights_.levels_property.empty() ? "" : " and no '" + heights_.levels_property + "'") +
        ": give default_height_m, or another property as levels_property");
  }

  std::string note() const {
    return std::to_string(measured_) + " heights as given, " + std::to_string(by_levels_) +
           " from levels, " + std::to_string(by_default_) + " from default_height_m";
  }

 private:
  static double positive(double value, const std::string& property) {
    if (!(value > 0)) {
      throw Error("expected a '" + property + "' above 0, found " + std::to_string(value));
    }
    return value;
  }

  const Heights& heights_;
  std::size_t measured_ = 0;
  std::size_t by_levels_ = 0;
  std::size_t by_default_ = 0;
};

/// The origin is the buildings' south-west corner.
Frame frame_of(const formats::GeoJson& json) {
  std::vector<formats::Point2> corners;
  for (const formats::GeoFeature& feature : json.features) {
    const formats::Ring& outline = feature.polygon.outline;
    corners.insert(corners.end(), outline.begin(), outline.end());
  }
  return formats::frame_around(corners);
}

/// Lowest and highest ground at the outline's corners.
std::array<double, 2> ground_below(const formats::Ring& outline, const World& before,
                                   double base_m) {
  std::array<double, 2> range{kInfinity, -kInfinity};
  for (const formats::Point2& p : outline) {
    if (const auto ground = before.ground(p[0], p[1])) {
      range = {std::min(range[0], *ground), std::max(range[1], *ground)};
    }
  }
  return range[0] <= range[1] ? range : std::array<double, 2>{base_m, base_m};
}
}  // namespace

Buildings read_footprints(const std::string& file, const Heights& heights, double base_m,
                          const Site& site) {
  const formats::GeoJson json = formats::read_geojson(file);
  if (json.features.empty()) {
    throw Error(file + ": contains no building");
  }
  formats::expect_properties(file, json, {heights.levels_property});
  Buildings buildings;
  Frame frame = site.frame;
  if (!frame.has_position()) {
    frame = frame_of(json);
    buildings.frame = frame;
  }
  HeightRule rule(heights);
  std::vector<std::string> unclear;
  for (const formats::GeoFeature& feature : json.features) {
    try {
      const double height = rule.height(feature);
      if (!feature.problem.empty() && (unclear.empty() || unclear.back() != feature.id)) {
        unclear.push_back(feature.id);
      }
      for (formats::Polygon& part : formats::in_frame(feature.polygon, frame)) {
        const auto [low, high] = ground_below(part.outline, *site.before, base_m);
        buildings.list.push_back({feature.id, Prism{std::move(part.outline), std::move(part.holes),
                                                    low, high + height}});
      }
    } catch (const Error& error) {
      throw Error(file + ": '" + feature.id + "': " + error.what());
    }
  }
  buildings.notes = {std::to_string(buildings.list.size()) + " buildings, " + json.skipped_text(),
                     rule.note()};
  if (!unclear.empty()) {
    buildings.notes.push_back("rings that are no polygon, closed in all that they may enclose: " +
                              formats::names_text(unclear));
  }
  if (!json.copyright.empty()) {
    buildings.notes.push_back("attribution: " + json.copyright);
  }
  return buildings;
}
}  // namespace altiplan::city
