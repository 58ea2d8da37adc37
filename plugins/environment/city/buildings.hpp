// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/environment.hpp"
#include "altiplan/params.hpp"

namespace altiplan::city {

struct Building {
  std::string name;
  Shape shape;  ///< local metres
};

/// Contents of a file of buildings.
struct Buildings {
  std::vector<Building> list;
  std::vector<std::string> notes;
  std::optional<Frame> frame;  ///< fixed by the file, if the world has none yet
};

/// Reading rules for files without a height for every building.
struct Heights {
  std::string height_property = "height";
  std::string levels_property;
  double metres_per_level = 3;
  std::optional<double> default_height_m;
};

/// GeoJSON footprints with heights, on the ground of the preceding layers or at `base_m`.
Buildings read_footprints(const std::string& file, const Heights& heights, double base_m,
                          const Site& site);

/// CityJSON 1.x and 2.0, CityJSONSeq: every Building and BuildingPart as a prism over its ground
/// surface, up to its highest point, where the file's coordinate system puts it in the world's
/// frame. In a world without one, the file's axes in metres are local ones, offset by `origin_m`,
/// the position that becomes (0, 0): by default the south-west corner of the buildings; a file in
/// degrees, or in lengths that are wrong by more than half a per cent, defines the frame.
Buildings read_city_json(const std::string& file,
                         const std::optional<std::array<double, 2>>& origin_m, const Site& site);

/// True if the file declares itself as CityJSON.
bool is_city_json(const std::string& file);

/// The colliders of the flying-car simulator: "lat0 …, lon0 …", the column names, then boxes by
/// centre and half sizes; x is north, y east, z up.
Buildings read_colliders(const std::string& file, const Site& site);
}  // namespace altiplan::city
