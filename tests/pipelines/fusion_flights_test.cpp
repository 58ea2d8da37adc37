// SPDX-License-Identifier: Apache-2.0
// The fusion of paper 002 flown over random terrains with two zones that are met in flight.
#include <gtest/gtest.h>

#include <iostream>
#include <numeric>

#include "host/config/config.hpp"
#include "host/run/pipeline.hpp"
#include "support/support.hpp"

namespace altiplan::fusion_flights_test {
namespace {

/// Length flown over length of the route.
constexpr double kLongest = 1.06;

host::RunResult flown(int seed, int peaks, const std::vector<std::string>& more = {}) {
  host::Overrides overrides;
  overrides.scenario = testing::configs() / "scenarios/fusion_random.yaml";
  overrides.set = {"scenario.environment.0.hills.count=" + std::to_string(peaks),
                   "scenario.environment.0.hills.seed=" + std::to_string(seed)};
  overrides.set.insert(overrides.set.end(), more.begin(), more.end());
  return host::run(host::load_config(testing::configs() / "pipelines/fusion_paper.yaml", overrides),
                   {});
}

struct Tally {
  int flights = 0;
  std::vector<int> longer;    ///< seeds of the flights above kLongest
  std::vector<int> no_route;  ///< seeds of the terrains that the lattice has no way over
};

/// A complete search says so too.
void expect_no_route(int seed, int peaks) {
  const host::RunResult result =
      flown(seed, peaks,
            {"steps.0.with.state=cell_and_heading", "steps.0.with.heuristic=octile",
             "steps.0.with.weight_g=0.5", "steps.0.with.weight_h=0.5"});
  EXPECT_EQ(result.status, host::RunStatus::no_route) << result.message;
}

/// Flies over the terrains; wherever there is a route the flight arrives and touches nothing.
Tally fly_over(const std::vector<int>& seeds, int peaks) {
  Tally tally;
  for (const int seed : seeds) {
    SCOPED_TRACE(std::to_string(peaks) + " peaks, seed " + std::to_string(seed));
    const host::RunResult result = flown(seed, peaks);
    if (!result.flight) {
      expect_no_route(seed, peaks);
      tally.no_route.push_back(seed);
      continue;
    }
    ++tally.flights;
    EXPECT_EQ(result.status, host::RunStatus::solved) << result.message;
    EXPECT_TRUE(result.flight->reached);
    EXPECT_EQ(result.flight->collisions, 0);
    EXPECT_TRUE(result.flight->check.ok());
    const double planned = result.steps.at(*result.accepted).measures->length_m;
    const double ratio = result.flight->measures.length_m / planned;
    if (ratio > kLongest) {
      std::cout << peaks << " peaks, seed " << seed << ": flown " << ratio << " of the route\n";
      tally.longer.push_back(seed);
    }
  }
  return tally;
}

std::vector<int> seeds(int from, int to) {
  std::vector<int> all(std::size_t(to - from));
  std::iota(all.begin(), all.end(), from);
  return all;
}

TEST(FusionFlights, ArriveNoMuchLonger) {
  EXPECT_TRUE(fly_over({1, 97, 171}, 16).longer.empty());
  EXPECT_TRUE(fly_over({6, 29}, 45).longer.empty());
}

// Ground rises beside the zone, or leaves little room below the highest altitude allowed.
TEST(FusionFlights, KeepToTheBetterSideOverGround) {
  EXPECT_TRUE(fly_over({56, 170}, 16).longer.empty());
  EXPECT_TRUE(fly_over({70, 191, 229, 233}, 45).longer.empty());
}

TEST(NightlyFusionFlights, SixteenPeaks) {
  const Tally tally = fly_over(seeds(1, 401), 16);
  EXPECT_EQ(tally.flights, 400);
  EXPECT_TRUE(tally.longer.empty());
}

TEST(NightlyFusionFlights, FortyFivePeaks) {
  const Tally tally = fly_over(seeds(1, 401), 45);
  EXPECT_EQ(tally.no_route.size(), 24U);
  EXPECT_TRUE(tally.longer.empty());
}
}  // namespace
}  // namespace altiplan::fusion_flights_test
