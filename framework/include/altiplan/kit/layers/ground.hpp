// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "altiplan/voxel_grid.hpp"

/// \file Common parts of layers with ground, given two functions: height(x, y) and
/// highest(x0, y0, x1, y1), an upper bound of the heights in a closed box, +infinity where part
/// of it has no ground.
namespace altiplan::kit {

/// Half width and half depth of the footprint in which a column's highest ground is queried: the
/// column (rule touched) or its centre alone (rule centre), grown by the inflation.
inline std::array<double, 2> half_footprint(const GridSpec& spec) {
  const double share = spec.rule == GridSpec::Rule::centre ? 0 : 0.5;
  return {share * spec.cell.x() + spec.inflation, share * spec.cell.y() + spec.inflation};
}

/// Blocks each column (i, j) of cells up to top(i, j), the highest ground in its footprint, grown
/// by the inflation.
template <class Top>
void block_below(VoxelGrid& grid, const Top& column_top) {
  const GridSpec& spec = grid.spec();
  const bool centre = spec.rule == GridSpec::Rule::centre;
  std::vector<int> blocked_levels(std::size_t(spec.counts[0]));
  for (int j = 0; j < spec.counts[1]; ++j) {
    grid.ask_watch();
    int maximum = 0;
    for (int i = 0; i < spec.counts[0]; ++i) {
      const double top = column_top(i, j) + spec.inflation;
      const double levels = (top - spec.origin.z()) / spec.cell.z();
      // Touched: the open cell lies partly below the top; centre: its centre lies at or below the
      // top.
      const double count = centre ? std::floor(levels - 0.5) + 1 : std::ceil(levels);
      blocked_levels[std::size_t(i)] = int(std::clamp(count, 0.0, double(spec.counts[2])));
      maximum = std::max(maximum, blocked_levels[std::size_t(i)]);
    }
    for (int k = 0; k < maximum; ++k) {
      for (int i = 0; i < spec.counts[0]; ++i) {
        const int first = i;
        while (i < spec.counts[0] && blocked_levels[std::size_t(i)] > k) {
          ++i;
        }
        if (i > first) {
          grid.block_run(first, i - 1, j, k);
        }
      }
    }
  }
}

/// The same, calling highest for each column.
template <class Highest>
void rasterize_ground(VoxelGrid& grid, const Highest& highest) {
  const auto [half_x, half_y] = half_footprint(grid.spec());
  block_below(grid, [&, x = half_x, y = half_y](int i, int j) {
    const Vec3 c = grid.spec().centre({i, j, 0});
    return highest(c.x() - x, c.y() - y, c.x() + x, c.y() + y);
  });
}

/// Height above the ground that guarantees a distance from it, where its slope is at most `slope`.
inline double height_for(double distance, double slope) {
  return distance > 0 ? distance * std::hypot(1, slope) : distance;
}

/// The part of the leg below the height; none where the whole leg is at least that high.
inline std::optional<std::pair<Vec3, Vec3>> part_below(const Vec3& a, const Vec3& b, double z) {
  if (std::min(a.z(), b.z()) >= z) {
    return std::nullopt;
  }
  if (std::max(a.z(), b.z()) <= z) {
    return std::pair(a, b);
  }
  const Vec3 at = a + (z - a.z()) / (b.z() - a.z()) * (b - a);
  return a.z() < z ? std::pair(a, at) : std::pair(at, b);
}

/// Bounds of a whole ground: no part is higher than `top`, and a height of `enough` above it is
/// sufficient everywhere.
struct GroundBounds {
  double top;
  double enough;
};

/// True if the ground is nearer to the leg than r - 1e-6 m. The leg is halved, down to parts of
/// `shortest` metres, as long as the slope near a part leaves that undecided; everything r above
/// the top is free. gap(a, b, enough): as Ground::gap; slope(a, b, r): at
/// least the maximum within r of the leg, and no less than for any part of it; meets(a, b, keep):
/// true if the ground is nearer than that to a part which is at least so high above it.
template <class Gap, class Slope, class Meets>
bool too_near_ground(const Vec3& a, const Vec3& b, double r, const GroundBounds& ground,
                     double shortest, const Gap& gap, const Slope& slope, const Meets& meets) {
  const double keep = r - kLengthTolerance;
  const auto low = part_below(a, b, ground.top + keep);
  const double height = low ? gap(low->first, low->second, ground.enough) : ground.enough;
  if (height >= ground.enough) {
    return false;
  }
  const double need = height_for(keep, slope(a, b, r));
  if (height >= need) {
    return false;
  }
  if (height < keep) {
    return true;
  }
  if (std::hypot(b.x() - a.x(), b.y() - a.y()) <= std::max(r, shortest)) {
    return meets(a, b, keep);
  }
  const Vec3 middle = (a + b) / 2;
  const GroundBounds minimum{ground.top, std::min(ground.enough, need)};
  return too_near_ground(a, middle, r, minimum, shortest, gap, slope, meets) ||
         too_near_ground(middle, b, r, minimum, shortest, gap, slope, meets);
}

/// Minimum distance between the ground and a leg above it, if below `minimum`, with the callbacks
/// of too_near_ground; nearest(a, b, minimum): the same for a part no longer than `shortest`.
template <class Gap, class Slope, class Nearest>
double ground_distance(const Vec3& a, const Vec3& b, double minimum, double top, double shortest,
                       const Gap& gap, const Slope& slope, const Nearest& nearest) {
  if (std::min(a.z(), b.z()) - top >= minimum) {
    return minimum;
  }
  const double height = std::max(gap(a, b), 0.0);
  minimum = std::min(minimum, height);  // the ground vertically below
  if (height >= height_for(minimum, slope(a, b, minimum))) {
    return minimum;
  }
  if (std::hypot(b.x() - a.x(), b.y() - a.y()) <= std::max(minimum, shortest)) {
    return nearest(a, b, minimum);
  }
  const Vec3 middle = (a + b) / 2;
  minimum = ground_distance(a, middle, minimum, top, shortest, gap, slope, nearest);
  return ground_distance(middle, b, minimum, top, shortest, gap, slope, nearest);
}

/// A ground point within `over` (horizontally) whose distance from p is minimal to within 5 %, and
/// a local minimum to within 0.1 %. p must lie more than 1e-6 m above the ground, or above the
/// ground at the nearest position within `over`.
template <class Height, class Highest>
class NearestGround {
 public:
  NearestGround(const Vec3& p, const Box& over, const Height& height, const Highest& highest)
      : p_(p), over_(over), height_(height), highest_(highest) {
    const Vec3 nearest = p.cwiseMax(over.min).cwiseMin(over.max);
    try_at(nearest.x(), nearest.y());
    const double reach = best_;
    const Box box = Box{p, p}.grown(reach).intersected(over);
    search(box.min.x(), box.min.y(), box.max.x(), box.max.y());
    refine();
  }
  const Vec3& point() const { return point_; }
  double distance() const { return best_; }

 private:
  static constexpr double kPrune = 0.95;
  static constexpr double kSmallest = 0.02;  ///< of the distance: smaller ones are not split
  static constexpr double kFine = 1e-4;

  bool try_at(double x, double y) {
    const Vec3 q(x, y, height_(x, y));
    const double distance = (p_ - q).norm();
    if (!(distance < best_)) {
      return false;
    }
    best_ = distance;
    point_ = q;
    return true;
  }

  void search(double x0, double y0, double x1, double y1) {
    const double dx = std::max({x0 - p_.x(), p_.x() - x1, 0.0});
    const double dy = std::max({y0 - p_.y(), p_.y() - y1, 0.0});
    if (std::hypot(dx, dy) >= kPrune * best_) {
      return;
    }
    const double dz = std::max(p_.z() - highest_(x0, y0, x1, y1), 0.0);
    if (std::hypot(dx, dy, dz) >= kPrune * best_) {
      return;
    }
    const double x = (x0 + x1) / 2;
    const double y = (y0 + y1) / 2;
    try_at(x, y);
    if (std::max(x1 - x0, y1 - y0) < kSmallest * best_) {
      return;
    }
    // The quarter towards p first: the best so far prunes the others.
    const bool east = p_.x() >= x;
    const bool north = p_.y() >= y;
    for (const bool to_east : {east, !east}) {
      for (const bool to_north : {north, !north}) {
        search(to_east ? x : x0, to_north ? y : y0, to_east ? x1 : x, to_north ? y1 : y);
      }
    }
  }

  void refine() {
    double step = kSmallest * best_;
    while (step > kFine * best_) {
      const Vec3 from = point_;
      bool better = false;
      for (const double side : {-step, step}) {
        better |= try_at(std::clamp(from.x() + side, over_.min.x(), over_.max.x()), from.y());
        better |= try_at(from.x(), std::clamp(from.y() + side, over_.min.y(), over_.max.y()));
      }
      step = better ? step : step / 2;
    }
  }

  Vec3 p_;
  Box over_;
  const Height& height_;
  const Highest& highest_;
  double best_ = kInfinity;
  Vec3 point_{0, 0, 0};
};
}  // namespace altiplan::kit
