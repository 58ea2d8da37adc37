// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "altiplan/voxel_grid.hpp"

namespace altiplan::city {

enum class Kind { simple, complex };

/// Parameters of generated cities: blocks in cells, paper 003, section 4.
struct Draw {
  Kind kind = Kind::simple;
  std::uint64_t seed = 0;
  Cell cells{80, 80, 100};
  double cell_m = 10;
  int buildings = 60;         ///< of a complex city
  std::optional<Vec3> start;  ///< buildings that would cover it are omitted
  std::optional<Vec3> goal;
};

/// The city's cells, buildings grown by a cell on their sides and top.
VoxelGrid draw_city(const Draw& draw);
}  // namespace altiplan::city
