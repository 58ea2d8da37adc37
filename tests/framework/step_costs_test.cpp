// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/step_costs.hpp"

#include <gtest/gtest.h>

#include "altiplan/random.hpp"
#include "support/support.hpp"

namespace altiplan::kit::step_costs_test {
namespace {

Lattice lattice_of(const Vec3& cell, const Cell& counts, Neighbourhood neighbourhood,
                   bool level = false) {
  const Vec3 size = cell.cwiseProduct(Vec3(counts[0], counts[1], counts[2]));
  Request request = testing::request_in(World(), cell / 2, cell / 2, {{0, 0, 0}, size});
  if (level) {
    request.level_m = cell.z() / 2;
  }
  return Lattice(request, cell, neighbourhood, {});
}

struct Case {
  Vec3 cell;
  bool level;
  double fine;   ///< greatest error of exact costs
  double ratio;  ///< and of ratios
};
const Case kCases[] = {{{1, 1, 1}, false, 2e-7, 5e-4},     {{0.3, 0.3, 0.3}, false, 2e-7, 5e-4},
                       {{50, 50, 50}, true, 2e-8, 6e-5},   {{7, 7, 3}, true, 2e-8, 6e-5},
                       {{50, 50, 10}, false, 1e-5, 0.013}, {{3, 4, 5}, false, 1e-5, 0.013},
                       {{3, 4, 1}, true, 1e-5, 0.013}};

TEST(StepCosts, AreAsNearToTheLengthsAsTheySay) {
  for (const Case& c : kCases) {
    for (const auto scale : {StepCosts::Scale::fine, StepCosts::Scale::ratio}) {
      const Lattice lattice = lattice_of(c.cell, {40, 30, 20}, Neighbourhood::all, c.level);
      const StepCosts costs(lattice, scale, 4000 * c.cell.maxCoeff());
      EXPECT_LE(costs.error(), scale == StepCosts::Scale::fine ? c.fine : c.ratio);
      EXPECT_GE(costs.longest_m(), 4000 * c.cell.maxCoeff());
      for (int d = 0; d < kDirections; ++d) {
        if ((lattice.steps() >> d & 1) != 0) {
          const double length = lattice.step_length(d);
          EXPECT_NEAR(costs.metres(costs[d]), length, (costs.error() + 1e-15) * length);
        }
      }
    }
  }
}

TEST(StepCosts, SayThatTheyAreUselessForWaysBeyondAllMeasure) {
  for (const Case& c : kCases) {
    const Lattice lattice = lattice_of(c.cell, {40, 30, 20}, Neighbourhood::all, c.level);
    for (const auto scale :
         {StepCosts::Scale::fine, StepCosts::Scale::finest, StepCosts::Scale::ratio}) {
      EXPECT_EQ(StepCosts(lattice, scale, 1e13).error(), kInfinity);
    }
  }
}

TEST(StepCosts, ApartIsTheCheapestWayAndFallsByNoMoreThanAStepCosts) {
  SplitMix64 random(1);
  for (const Case& c : kCases) {
    for (const auto neighbourhood : {Neighbourhood::all, Neighbourhood::faces}) {
      const Lattice lattice = lattice_of(c.cell, {90, 90, 90}, neighbourhood, c.level);
      const StepCosts costs(lattice, StepCosts::Scale::fine, 1000 * c.cell.maxCoeff());
      const auto any = [&](int most) { return int(random.integer(0, most)); };
      for (int n = 0; n < 2000; ++n) {
        const int top = c.level ? 0 : 88;
        const Cell a = {1 + any(87), 1 + any(87), c.level ? 0 : 1 + any(top - 1)};
        const Cell b = {1 + any(87), 1 + any(87), c.level ? 0 : 1 + any(top - 1)};
        const double metres = lattice.distance(a, b);
        ASSERT_NEAR(costs.metres(costs.between(a, b)), metres, 2 * costs.error() * metres + 1e-12);
        for (int d = 0; d < kDirections; ++d) {
          if ((lattice.steps() >> d & 1) == 0) {
            continue;
          }
          const Cell o = offset(d);
          const Cell next = {a[0] + o[0], a[1] + o[1], a[2] + o[2]};
          // On cubes and squares exactly; elsewhere rounding may take two units.
          const bool regular = costs.error() < 1e-6;
          ASSERT_LE(costs.between(a, b), costs[d] + costs.between(next, b) + (regular ? 0 : 2));
          const Vec3 goal = lattice.position(b);
          ASSERT_LE(costs.at_most((lattice.position(a) - goal).norm()),
                    costs[d] + costs.at_most((lattice.position(next) - goal).norm()));
        }
      }
    }
  }
}
}  // namespace
}  // namespace altiplan::kit::step_costs_test
