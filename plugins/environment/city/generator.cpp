// SPDX-License-Identifier: Apache-2.0
#include "generator.hpp"

#include <algorithm>

#include "altiplan/random.hpp"

namespace altiplan::city {
namespace {

/// Places buildings in the grid, each grown by a cell.
class Site {
 public:
  explicit Site(const Draw& draw) : grid_(spec_of(draw)) {
    for (const std::optional<Vec3>& p : {draw.start, draw.goal}) {
      if (p) {
        kept_free_.push_back(grid_.spec().cell_of(*p));
      }
    }
  }

  /// A building of w x d x h cells whose lower corner is (x, y).
  void place(int x, int y, int w, int d, int h) {
    const Cell low{x - 1, y - 1, 0};
    const Cell high{x + w, y + d, h};  // inclusive
    for (const Cell& kept : kept_free_) {
      bool covered = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        covered = covered && kept[axis] >= low[axis] && kept[axis] <= high[axis];
      }
      if (covered) {
        return;
      }
    }
    const Cell& counts = grid_.spec().counts;
    for (int k = 0; k <= std::min(high[2], counts[2] - 1); ++k) {
      for (int j = std::max(low[1], 0); j <= std::min(high[1], counts[1] - 1); ++j) {
        grid_.block_run(low[0], high[0], j, k);
      }
    }
  }

  VoxelGrid finish() && { return std::move(grid_); }

 private:
  static GridSpec spec_of(const Draw& draw) {
    GridSpec spec;
    spec.cell = Vec3::Constant(draw.cell_m);
    spec.counts = draw.cells;
    spec.rule = GridSpec::Rule::native;
    return spec;
  }

  VoxelGrid grid_;
  std::vector<Cell> kept_free_;
};

constexpr int kBlock = 20;  ///< cells of a street block, with a building in its middle

void draw_simple(const Draw& draw, Site& site) {
  SplitMix64 random(draw.seed);
  for (int j = 0; j < draw.cells[1] / kBlock; ++j) {
    for (int i = 0; i < draw.cells[0] / kBlock; ++i) {
      const double u = random.uniform();
      const int w = random.integer(6, 10);
      const int d = random.integer(6, 10);
      const int h = random.integer(20, 60);
      if (u < 0.75) {
        site.place(kBlock * i + (kBlock - w) / 2, kBlock * j + (kBlock - d) / 2, w, d, h);
      }
    }
  }
}

void draw_complex(const Draw& draw, Site& site) {
  SplitMix64 random(draw.seed);
  for (int n = 0; n < draw.buildings; ++n) {
    const int w = random.integer(3, 9);
    const int d = random.integer(3, 9);
    const int x = random.integer(0, draw.cells[0] - w);
    const int y = random.integer(0, draw.cells[1] - d);
    const int h = random.integer(60, 95);
    site.place(x, y, w, d, h);
  }
}
}  // namespace

VoxelGrid draw_city(const Draw& draw) {
  Site site(draw);
  draw.kind == Kind::simple ? draw_simple(draw, site) : draw_complex(draw, site);
  return std::move(site).finish();
}
}  // namespace altiplan::city
