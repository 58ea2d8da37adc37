// SPDX-License-Identifier: Apache-2.0
// Flights of `variant: robust` from starts beside threats, and to goals that are difficult to end
// at.
#include <gtest/gtest.h>

#include "altiplan/random.hpp"
#include "robust_test_maps.hpp"

namespace velocity_field::robust_starts_test {
namespace {

constexpr const char* kRobust = "{variant: robust}";

bool enters(const std::vector<Cylinder>& threats, const Route& route) {
  const std::vector<Disc> discs = discs_of(threats);
  for (std::size_t i = 1; i < route.size(); ++i) {
    if (enters_one(discs, route[i - 1].head<2>(), route[i].head<2>())) {
      return true;
    }
  }
  return false;
}

void expect_sound(const std::vector<Cylinder>& threats, const Request& request,
                  const std::string& with = kRobust) {
  const Flown flown = flight(request, with);
  EXPECT_EQ(flown.outcome, PilotStep::Outcome::arrived) << with << ": " << flown.why.back();
  EXPECT_FALSE(enters(threats, flown.route)) << with;
  EXPECT_EQ(flown.counter("unproven_steps"), 0) << with;
}

TEST(RobustStart, TakesACourseThatHasAWayOut) {
  const std::vector<Cylinder> beside{{-56, -36, 55}, {828, -151, 603}};
  expect_sound(beside, problem(world_of(beside), {-1767, -4677, 1000}));
  const std::vector<Cylinder> cleft{{0, 0, 2556.30255}, {6216.47836, 0, 3618.20005}};
  Request request = problem(world_of(cleft), {4271.47653, 3058.76629, 1000});
  request.start.position = {2515.55095, -542.579239, 1000};
  expect_sound(cleft, request);
}

/// A course is taken, or the first step reports that none is known; nothing is tried blindly.
TEST(RobustStart, AmongSmallThreatsNothingIsEntered) {
  int arrived = 0;
  int stuck = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    RandomStream random(seed);
    std::vector<Cylinder> threats;
    while (threats.size() < 9) {
      const double distance = random.uniform(30, 900);
      const double angle = random.uniform(0, 2 * kPi);
      const double radius = random.uniform(0, 1) * distance;
      threats.push_back({distance * std::cos(angle), distance * std::sin(angle), radius});
    }
    const Flown flown = flight(problem(world_of(threats), {20000, 0, 1000}), kRobust, 3000);
    EXPECT_FALSE(enters(threats, flown.route)) << seed;
    EXPECT_EQ(flown.counter("unproven_steps"), 0) << seed;
    arrived += flown.outcome == PilotStep::Outcome::arrived;
    stuck += flown.outcome == PilotStep::Outcome::stuck;
  }
  EXPECT_GT(arrived, 40);
  EXPECT_GT(stuck, 5);
}

TEST(RobustStart, OnAnEdgeIsRefused) {
  const std::vector<Cylinder> touching{{1000, 0, 1000}};
  const Flown flown = flight(problem(world_of(touching), {20000, 0, 1000}), kRobust);
  EXPECT_EQ(flown.outcome, PilotStep::Outcome::stuck);
  EXPECT_EQ(flown.why.back(), "no course from here is known that enters no threat");
}

/// The goal's tolerance is a ball, from which the flight's level cuts a smaller disc.
TEST(RobustGoal, InACleftAtAnotherHeight) {
  const std::vector<Cylinder> cleft{{0, 0, 5000}, {7500, 0, 2500}};
  Request request = problem(world_of(cleft), {4990, 1600, 1014});
  request.start.position = {5000, 20000, 1000};
  request.level_m.reset();
  expect_sound(cleft, request);
}

TEST(RobustGoal, IsReachedWithTurnsShorterThanAStep) {
  const std::vector<Cylinder> threats{{10000, 500, 3000}};
  for (const int radius : {1, 15, 21, 25, 30, 40}) {
    const Request request = problem(world_of(threats), {20000, 0, 1000});
    const std::string with = "{variant: robust, min_turn_radius_m: " + std::to_string(radius) + "}";
    expect_sound(threats, request, with);
    EXPECT_LT(length(flight(request, with).route), 21000) << radius;
  }
}

/// The host's step applies, from the first guide on.
TEST(RobustGoal, TheHostsStepIsTheStep) {
  const std::vector<Cylinder> threats{{10000, 500, 3000}};
  const Request request = problem(world_of(threats), {20000, 0, 1000});
  EXPECT_EQ(flight(request, "{variant: robust, step_s: 1000}").route,
            flight(request, kRobust).route);
}

TEST(RobustGoal, ATimeThatIsOverEndsTheSearch) {
  Request request = problem(world_of(random_map('A', 3, 3000)), {90000, 90000, 1000});
  request.budget.deadline = Budget::Clock::now();
  const Flown flown = flight(request, kRobust);
  EXPECT_EQ(flown.outcome, PilotStep::Outcome::stuck);
}
}  // namespace
}  // namespace velocity_field::robust_starts_test
