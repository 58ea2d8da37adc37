// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/kit/layers/cell_layer.hpp"
#include "altiplan/measures.hpp"
#include "support/support.hpp"

namespace altiplan::testing {

/// A level of cells for planning, row 0 southernmost.
struct Map {
  int width = 1;
  int height = 1;
  Vec3 cell{1, 1, 1};
  Vec3 origin{0, 0, 0};
  std::vector<char> blocked = {};

  Map(int columns, int rows) : width(columns), height(rows) {
    blocked.assign(std::size_t(columns * rows), 0);
  }
  char& at(int x, int y) { return blocked[std::size_t(y * width + x)]; }
  bool free(int x, int y) const {
    return x >= 0 && y >= 0 && x < width && y < height && blocked[std::size_t(y * width + x)] == 0;
  }
  GridSpec spec() const {
    GridSpec spec;
    spec.origin = origin;
    spec.cell = cell;
    spec.counts = {width, height, 1};
    spec.rule = GridSpec::Rule::native;
    return spec;
  }
  Vec3 centre(int index) const { return spec().centre({index % width, index / width, 0}); }
  std::vector<int> free_cells() const {
    std::vector<int> cells;
    for (int i = 0; i < width * height; ++i) {
      if (blocked[std::size_t(i)] == 0) {
        cells.push_back(i);
      }
    }
    return cells;
  }
  World world() const {
    VoxelGrid grid(spec());
    for (int i = 0; i < width * height; ++i) {
      grid.set({i % width, i / width, 0}, blocked[std::size_t(i)] != 0);
    }
    return world_of(std::make_shared<kit::CellLayer>(std::move(grid)));
  }
  /// A problem in level flight between the centres of two cells.
  Request request(int from, int to) const {
    Request request = request_in(world(), centre(from), centre(to), spec().box());
    request.level_m = request.start.position.z();
    return request;
  }
  Map transposed() const {
    Map map(height, width);
    map.cell = {cell.y(), cell.x(), cell.z()};
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        map.at(y, x) = !free(x, y);
      }
    }
    return map;
  }
  Map mirrored() const {
    Map map = *this;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        map.at(width - 1 - x, y) = !free(x, y);
      }
    }
    return map;
  }
};

inline int pick(SplitMix64& random, const std::vector<int>& from) {
  return from[std::size_t(random.integer(0, int(from.size()) - 1))];
}

inline Map random_map(SplitMix64& random, int width, int height, double density) {
  Map map(width, height);
  for (char& cell : map.blocked) {
    cell = random.uniform() < density;
  }
  return map;
}

/// A wall in every other row, with one gap, east and west alternately.
inline Map serpentine(int width, int height) {
  Map map(width, height);
  for (int y = 1; y < height; y += 2) {
    for (int x = 0; x < width; ++x) {
      map.at(x, y) = x != (y % 4 == 1 ? width - 1 : 0);
    }
  }
  return map;
}

/// Lengths of the shortest paths from a cell by Dijkstra's algorithm; infinite if there is none.
inline std::vector<double> shortest(const Map& map, int from, bool free_box) {
  std::vector<double> best(map.blocked.size(), kInfinity);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  best[std::size_t(from)] = 0;
  open.push({0, from});
  while (!open.empty()) {
    const auto [g, here] = open.top();
    open.pop();
    const int x = here % map.width;
    const int y = here / map.width;
    for (int d = 0; d < 9; ++d) {
      const int dx = d % 3 - 1;
      const int dy = d / 3 - 1;
      if (d == 4 || !map.free(x + dx, y + dy) ||
          (free_box && !(map.free(x + dx, y) && map.free(x, y + dy)))) {
        continue;
      }
      const auto to = std::size_t((y + dy) * map.width + x + dx);
      const double length = g + map.cell.cwiseProduct(Vec3(dx, dy, 0)).norm();
      if (length < best[to]) {
        best[to] = length;
        open.push({length, int(to)});
      }
    }
  }
  return best;
}
}  // namespace altiplan::testing
