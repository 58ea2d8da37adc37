// SPDX-License-Identifier: Apache-2.0
#include "city.hpp"

#include "altiplan/check.hpp"
#include "altiplan/kit/layers/cell_layer.hpp"

namespace altiplan::bench {
namespace {

VoxelGrid towers(RandomStream& random) {
  GridSpec spec;
  spec.counts = {80, 80, 100};
  spec.rule = GridSpec::Rule::native;
  VoxelGrid cells(spec);
  for (int n = 0; n < 90; ++n) {
    const int i = int(random.integer(0, 75));
    const int j = int(random.integer(0, 75));
    const int height = int(random.integer(10, 90));
    for (int k = 0; k < height; ++k) {
      for (int row = j; row < j + 5; ++row) {
        cells.block_run(i, i + 4, row, k);
      }
    }
  }
  return cells;
}
}  // namespace

City::City(bool low, std::size_t queries) {
  RandomStream random(1);
  const auto layer = std::make_shared<const kit::CellLayer>(towers(random));
  const VoxelGrid& grid = layer->cells();
  Request request;
  request.world = std::make_shared<const World>(World().with({"city", "city", layer, true}));
  request.volume = grid.spec().box();
  const double min_distance = (request.volume.max - request.volume.min).norm() / 2;
  while (queries_.size() < queries) {
    Cell ends[2];
    for (Cell& end : ends) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int count = axis == 2 && low ? 20 : grid.spec().counts[axis];
        end[axis] = int(random.integer(0, count - 1));
      }
    }
    request.start.position = grid.spec().centre(ends[0]);
    request.goal.position = grid.spec().centre(ends[1]);
    if (grid.blocked(ends[0]) || grid.blocked(ends[1]) ||
        (request.goal.position - request.start.position).norm() < min_distance) {
      continue;
    }
    open_ += leg_ok(std::nullopt, request.start.position, request.goal.position, request);
    request.random = RandomStream(queries_.size());
    queries_.push_back(request);
  }
}
}  // namespace altiplan::bench
