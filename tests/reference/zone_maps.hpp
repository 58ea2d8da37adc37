// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "reference/circle_visibility.hpp"
#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::reference {

/// The circles and polygons of a layer that draws its zones, for exact shortest routes.
struct ZoneMap {
  std::vector<Circle> circles;
  std::vector<Polygon> polygons;

  explicit ZoneMap(const Environment& layer) {
    const Drawing drawing = layer.drawing().value();
    for (const Drawn& drawn : drawing.shapes) {
      if (const auto* cylinder = std::get_if<Cylinder>(&drawn.shape)) {
        circles.push_back({{cylinder->x, cylinder->y}, cylinder->radius});
      } else {
        polygons.push_back(std::get<Prism>(drawn.shape).outline);
      }
    }
  }
  CircleVisibility visibility() const { return CircleVisibility(circles, polygons); }
};

/// The map of paper 004, as its scenario gives it.
inline std::unique_ptr<Environment> paper_zones() {
  const host::Json scenario =
      testing::yaml_as_json(testing::configs() / "scenarios" / "ant_colony.yaml");
  return testing::make_environment("zones", scenario.at("environment").at(0).at("zones").dump());
}

/// One of the maps like it.
inline std::unique_ptr<Environment> random_zones(int seed) {
  return testing::make_environment("random_zones", "{seed: " + std::to_string(seed) + "}");
}

inline const Point2 kZonesStart{30, 30};
inline const Point2 kZonesGoal{970, 630};
}  // namespace altiplan::reference
