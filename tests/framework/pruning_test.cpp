// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/pruning.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/support.hpp"

namespace altiplan::kit::pruning_test {
namespace {

/// The 27 cells at and around one, some of them blocked.
class Around {
 public:
  Around(DirectionMask blocked, CornerRule rule, const Vec3& edges = Vec3::Ones())
      : blocked_(blocked), rule_(rule), edges_(edges) {}

  bool is_free(const Cell& c) const { return (blocked_ >> direction(c[0], c[1], c[2]) & 1) == 0; }
  /// Length of the step between two of the cells, by the definition of the rule; infinite where it
  /// is none, or not free.
  double step(const Cell& a, const Cell& b) const {
    double squared = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (std::abs(a[axis] - b[axis]) > 1) {
        return kInfinity;
      }
      squared += a[axis] != b[axis] ? edges_[Eigen::Index(axis)] * edges_[Eigen::Index(axis)] : 0;
    }
    for (int corner = 0; corner < 8; ++corner) {
      const Cell c = {corner & 1 ? a[0] : b[0], corner & 2 ? a[1] : b[1], corner & 4 ? a[2] : b[2]};
      if ((rule_ == CornerRule::free_box || c == a || c == b) && !is_free(c)) {
        return kInfinity;
      }
    }
    return squared > 0 ? std::sqrt(squared) : kInfinity;
  }

  /// Whether from the cell before, at -in, another way than over the middle reaches `out` sooner,
  /// or as soon with the longer step first (`by_number`: with one along fewer axes last, or along
  /// as many and of a smaller number).
  bool is_reached_otherwise(const Cell& in, const Cell& out, bool by_number = false) const {
    const Cell from = {-in[0], -in[1], -in[2]};
    const Cell middle = {0, 0, 0};
    const double first = step(from, middle);
    const double way = first + step(middle, out);
    if (from == out || step(from, out) < way) {
      return true;
    }
    for (int d = 0; d < kDirections; ++d) {
      const Cell over = offset(d);
      const double other = step(from, over) + step(over, out);
      const Cell last = {out[0] - over[0], out[1] - over[1], out[2] - over[2]};
      const bool is_earlier = by_number
                                  ? std::pair(axes(last), direction(last[0], last[1], last[2])) <
                                        std::pair(axes(out), direction(out[0], out[1], out[2]))
                                  : step(from, over) > first + 1e-9;
      if (over != middle && (other < way - 1e-9 || (other < way + 1e-9 && is_earlier))) {
        return true;
      }
    }
    return false;
  }

 private:
  static int axes(const Cell& o) { return (o[0] != 0) + (o[1] != 0) + (o[2] != 0); }

  DirectionMask blocked_;
  CornerRule rule_;
  Vec3 edges_;
};

TEST(Pruning, OnALevelKeepsWhatNoOtherWayReaches) {
  constexpr int kFirst = direction(-1, -1, 0);
  for (const CornerRule rule : {CornerRule::any, CornerRule::free_box}) {
    for (DirectionMask cells = 0; cells < 512; ++cells) {
      const DirectionMask blocked = cells << kFirst;
      const Around around(blocked, rule);
      for (int in = kFirst; in < kFirst + 9; ++in) {
        const Cell before = offset(opposite(in));
        if (in == kHere || around.step(before, {0, 0, 0}) == kInfinity) {
          continue;  // nothing comes from there
        }
        DirectionMask expected = 0;
        for (int out = kFirst; out < kFirst + 9; ++out) {
          const bool kept = around.step({0, 0, 0}, offset(out)) < kInfinity &&
                            !around.is_reached_otherwise(offset(in), offset(out));
          expected |= DirectionMask(kept) << out;
        }
        const DirectionMask kept = LevelSuccessors::of(rule)(blocked, in);
        ASSERT_EQ(kept, expected) << "rule " << int(rule) << ", blocked " << cells << ", in " << in;
      }
      EXPECT_EQ(LevelSuccessors::of(rule)(blocked, kHere),
                free_steps(blocked, rule) & (DirectionMask{511} << kFirst));
    }
  }
}

TEST(Pruning, InSpaceKeepsWhatNoOtherWayReachesWhereAllIsFree) {
  const Around around(0, CornerRule::free_box);
  for (int in = 0; in < kDirections; ++in) {
    for (int out = 0; out < kDirections; ++out) {
      const bool kept =
          in == kHere || out == kHere || !around.is_reached_otherwise(offset(in), offset(out));
      EXPECT_EQ(kNatural[std::size_t(in)] >> out & 1, unsigned(kept)) << in << " " << out;
    }
  }
}

TEST(Pruning, InSpaceKeepsWhatNoOtherWayReachesAmongBlockedCells) {
  RandomStream random(7);
  int all_kept = 0;
  int all_needed = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const CornerRule rule = trial % 2 == 0 ? CornerRule::any : CornerRule::free_box;
    DirectionMask blocked = 0;
    const double share = random.uniform(0, 0.6);
    for (int d = 0; d < kDirections; ++d) {
      blocked |= DirectionMask(d != kHere && random.uniform() < share) << d;
    }
    const bool are_cubes = trial % 4 < 2;
    const Vec3 edges =
        are_cubes ? Vec3::Ones() : Vec3(random.in({Vec3::Constant(0.1), Vec3::Ones()}));
    const Around around(blocked, rule, edges);
    const DirectionMask free = free_steps(blocked, rule);
    for (int in = 0; in < kDirections; ++in) {
      if (in == kHere || around.step(offset(opposite(in)), {0, 0, 0}) == kInfinity) {
        continue;
      }
      const DirectionMask kept = SpaceSuccessors::of(rule)(free, blocked, in);
      for (int out = 0; out < kDirections; ++out) {
        const bool is_needed = around.step({0, 0, 0}, offset(out)) < kInfinity &&
                               !around.is_reached_otherwise(offset(in), offset(out), true);
        const bool is_kept = (kept >> out & 1) != 0;
        ASSERT_GE(is_kept, is_needed)
            << "rule " << int(rule) << ", blocked " << blocked << ", in " << in << ", out " << out;
        all_kept += is_kept && are_cubes;
        all_needed += is_needed && are_cubes;
      }
    }
  }
  // Ways whose lengths are equal only because the cells are cubes do not count.
  EXPECT_LT(all_kept, 1.1 * all_needed);
}
}  // namespace
}  // namespace altiplan::kit::pruning_test
