// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <queue>
#include <vector>

#include "altiplan/height_field.hpp"
#include "reference/separation.hpp"

// The gap between a convex set and the ground below bilinear patches, between bounds: the ground
// below a patch lies within the hull of its corners, carried down, and contains that hull lowered
// by a quarter of the patch's twist, which a quarter of the patch has a quarter of.
namespace altiplan::oracle {

struct Range {
  Vector min;
  Vector max;
};

inline Range range(const Convex& set) {
  Range all{set.points.front(), set.points.front()};
  for (const Vector& p : set.points) {
    all = {all.min.cwiseMin(p), all.max.cwiseMax(p)};
  }
  const Vector out(set.disc + set.ball, set.disc + set.ball, set.ball);
  return {all.min - out, all.max + out};
}

/// No more than the distance of what they contain.
inline Real between(const Range& a, const Range& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(Vector(0, 0, 0)).norm();
}

/// The gap to the union of two sets.
inline Gap nearer(const Gap& a, const Gap& b) {
  Gap gap = a.high <= b.high ? a : b;
  // What nothing is known of has no direction either.
  const Gap& lower = a.high == std::numeric_limits<Real>::infinity()   ? b
                     : b.high == std::numeric_limits<Real>::infinity() ? a
                     : a.low <= b.low                                  ? a
                                                                       : b;
  gap.low = lower.low;
  gap.direction = lower.direction;
  return gap;
}

struct GroundPatch {
  std::array<Real, 2> min{};
  std::array<Real, 2> max{};
  std::array<Real, 4> tops{};  ///< sw, se, nw, ne
  Gap gap{};                   ///< to what contains the ground below

  Real twist() const { return std::abs(tops[0] + tops[3] - tops[1] - tops[2]) / 4; }

  Convex below(Real lowered, Real floor) const {
    Convex set;
    for (std::size_t n = 0; n < 4; ++n) {
      const Real x = n % 2 == 0 ? min[0] : max[0];
      const Real y = n < 2 ? min[1] : max[1];
      set.points.emplace_back(x, y, tops[n] - lowered);
      set.points.emplace_back(x, y, std::min(floor, tops[n] - lowered - 1));
    }
    return set;
  }

  std::array<GroundPatch, 4> quarters() const {
    const std::array<Real, 2> mid{(min[0] + max[0]) / 2, (min[1] + max[1]) / 2};
    const Real south = (tops[0] + tops[1]) / 2;
    const Real north = (tops[2] + tops[3]) / 2;
    const Real west = (tops[0] + tops[2]) / 2;
    const Real east = (tops[1] + tops[3]) / 2;
    const Real middle = (south + north) / 2;
    return {GroundPatch{min, mid, {tops[0], south, west, middle}},
            GroundPatch{{mid[0], min[1]}, {max[0], mid[1]}, {south, tops[1], middle, east}},
            GroundPatch{{min[0], mid[1]}, {mid[0], max[1]}, {west, middle, tops[2], north}},
            GroundPatch{mid, max, {middle, east, north, tops[3]}}};
  }
};

inline Gap ground_gap(const Convex& set, const HeightField& field) {
  constexpr Real kEnough = 1e-7L;    // metres
  constexpr Real kTouching = 1e-9L;  // more than what separation() leaves of no gap
  const Range own = range(set);
  const auto further = [](const GroundPatch& a, const GroundPatch& b) {
    return a.gap.low > b.gap.low;
  };
  std::priority_queue<GroundPatch, std::vector<GroundPatch>, decltype(further)> open(further);
  Real high = std::numeric_limits<Real>::infinity();
  const auto examine = [&](GroundPatch patch) {
    const Real floor = own.min.z() - 1;
    const Convex around = patch.below(0, floor);
    if (between(own, range(around)) < high) {
      patch.gap = separation(set, around);
      high = std::min(high, separation(set, patch.below(patch.twist(), floor)).high);
      open.push(patch);
    }
  };
  for (int j = 0; j + 1 < field.rows(); ++j) {
    for (int i = 0; i + 1 < field.columns(); ++i) {
      const std::array<Real, 2> low{field.origin()[0] + Real(i) * field.spacing()[0],
                                    field.origin()[1] + Real(j) * field.spacing()[1]};
      examine({low,
               {low[0] + field.spacing()[0], low[1] + field.spacing()[1]},
               {field.post(i, j), field.post(i + 1, j), field.post(i, j + 1),
                field.post(i + 1, j + 1)}});
    }
  }
  // The set shares a point with the ground if it does with what the ground contains.
  Gap gap = open.top().gap;
  while (!open.empty() && high > kTouching && open.top().gap.low < high - kEnough) {
    const GroundPatch patch = open.top();
    gap = patch.gap;
    if (patch.twist() <= kEnough) {
      break;
    }
    open.pop();
    for (const GroundPatch& quarter : patch.quarters()) {
      examine(quarter);
    }
  }
  gap.high = high;
  return gap;
}
}  // namespace altiplan::oracle
