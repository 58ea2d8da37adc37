// SPDX-License-Identifier: Apache-2.0
// Points and legs in a grid of blocked and free cells.
#include <cmath>
#include <iostream>
#include <memory>

#include "altiplan/distance_field.hpp"
#include "altiplan/kit/lattice/line_of_sight.hpp"
#include "altiplan/random.hpp"
#include "ompl_peer.hpp"
#include "rows.hpp"

namespace altiplan::bench {
namespace {

/// Towers on 80 x 80 x 100 cells of 1 m, and legs between free cells.
struct Towers {
  VoxelGrid grid{spec()};
  RandomStream random{1};

  static GridSpec spec() {
    GridSpec spec;
    spec.counts = {80, 80, 100};
    return spec;
  }

  Towers() {
    for (int n = 0; n < 60; ++n) {
      const int i = int(random.integer(0, 75));
      const int j = int(random.integer(0, 75));
      const int height = int(random.integer(20, 90));
      for (int k = 0; k < height; ++k) {
        for (int dj = 0; dj < 5; ++dj) {
          grid.block_run(i, i + 4, j + dj, k);
        }
      }
    }
  }

  Cell any_cell() {
    const auto index = [&](int axis) {
      return int(random.integer(0, grid.spec().counts[axis] - 1));
    };
    return {index(0), index(1), index(2)};
  }

  // From a free cell, that many metres in a random direction, rounded to cells.
  std::vector<CellLeg> legs(double length) {
    std::vector<CellLeg> legs;
    while (legs.size() < kQueries) {
      const Cell a = any_cell();
      const Vec3 way = Vec3(random.normal(), random.normal(), random.normal()).normalized();
      const Cell b = grid.spec().cell_of(grid.spec().centre(a) + length * way);
      if (grid.spec().holds(b) && !grid.blocked(a)) {
        legs.push_back({a, b});
      }
    }
    return legs;
  }
};

bool walk(const VoxelGrid& grid, const CellLeg& leg) {
  return kit::walk_cells(leg.a, leg.b, [&](const Cell& c) { return !grid.blocked(c); });
}

void add_leg_rows(const std::shared_ptr<Towers>& towers, int cells) {
  const auto legs = std::make_shared<const std::vector<CellLeg>>(towers->legs(cells));
  const auto ompl = std::make_shared<const OmplPeer>(towers->grid, *legs);
  const auto free = [=](std::size_t n) {
    return kit::line_of_sight(towers->grid, (*legs)[n].a, (*legs)[n].b);
  };
  const auto walked = [=](std::size_t n) { return walk(towers->grid, (*legs)[n]); };
  const auto sampled = [=](std::size_t n) { return ompl->is_free(n); };
  const std::string of = "leg/" + std::to_string(cells) + "_cells/";
  require(of + "walk", [&](std::size_t n) { return free(n) == walked(n); });
  // Samples miss corners, but never report a free leg as blocked.
  require(of + "ompl", [&](std::size_t n) { return !free(n) || sampled(n); });
  std::cerr << of << ": " << share(free) << " of the legs are free, to the samples "
            << share(sampled) << '\n';
  add_row(of + "altiplan", free);
  add_row(of + "walk", walked);
  add_row(of + "ompl", sampled);
}
}  // namespace

void add_cell_rows() {
  const auto towers = std::make_shared<Towers>();
  const auto field = std::make_shared<const DistanceField>(towers->grid);
  std::vector<Vec3> points;
  for (std::size_t n = 0; n < kQueries; ++n) {
    points.push_back(towers->random.in(towers->grid.spec().box()));
  }
  const auto places = std::make_shared<const std::vector<Vec3>>(points);
  const auto blocked = [=](std::size_t n) {
    return towers->grid.blocked(towers->grid.spec().cell_of((*places)[n]));
  };
  const auto nearest = [=](std::size_t n) {
    return field->centre_distance(field->spec().cell_of((*places)[n]));
  };
  const auto clear = [=](std::size_t n) { return field->clearance((*places)[n]); };
  require("point/nearest", [&](std::size_t n) { return blocked(n) == (nearest(n) == 0); });
  require("point/clearance", [&](std::size_t n) { return !blocked(n) || clear(n) == 0; });
  add_row("point/altiplan", blocked);
  add_row("point/distance_to_centre", nearest);
  add_row("point/distance_bound", clear);
  for (const int cells : {10, 40}) {
    add_leg_rows(towers, cells);
  }
}
}  // namespace altiplan::bench
