// SPDX-License-Identifier: Apache-2.0
// The reference itself: Dijkstra's algorithm against all simple paths.
#include "reference/graph.hpp"

#include <gtest/gtest.h>

#include "reference/random_problem.hpp"

namespace altiplan::reference::graph_test {
namespace {

TEST(DijkstraItself, EqualsAllSimplePathsOnTinyGrids) {
  Mix mix;
  mix.max_cells = 3;
  mix.ground = false;
  int reached = 0;
  int cut_off = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    const auto problem = random_problem(seed, mix);
    const LatticeOracle oracle(problem->request, problem->scene, problem->lattice);
    const double walked = AllSimplePaths(oracle.graph, oracle.start, oracle.goal).shortest();
    const double settled = dijkstra(oracle.graph, oracle.start)[oracle.goal];
    ++(walked < kInfinity ? reached : cut_off);
    ASSERT_TRUE(walked == settled || std::abs(walked - settled) < 1e-9) << seed;
    // Turns that nothing forbids change nothing.
    const auto turning = dijkstra_with_turns(
        oracle.graph, oracle.start, [](const Reached&, std::size_t) { return true; },
        [](std::size_t, std::size_t) { return true; })[oracle.goal];
    ASSERT_TRUE(turning == settled || std::abs(turning - settled) < 1e-9) << seed;
  }
  EXPECT_GT(reached, 30);
  EXPECT_GT(cut_off, 10);
}
}  // namespace
}  // namespace altiplan::reference::graph_test
