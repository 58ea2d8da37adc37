// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "altiplan/voxel_grid.hpp"

namespace altiplan::bench {

/// Maps in which the straight way is shut, so that a search cannot live off its heuristic: random
/// ones of real cities and games are nearly straight ways.
enum class DetourKind {
  walls,    ///< walls of full height, each with one gap of 4 x 4 cells
  canyons,  ///< walls of full height, open by turns at one end and the other
  towers,   ///< blocks of random height between narrow streets
};

/// Cubes of 1 m; the same for the same arguments on every machine. Throws Error below 24 x 24 x 8
/// cells.
VoxelGrid detour_map(DetourKind kind, const Cell& counts, std::uint64_t seed);

struct DetourQuery {
  Cell start{};
  Cell goal{};
  double straight = 0;  ///< octile distance, in cells
  double length = 0;    ///< of the shortest way through free cells, corners cut; by plain_astar
};

/// Ways from the first to the last eighth along x; among towers with both ends in the lowest fifth.
/// Throws Error if a map has none.
std::vector<DetourQuery> detour_queries(DetourKind kind, const VoxelGrid& map, std::size_t count,
                                        std::uint64_t seed);

/// The formats of Brewer and Sturtevant, "Benchmarks for Pathfinding in 3D Voxel Space", SoCS 2018.
std::string voxel_map_text(const VoxelGrid& map);
std::string voxel_scenarios_text(const std::string& map_name,
                                 const std::vector<DetourQuery>& queries);
}  // namespace altiplan::bench
