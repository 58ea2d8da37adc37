// SPDX-License-Identifier: Apache-2.0
// Flights of `variant: robust` through the pilot: random maps compared with the shortest paths.
#include <gtest/gtest.h>

#include "robust_test_maps.hpp"

namespace velocity_field::robust_pilot_test {
namespace {

constexpr const char* kRobust = "{variant: robust}";
const Vec3 kFar(90000, 90000, 1000);

struct Tally {
  int flown = 0;
  int dropped = 0;
  int arrived = 0;
  int entered = 0;
  double ratios = 0;
};

void fly_map(const std::vector<Disc>& discs, double shortest, const Request& request,
             const std::string& name, Tally& tally) {
  const Flown flown = flight(request, kRobust);
  bool entered = false;
  for (std::size_t i = 1; i < flown.route.size(); ++i) {
    entered = entered || enters_one(discs, flown.route[i - 1].head<2>(), flown.route[i].head<2>());
  }
  const bool arrived = flown.outcome == PilotStep::Outcome::arrived;
  EXPECT_TRUE(arrived) << name << ": " << flown.why.back();
  EXPECT_FALSE(entered) << name;
  EXPECT_LE(uneven(flown.route, 30), 1e-6) << name;
  EXPECT_GE(min_radius(flown.route), 500 - 1e-6) << name;
  ++tally.flown;
  tally.arrived += arrived;
  tally.entered += entered;
  tally.ratios += arrived ? length(flown.route) / shortest : 0;
}

Tally fly_maps(char kind, int maps) {
  Tally tally;
  for (int n = 0; n < maps; ++n) {
    const auto threats = random_map(kind, std::uint64_t(n));
    const std::vector<Disc> discs = discs_of(threats);
    const double shortest = reference_of(discs).shortest({0, 0}, {90000, 90000});
    if (shortest == kInfinity) {
      ++tally.dropped;
      continue;
    }
    fly_map(discs, shortest, problem(world_of(threats), kFar), kind + std::to_string(n), tally);
  }
  return tally;
}

void expect_reliable(char kind, int maps) {
  const Tally tally = fly_maps(kind, maps);
  EXPECT_EQ(tally.flown + tally.dropped, maps);
  EXPECT_GT(tally.flown, maps / 2);
  EXPECT_GE(tally.arrived, 0.995 * tally.flown);
  EXPECT_EQ(tally.entered, 0);
  EXPECT_LE(tally.ratios / tally.arrived, 1.1);
  ::testing::Test::RecordProperty("dropped", tally.dropped);
  ::testing::Test::RecordProperty("mean_ratio", std::to_string(tally.ratios / tally.arrived));
}

TEST(RobustMaps, RadiiOfTable1) { expect_reliable('A', 34); }
TEST(RobustMaps, RadiiOfOneToNine) { expect_reliable('B', 33); }
TEST(RobustMaps, RadiiOfOneToFive) { expect_reliable('C', 33); }
TEST(NightlyRobustMaps, RadiiOfTable1) { expect_reliable('A', 1000); }
TEST(NightlyRobustMaps, RadiiOfOneToNine) { expect_reliable('B', 1000); }
TEST(NightlyRobustMaps, RadiiOfOneToFive) { expect_reliable('C', 1000); }

TEST(RobustPilot, FliesTable1) {
  const Request request = table1();
  const Flown flown = flight(request, kRobust);
  ASSERT_EQ(flown.outcome, PilotStep::Outcome::arrived);
  EXPECT_TRUE(check(flown.route, request).ok());
  const double shortest = reference_of(discs_of(kTable1)).shortest({0, 0}, {50000, 50000});
  EXPECT_LT(length(flown.route), 1.1 * shortest);
  EXPECT_EQ(flown.counter("guides"), 1);
  EXPECT_EQ(flown.counter("unproven_steps"), 0);
}

/// Through a gap in which no circle is free: its escape path leads to the other side.
TEST(RobustPilot, PassesNarrowGaps) {
  for (const double gap : {2.0, 20.0, 200.0, 800.0}) {
    std::vector<Cylinder> wall;
    for (int n = -3; n <= 4; ++n) {
      wall.push_back({20000, n * (10000 + gap) - 5000 - gap / 2, 5000});
    }
    const Flown flown = flight(problem(world_of(wall), {40000, 3000, 1000}), kRobust);
    ASSERT_EQ(flown.outcome, PilotStep::Outcome::arrived) << gap;
    EXPECT_LT(length(flown.route), 45e3) << gap;
    EXPECT_GT(flown.counter("way_out_steps"), 10) << gap;
    for (std::size_t i = 1; i < flown.route.size(); ++i) {
      ASSERT_FALSE(
          enters_one(discs_of(wall), flown.route[i - 1].head<2>(), flown.route[i].head<2>()))
          << gap;
    }
  }
}

TEST(RobustPilot, KeepsTheStartsCourse) {
  for (int degree = 0; degree < 360; degree += 30) {
    Request request = problem(world_of({{10000, 0, 4000}}), {20000, 1000, 1000});
    request.start.velocity = {30 * std::cos(radians(degree)), 30 * std::sin(radians(degree)), 0};
    const Flown flown = flight(request, kRobust);
    ASSERT_EQ(flown.outcome, PilotStep::Outcome::arrived) << degree;
    Polyline route = flown.route.waypoints();
    route.insert(route.begin(), request.start.position - request.start.velocity);
    EXPECT_GE(min_radius(route), 500 - 1e-6) << degree;
  }
}

TEST(RobustPilot, IsStuckWhereItCannotBegin) {
  std::vector<Cylinder> ring;
  for (int n = 0; n < 12; ++n) {
    ring.push_back({10000 * std::cos(n * kPi / 6), 10000 * std::sin(n * kPi / 6), 3000});
  }
  const Flown enclosed = flight(problem(world_of(ring), {50000, 0, 1000}), kRobust);
  EXPECT_EQ(enclosed.outcome, PilotStep::Outcome::stuck);
  EXPECT_EQ(enclosed.why.back(), "there is no path to the goal between the threats");

  Request into = problem(world_of({{3050, 0, 3000}}), {-20000, 0, 1000});
  into.start.velocity = {30, 0, 0};
  const Flown doomed = flight(into, kRobust);
  EXPECT_EQ(doomed.outcome, PilotStep::Outcome::stuck);
  EXPECT_EQ(doomed.why.back(), "no turn from the current course is known that enters no threat");

  Request above = problem(world_of({}), {20000, 0, 1200});
  EXPECT_EQ(flight(above, kRobust).outcome, PilotStep::Outcome::stuck);
  EXPECT_EQ(flight(problem(world_of({}), {20000, 0, 1000}), "{variant: robust, max_steps: 9}")
                .route.size(),
            1U + 9U);
}

/// Table 3 of the paper, at every time of the flight: a threat moves, one is added, the goal moves.
TEST(RobustPilot, Table3AtAnyTime) {
  std::vector<Cylinder> before = kTable1;
  before.push_back({22279, 34649, 8000});
  std::vector<Cylinder> after = kTable1;
  after.push_back({22218, 29398, 8000});
  after.push_back({20089, 40198, 4000});
  const World old_world = world_of(before);
  const World new_world = world_of(after);
  for (int at = 0; at < 2000; at += 100) {
    Request request = problem(old_world, {50000, 50000, 1000});
    bool changed = false;
    bool swallowed = false;
    Vec3 goal(50797, 64301, 1000);
    Vec3 last = request.start.position;
    int entered = 0;
    const Flown flown = flight(request, kRobust, 41000, [&](Observation& seen, int n) {
      entered += enters_one(discs_of(changed ? after : before), last.head<2>(),
                            seen.state.position.head<2>());
      last = seen.state.position;
      if (n == at) {
        changed = true;
        swallowed = is_inside_one(discs_of(after), last.head<2>());
        seen.world = &new_world;
        seen.goal.position = goal;
        seen.rest = std::span(&goal, 1);
      }
    });
    EXPECT_EQ(flown.outcome, PilotStep::Outcome::arrived) << at;
    EXPECT_TRUE(entered == 0 || swallowed || flown.counter("ways_out_lost") > 0) << at;
  }
}

/// Blown off by gusts it returns to the guide, or finds another.
TEST(RobustPilot, ArrivesThroughGusts) {
  RandomStream random(3);
  const Request request = table1();
  const Flown flown = flight(request, kRobust, 41000, [&](Observation& seen, int n) {
    if (n > 0 && n % 50 == 0) {
      const double size = n % 500 == 0 ? 900 : 20;
      const Vec3 gust(random.uniform(-size, size), random.uniform(-size, size), 0);
      if (seen.world->clearance(seen.state.position + gust) > 200) {
        seen.state.position += gust;
      }
    }
  });
  EXPECT_EQ(flown.outcome, PilotStep::Outcome::arrived);
  EXPECT_GT(flown.counter("guides"), 1);
}

TEST(RobustPilot, TakesShorterStepsWhereTheHostDoes) {
  const Flown flown = flight(table1(), kRobust, 200'000, [](Observation& seen, int n) {
    seen.max_dt_s = n % 400 < 200 ? 0.25 : 1;
  });
  EXPECT_EQ(flown.outcome, PilotStep::Outcome::arrived);
  EXPECT_GE(min_radius(flown.route), 400) << "between steps of two lengths the circle is another";
}
}  // namespace
}  // namespace velocity_field::robust_pilot_test
