// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "altiplan/voxel_grid.hpp"

namespace altiplan::kit {

/// Distance from p to the box, 0 inside.
inline double outside(const Box& box, const Vec3& p) {
  return (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).norm();
}

/// True if the leg may come within `reach` of the box; never wrongly false.
inline bool may_reach(const Box& box, const Vec3& a, const Vec3& b, double reach) {
  const Box grown = box.grown(reach);
  double enter = 0;
  double leave = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double along = b[axis] - a[axis];
    const double low = grown.min[axis] - a[axis];
    const double high = grown.max[axis] - a[axis];
    if (along == 0) {
      if (low > 0 || high < 0) {
        return false;
      }
    } else {
      enter = std::max(enter, (along > 0 ? low : high) / along);
      leave = std::min(leave, (along > 0 ? high : low) / along);
    }
  }
  return enter <= leave;
}

/// Blocks the cells that the grid's blocking rule blocks for a solid within `bounds`, given its
/// signed distance from a point, distance(p), and whether it comes nearer to an open box than some
/// metres, overlaps(box, by). The distance is 1-Lipschitz, so one query at a centre decides many
/// cells; only those that the grown surface may cut are tested exactly.
template <class Distance, class Overlaps>
void rasterize(VoxelGrid& grid, const Box& bounds, const Distance& distance,
               const Overlaps& overlaps) {
  // Distances below this are rounding.
  constexpr double kMeets = 1e-9;
  const GridSpec& spec = grid.spec();
  const bool centre_rule = spec.rule == GridSpec::Rule::centre;
  const double by = spec.inflation + (centre_rule ? kMeets : 0);
  const double margin = centre_rule ? 0 : spec.cell.norm() / 2;
  const double width = spec.cell.x();
  const auto clamped = [](double value, int low, int high) {
    return static_cast<int>(std::clamp(value, double(low), double(high)));
  };

  const Box box = bounds.grown(spec.inflation);
  Cell first{};
  Cell last{};
  for (int axis = 0; axis < 3; ++axis) {
    const double low = (box.min[axis] - spec.origin[axis]) / spec.cell[axis];
    const double high = (box.max[axis] - spec.origin[axis]) / spec.cell[axis];
    first[axis] = clamped(std::floor(low) - 1, 0, spec.counts[axis]);
    last[axis] = clamped(std::ceil(high) + 1, -1, spec.counts[axis] - 1);
  }
  for (int k = first[2]; k <= last[2]; ++k) {
    for (int j = first[1]; j <= last[1]; ++j) {
      grid.ask_watch();
      for (int i = first[0]; i <= last[0];) {
        const double away = distance(spec.centre({i, j, k}));
        if (away <= by) {
          const int run = clamped((by - away) / width, 0, last[0] - i);
          grid.block_run(i, i + run, j, k);
          i += run + 1;
        } else if (away >= by + margin) {
          i += std::max(1, clamped((away - by - margin) / width, 0, last[0] - i + 1));
        } else {
          if (overlaps(spec.cell_box({i, j, k}), by)) {
            grid.block_run(i, i, j, k);
          }
          ++i;
        }
      }
    }
  }
}
}  // namespace altiplan::kit
