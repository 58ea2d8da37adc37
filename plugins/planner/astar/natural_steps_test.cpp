// SPDX-License-Identifier: Apache-2.0
#include "natural_steps.hpp"

#include <gtest/gtest.h>

#include "altiplan/kit/lattice/pruning.hpp"
#include "support/support.hpp"

namespace altiplan::astar::natural_steps_test {
namespace {

TEST(NaturalSteps, AreThoseOfPruningWhereNoStepIsRuledOut) {
  const Request request =
      testing::request_in(World(), {5, 5, 5}, {60, 60, 60}, {{0, 0, 0}, {100, 100, 100}});
  for (const Vec3& cell : {Vec3(10, 10, 10), Vec3(10, 10, 2.5), Vec3(5, 5, 20), Vec3(10, 25, 7)}) {
    const kit::Lattice lattice(request, cell, kit::Neighbourhood::all, {});
    for (const kit::StepCosts::Scale scale :
         {kit::StepCosts::Scale::fine, kit::StepCosts::Scale::ratio}) {
      const NaturalSteps natural(lattice.steps(), kit::StepCosts(lattice, scale, 1000));
      for (int in = 0; in < kit::kDirections; ++in) {
        EXPECT_EQ(natural[in], kit::kNatural[std::size_t(in)] & lattice.steps())
            << cell << ' ' << in;
      }
    }
  }
}
}  // namespace
}  // namespace altiplan::astar::natural_steps_test
