// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "altiplan/kit/layers/cell_layer.hpp"
#include "host/view/scene_parts.hpp"

namespace altiplan::host {
namespace {

constexpr double kMaxCells = 1'000'000;

/// What is kept of the layer's cells: not those within its ground, which is drawn as such.
VoxelGrid without_ground(const Ground& ground, const VoxelGrid& cells) {
  const GridSpec& spec = cells.spec();
  VoxelGrid kept(spec);
  for (int j = 0; j < spec.counts[1]; ++j) {
    for (int i = 0; i < spec.counts[0]; ++i) {
      const Vec3 at = spec.centre({i, j, 0});
      const double height = ground.height(at.x(), at.y()).value_or(-kInfinity);
      for (int k = 0; k < spec.counts[2]; ++k) {
        kept.set({i, j, k}, cells.blocked(i, j, k) && spec.cell_box({i, j, k}).min.z() > height);
      }
    }
  }
  return kept;
}
}  // namespace

Drawing drawing_by_cells(const Layer& layer, const Box& box, SceneNotes& notes) {
  const Environment& environment = *layer.environment;
  const Box area = environment.bounds().intersected(box);
  const Vec3 size = (area.max - area.min).cwiseMax(0.0);
  if (area.is_empty() || size.minCoeff() <= 0) {
    return {};
  }
  GridSpec spec;
  const double edge = std::cbrt(size.prod() / kMaxCells);
  double cells = 1;
  for (int axis = 0; axis < 3; ++axis) {
    spec.counts[axis] = int(std::clamp(std::floor(size[axis] / edge), 1.0, kMaxCells / cells));
    spec.cell[axis] = size[axis] / spec.counts[axis];
    cells *= spec.counts[axis];
  }
  spec.origin = area.min;
  VoxelGrid grid(spec);
  environment.rasterize(grid);
  char text[96];
  std::snprintf(text, sizeof text, ": drawn as cells of %.3g x %.3g x %.3g m", spec.cell.x(),
                spec.cell.y(), spec.cell.z());
  notes.add(layer.id + text);
  if (const Ground* ground = environment.ground()) {
    grid = without_ground(*ground, grid);
  }
  return kit::drawing_of(kit::boxes_of(grid));
}
}  // namespace altiplan::host
