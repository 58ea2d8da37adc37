// SPDX-License-Identifier: Apache-2.0
#include "detours/detour_maps.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "altiplan/error.hpp"
#include "altiplan/random.hpp"
#include "search/plain_astar.hpp"

namespace altiplan::bench {
namespace {

constexpr int kWallEvery = 12;
constexpr int kGap = 4;
constexpr int kCanyonEvery = 8;
constexpr int kStreet = 3;

/// Blocks columns (i, j) from the ground up to `height`, for i in [i0, i1) and j in [j0, j1).
void block_tower(VoxelGrid& map, int i0, int i1, int j0, int j1, int height) {
  for (int k = 0; k < height; ++k) {
    for (int j = std::max(j0, 0); j < std::min(j1, map.spec().counts[1]); ++j) {
      map.block_run(i0, i1 - 1, j, k);
    }
  }
}

void build_walls(VoxelGrid& map, RandomStream& random) {
  const auto [nx, ny, nz] = map.spec().counts;
  for (int i = kWallEvery; i + kWallEvery / 2 < nx; i += kWallEvery) {
    block_tower(map, i, i + 2, 0, ny, nz);
    const int j0 = int(random.integer(0, ny - kGap));
    const int k0 = int(random.integer(0, nz - kGap));
    for (int k = k0; k < k0 + kGap; ++k) {
      for (int j = j0; j < j0 + kGap; ++j) {
        map.free_run(i, i + 1, j, k);
      }
    }
  }
}

void build_canyons(VoxelGrid& map, RandomStream& random) {
  const auto [nx, ny, nz] = map.spec().counts;
  bool at_end = random.uniform() < 0.5;
  for (int i = kCanyonEvery; i + kCanyonEvery / 2 < nx; i += kCanyonEvery) {
    const int open = int(random.integer(4, std::max(4, ny / 6)));
    block_tower(map, i, i + 3, at_end ? 0 : open, at_end ? ny - open : ny, nz);
    at_end = !at_end;
  }
}

void build_towers(VoxelGrid& map, RandomStream& random) {
  const auto [nx, ny, nz] = map.spec().counts;
  for (int i = 0; i < nx;) {
    const int width = int(random.integer(5, 12));
    for (int j = int(random.integer(-6, 0)); j < ny;) {
      const int depth = int(random.integer(5, 12));
      block_tower(map, i, std::min(i + width, nx), j, j + depth,
                  int(random.integer(nz / 2, nz - 1)));
      // A street in four is shut by the next block.
      j += depth + (random.uniform() < 0.25 ? 0 : kStreet);
    }
    i += width + kStreet;
  }
}

Cell free_cell(const VoxelGrid& map, RandomStream& random, int low, int high, int top) {
  for (int trial = 0; trial < 100'000; ++trial) {
    const Cell cell{int(random.integer(low, high - 1)),
                    int(random.integer(0, map.spec().counts[1] - 1)),
                    int(random.integer(0, top - 1))};
    if (!map.blocked(cell)) {
      return cell;
    }
  }
  throw Error("the map has no free cell at an end");
}
}  // namespace

VoxelGrid detour_map(DetourKind kind, const Cell& counts, std::uint64_t seed) {
  if (counts[0] < 24 || counts[1] < 24 || counts[2] < 8) {
    throw Error("expected at least 24 x 24 x 8 cells, found " + std::to_string(counts[0]) + " x " +
                std::to_string(counts[1]) + " x " + std::to_string(counts[2]));
  }
  VoxelGrid map(GridSpec{Vec3::Zero(), Vec3::Ones(), counts});
  RandomStream random = RandomStream(seed).sub("map", std::uint64_t(kind));
  switch (kind) {
    case DetourKind::walls:
      build_walls(map, random);
      break;
    case DetourKind::canyons:
      build_canyons(map, random);
      break;
    case DetourKind::towers:
      build_towers(map, random);
      break;
  }
  return map;
}

std::vector<DetourQuery> detour_queries(DetourKind kind, const VoxelGrid& map, std::size_t count,
                                        std::uint64_t seed) {
  const Cell& counts = map.spec().counts;
  const int end = counts[0] / 8;
  const int top = kind == DetourKind::towers ? std::max(1, counts[2] / 5) : counts[2];
  RandomStream random = RandomStream(seed).sub("queries", std::uint64_t(kind));
  std::vector<DetourQuery> queries;
  for (std::size_t trial = 0; queries.size() < count; ++trial) {
    if (trial > 10 * count + 100) {
      throw Error("no way leads through the map: try another seed");
    }
    const Cell start = free_cell(map, random, 0, end, top);
    const Cell goal = free_cell(map, random, counts[0] - end, counts[0], top);
    const PlainResult found = plain_astar(map, start, goal);
    if (std::isfinite(found.length)) {
      queries.push_back({start, goal, octile(start, goal), found.length});
    }
  }
  return queries;
}

std::string voxel_map_text(const VoxelGrid& map) {
  const auto [nx, ny, nz] = map.spec().counts;
  std::string text =
      "voxel " + std::to_string(nx) + " " + std::to_string(ny) + " " + std::to_string(nz) + "\n";
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      const std::string row = " " + std::to_string(j) + " " + std::to_string(k) + "\n";
      map.for_each_run(j, k, [&](int first, int last) {
        for (int i = first; i <= last; ++i) {
          text += std::to_string(i) + row;
        }
      });
    }
  }
  return text;
}

std::string voxel_scenarios_text(const std::string& map_name,
                                 const std::vector<DetourQuery>& queries) {
  std::string text = "version 1\n" + map_name + "\n";
  for (const DetourQuery& query : queries) {
    for (const Cell& cell : {query.start, query.goal}) {
      for (const int index : cell) {
        text += std::to_string(index) + " ";
      }
    }
    char figures[64];
    std::snprintf(figures, sizeof figures, "%.8f %.3f\n", query.length,
                  query.length / query.straight);
    text += figures;
  }
  return text;
}
}  // namespace altiplan::bench
