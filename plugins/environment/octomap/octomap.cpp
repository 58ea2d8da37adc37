// SPDX-License-Identifier: Apache-2.0
// OctoMap occupancy maps as the finest voxels of their octree.
#include <algorithm>
#include <mutex>

#include "altiplan/environment.hpp"
#include "altiplan/kit/layers/cell_layer.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/what_blocks.hpp"
#include "octree.hpp"

namespace altiplan::octomap {
namespace {

enum class Unknown { free, blocked };

struct Params {
  Path file;
  Unknown unknown = Unknown::blocked;
  double occupied_from = 0.5;
  std::int64_t max_cells = 1'000'000'000;

  void describe(Fields& f) {
    f("file", file).doc("OctoMap file: .bt, or .ot with or without colours").required();
    f("unknown", unknown, {{"free", Unknown::free}, {"blocked", Unknown::blocked}})
        .doc("state of the voxels in the map's box that were not measured");
    f("occupied_from", occupied_from)
        .range(0.01, 0.99)
        .doc("minimum probability at which a voxel of an .ot file counts as occupied");
    f("max_cells", max_cells)
        .at_least(1)
        .doc("a map whose box has more voxels is rejected before anything is allocated");
  }
};

struct Read {
  VoxelGrid cells;     ///< blocked voxels
  VoxelGrid occupied;  ///< those of them that were measured
  std::vector<std::string> notes;
};

/// The bounding box of all known voxels.
GridSpec spec_of(const Octree& tree, const Params& params) {
  Cell low{1 << kDepth, 1 << kDepth, 1 << kDepth};
  Cell high{0, 0, 0};
  tree.leaves(params.occupied_from, [&](const Leaf& leaf) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], leaf.key[axis]);
      high[axis] = std::max(high[axis], leaf.key[axis] + leaf.edge);
    }
  });
  if (low[0] >= high[0]) {
    throw Error(params.file.text + ": the map has no known voxel");
  }
  GridSpec spec;
  spec.rule = GridSpec::Rule::native;
  spec.cell = Vec3::Constant(tree.resolution());
  double total = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    spec.counts[axis] = high[axis] - low[axis];
    spec.origin[Eigen::Index(axis)] = (low[axis] - kOriginKey) * tree.resolution();
    total *= spec.counts[axis];
  }
  if (total > double(params.max_cells)) {
    throw ParameterError(
        "max_cells", params.file.text + ": the map's box has " + std::to_string(spec.counts[0]) +
                         " x " + std::to_string(spec.counts[1]) + " x " +
                         std::to_string(spec.counts[2]) + " voxels, more than max_cells");
  }
  return spec;
}

Read read(const Params& params) {
  const Octree tree(params.file.text);
  const GridSpec spec = spec_of(tree, params);
  Read result{VoxelGrid(spec), VoxelGrid(spec), {}};
  VoxelGrid& cells = result.cells;
  Cell low{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = int(std::lround(spec.origin[Eigen::Index(axis)] / tree.resolution())) + kOriginKey;
  }
  const bool unknown_blocked = params.unknown == Unknown::blocked;
  for (int k = 0; unknown_blocked && k < spec.counts[2]; ++k) {
    for (int j = 0; j < spec.counts[1]; ++j) {
      cells.block_run(0, spec.counts[0] - 1, j, k);
    }
  }
  std::array<std::int64_t, 2> leaves{0, 0};
  std::array<std::int64_t, 2> voxels{0, 0};
  tree.leaves(params.occupied_from, [&](const Leaf& leaf) {
    ++leaves[leaf.occupied];
    voxels[leaf.occupied] += std::int64_t(leaf.edge) * leaf.edge * leaf.edge;
    const int i = leaf.key[0] - low[0];
    for (int k = leaf.key[2] - low[2]; k < leaf.key[2] - low[2] + leaf.edge; ++k) {
      for (int j = leaf.key[1] - low[1]; j < leaf.key[1] - low[1] + leaf.edge; ++j) {
        if (leaf.occupied) {
          cells.block_run(i, i + leaf.edge - 1, j, k);
          result.occupied.block_run(i, i + leaf.edge - 1, j, k);
        } else {
          cells.free_run(i, i + leaf.edge - 1, j, k);
        }
      }
    }
  });
  if (unknown_blocked && voxels[0] == 0) {
    throw ParameterError("unknown", params.file.text +
                                        ": the map marks no voxel as free; set unknown: free to "
                                        "fly through unmeasured space");
  }
  const auto count = [](std::int64_t n) { return std::to_string(n); };
  result.notes = {count(leaves[1]) + " occupied leaves (" + count(voxels[1]) + " voxels), " +
                  count(leaves[0]) + " free (" + count(voxels[0]) + "), " +
                  count(std::int64_t(spec.cell_count()) - voxels[0] - voxels[1]) +
                  " voxels unknown, taken as " + (unknown_blocked ? "blocked" : "free")};
  return result;
}

class OctoMap final : public kit::CellLayer, public WhatBlocks {
 public:
  OctoMap(const Params& params, const Site&) : OctoMap(checked(params)) {}

 private:
  explicit OctoMap(Read map)
      : CellLayer(std::move(map.cells), std::move(map.notes)), occupied_(std::move(map.occupied)) {}

  static Read checked(const Params& params) {
    try {
      return read(params);
    } catch (const ParameterError&) {
      throw;
    } catch (const Error& error) {
      throw ParameterError("file", error.what());
    }
  }

  std::optional<Drawing> do_drawing() const override {
    Drawing drawing = kit::drawing_of(kit::boxes_of(occupied_));
    VoxelGrid unknown = cells();
    for (int k = 0; k < unknown.spec().counts[2]; ++k) {
      for (int j = 0; j < unknown.spec().counts[1]; ++j) {
        occupied_.for_each_run(j, k,
                               [&](int first, int last) { unknown.free_run(first, last, j, k); });
      }
    }
    Drawing rest = kit::drawing_of(kit::boxes_of(unknown), Drawn::Role::unknown);
    std::move(rest.shapes.begin(), rest.shapes.end(), std::back_inserter(drawing.shapes));
    return drawing;
  }
  std::string do_what_blocks(const Vec3& a, const Vec3& b, double distance) const override {
    std::call_once(asked_, [&] { measured_.emplace(occupied_); });
    const bool is_measured = measured_->blocked(a, b, distance < 0 ? 0 : distance + kNearer);
    return is_measured ? "" : "unknown space, treated as blocked";
  }

  static constexpr double kNearer = 1e-5;  ///< m: differences below this count as equal

  VoxelGrid occupied_;
  mutable std::once_flag asked_;  ///< for messages, rarely needed
  mutable std::optional<kit::CellLayer> measured_;
};
}  // namespace
}  // namespace altiplan::octomap

ALTIPLAN_PLUGIN(Environment, "octomap", altiplan::octomap::OctoMap, altiplan::octomap::Params,
                "an OctoMap occupancy map (.bt, .ot)")
