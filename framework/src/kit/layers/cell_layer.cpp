// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/layers/cell_layer.hpp"

#include <algorithm>

#include "altiplan/error.hpp"

#include "cell_boxes.hpp"

namespace altiplan::kit {
namespace {

constexpr double kSeam = 2 * kLengthTolerance;

VoxelGrid native(VoxelGrid cells) {
  GridSpec spec = cells.spec();
  if (spec.rule == GridSpec::Rule::native && spec.inflation == 0) {
    return cells;
  }
  throw Error("a layer of cells needs its grid with the rule `native` and no inflation");
}
}  // namespace

std::vector<Shape> boxes_of(const VoxelGrid& cells) {
  const CellBoxes boxes = cell_boxes_of(cells);
  std::vector<Shape> shapes;
  shapes.reserve(boxes.boxes.size());
  for (std::size_t n = 0; n < boxes.boxes.size(); ++n) {
    shapes.emplace_back(boxes[n]);
  }
  return shapes;
}

CellLayer::CellLayer(VoxelGrid cells, std::vector<std::string> notes)
    : cells_(native(std::move(cells))),
      info_{{}, cells_.spec(), {}, std::move(notes)},
      solid_(ObstacleSet::of_cells(cell_boxes_of(cells_))) {}

double CellLayer::do_clearance(const Vec3& p) const {
  const double outside = solid_.clearance(p);
  // Adjacent boxes are independent of each other: the depth in their union comes from the cells.
  return outside > 0 ? outside : -depth(p);
}

/// Distance from the nearest free cell, or the outside of the grid; 0 at the surface.
double CellLayer::depth(const Vec3& p) const {
  const GridSpec& spec = cells_.spec();
  const Cell at = spec.cell_of(p);
  const Box whole = spec.box();
  double minimum = std::max(0.0, std::min((p - whole.min).minCoeff(), (whole.max - p).minCoeff()));
  const double edge = spec.cell.minCoeff();
  // All cells nearer than (ring - 1) edges lie within the ring.
  for (int ring = 0; minimum > std::max(0, ring - 1) * edge; ++ring) {
    Cell low{};
    Cell high{};
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::max(at[axis] - ring, 0);
      high[axis] = std::min(at[axis] + ring, spec.counts[axis] - 1);
    }
    for (int k = low[2]; k <= high[2]; ++k) {
      for (int j = low[1]; j <= high[1]; ++j) {
        const bool side = std::max(std::abs(k - at[2]), std::abs(j - at[1])) == ring;
        for (int i = low[0]; i <= high[0]; ++i) {
          if ((side || std::abs(i - at[0]) == ring) && !cells_.blocked(i, j, k)) {
            const Box free = spec.cell_box({i, j, k});
            const Vec3 off = (free.min - p).cwiseMax(p - free.max).cwiseMax(0.0);
            minimum = std::min(minimum, off.norm());
          }
        }
      }
    }
  }
  return minimum;
}

bool CellLayer::do_blocked(const Vec3& a, const Vec3& b, double r) const {
  if (r <= 0 && a == b) {
    const Cell at = cells_.spec().cell_of(a);
    if (cells_.spec().holds(at) && !cells_.blocked(at)) {
      return false;  // it can only touch a blocked one
    }
  }
  return solid_.blocked(a, b, r) || (r <= kSeam && runs_in_a_seam(a, b));
}

/// True if the cube of twice that edge around p lies in blocked cells.
bool CellLayer::is_inside(const Vec3& p, double half_edge) const {
  const GridSpec& spec = cells_.spec();
  const Box cube = Box{p, p}.grown(half_edge);
  const Box whole = spec.box();
  if ((cube.min - whole.min).minCoeff() < 0 || (whole.max - cube.max).minCoeff() <= 0) {
    return false;
  }
  const Cell low = spec.cell_of(cube.min);
  const Cell high = spec.cell_of(cube.max);
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int i = low[0]; i <= high[0]; ++i) {
        if (!cells_.blocked(i, j, k)) {
          return false;
        }
      }
    }
  }
  return true;
}

/// True if the leg, too close to cell faces for a single box to count as entered, runs through the
/// interior of several together. A piece within one cell is tested at its ends and its midpoint, at
/// half the depth of the point test: a leg is then never free where one of its points is not.
bool CellLayer::runs_in_a_seam(const Vec3& a, const Vec3& b) const {
  if (a == b) {
    return is_inside(a, kSeam);
  }
  const GridSpec& spec = cells_.spec();
  std::vector<double> cuts{0, 1};
  for (int axis = 0; axis < 3; ++axis) {
    const double from = (a[axis] - spec.origin[axis]) / spec.cell[axis];
    const double to = (b[axis] - spec.origin[axis]) / spec.cell[axis];
    const double low = std::max(0.0, std::ceil(std::min(from, to)));
    const double high = std::min(double(spec.counts[axis]), std::floor(std::max(from, to)));
    for (double plane = low; from != to && plane <= high; ++plane) {
      cuts.push_back(std::clamp((plane - from) / (to - from), 0.0, 1.0));
    }
  }
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const double middle = (cuts[i] + cuts[std::min(i + 1, cuts.size() - 1)]) / 2;
    if (is_inside(a + cuts[i] * (b - a), kSeam / 2) || is_inside(a + middle * (b - a), kSeam / 2)) {
      return true;
    }
  }
  return false;
}

void CellLayer::do_rasterize(VoxelGrid& grid) const {
  if (grid.spec() == cells_.spec()) {
    grid.merge(cells_);
  } else {
    solid_.rasterize(grid);
  }
}

std::optional<Vec3> CellLayer::do_cell_centre(const std::array<double, 3>& cell) const {
  const GridSpec& spec = cells_.spec();
  return Vec3(spec.origin +
              spec.cell.cwiseProduct(Vec3(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5)));
}
}  // namespace altiplan::kit
