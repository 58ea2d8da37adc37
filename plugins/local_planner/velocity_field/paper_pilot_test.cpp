// SPDX-License-Identifier: Apache-2.0
// Contract of a pilot and properties of the method's updates, beyond the conformance suite.
#include <gtest/gtest.h>

#include "field.hpp"
#include "reference/velocity_flights.hpp"
#include "support/counted_allocations.hpp"

namespace velocity_field::paper_pilot_test {
namespace {
using altiplan::testing::allocations;
using altiplan::testing::counting;
using altiplan::testing::make_local_planner;
using altiplan::testing::parameter_problems;

long allocated_in(const Request& request, std::string_view yaml = "{}") {
  const auto planner = make_local_planner("velocity_field", yaml);
  const auto pilot = planner->begin(request);
  const SensedObstacle sensed{"m", {3000, 3500, 1000}, 200, Vec3(5, -8, 0)};
  Observation seen = first_observation(request);
  seen.moving = std::span(&sensed, 1);
  allocations = 0;
  for (int i = 0; i < 4000; ++i) {
    counting = true;
    const PilotStep step = pilot->step(seen);
    counting = false;
    if (step.outcome != PilotStep::Outcome::flying) {
      break;
    }
    seen.state = step.next;
  }
  return allocations;
}

TEST(PaperPilot, AllocatesNothingInAStep) {
  EXPECT_EQ(allocated_in(table1()), 0);
  EXPECT_EQ(allocated_in(problem(world_of(random_map('A', 3)), {90000, 90000, 1000})), 0);
  EXPECT_EQ(allocated_in(problem(world_of(random_map('C', 3, 3000)), {90000, 90000, 1000})), 0);
}

TEST(PaperPilot, AllocatesNothingInAStepOverGround) {
  Request request = problem(World().with({"hills", "hills",
                                          altiplan::testing::make_environment(
                                              "hills",
                                              "{peaks: [{at_m: [20000, 20000], height_m: 2000, "
                                              "sigma_m: [3000, 90000]}]}")}),
                            {50000, 50000, 1000});
  request.level_m.reset();
  request.volume = {{-1e5, -1e5, 0}, {2e5, 2e5, 5000}};
  EXPECT_EQ(allocated_in(request, "{terrain: sections}"), 0);
}

/// Also through narrow gaps, where escape paths are long.
TEST(RobustPilot, AllocatesNothingInAStep) {
  EXPECT_EQ(allocated_in(table1(), "{variant: robust}"), 0);
  for (const char kind : {'A', 'B', 'C'}) {
    const Request request = problem(world_of(random_map(kind, 3)), {90000, 90000, 1000});
    EXPECT_EQ(allocated_in(request, "{variant: robust}"), 0) << kind;
  }
}

TEST(PaperPilot, StepsAndTurnsOnRandomMaps) {
  for (const char kind : {'A', 'B', 'C'}) {
    for (std::uint64_t number = 1; number <= 10; ++number) {
      const Request request = problem(world_of(random_map(kind, number)), {90000, 90000, 1000});
      const Flown flown = flight(request, "{}", 8000);
      EXPECT_NE(flown.outcome, PilotStep::Outcome::stuck);
      EXPECT_LE(uneven(flown.route, 30), 1e-6) << kind << number;
      EXPECT_GE(min_radius(flown.route), 500 - 1e-6) << kind << number;
      EXPECT_LE(flown.counter("virtual_targets_used"), flown.counter("trap_entries"));
      EXPECT_LE(flown.counter("virtual_targets_inside_threats"), flown.counter("trap_entries"));
    }
  }
}

TEST(PaperPilot, WhatIsFarDoesNotMoveIt) {
  std::vector<Cylinder> threats = kTable1;
  for (const Cylinder& far : random_map('C', 5, 2000)) {
    threats.push_back({far.x - 3e5, far.y, far.radius});
  }
  EXPECT_EQ(flight(problem(world_of(threats), {50000, 50000, 1000})).route, flight(table1()).route);
}

TEST(PaperPilot, MirroredThreatsGiveTheMirroredFlight) {
  std::vector<Cylinder> mirrored;
  for (const Cylinder& threat : kTable1) {
    mirrored.push_back({threat.y, threat.x, threat.radius});
  }
  const Flown flown = flight(problem(world_of(mirrored), {50000, 50000, 1000}));
  const Flown expected = flight(table1());
  ASSERT_EQ(flown.route.size(), expected.route.size());
  for (std::size_t i = 0; i < flown.route.size(); ++i) {
    const Vec3& p = expected.route[i];
    ASSERT_LT((flown.route[i] - Vec3(p.y(), p.x(), p.z())).norm(), 1e-3) << i;
  }
}

TEST(PaperPilot, ContinuesFromTheObservedState) {
  const Request request = table1();
  const auto pilot = make_local_planner("velocity_field")->begin(request);
  Observation seen = first_observation(request);
  for (int i = 0; i < 100; ++i) {
    seen.state = pilot->step(seen).next;
  }
  seen.state = {500, {30000, 45000, 1000}, {0, -30, 0}};  // blown off
  const PilotStep step = pilot->step(seen);
  EXPECT_NEAR((step.next.position - seen.state.position).norm(), 30, 1e-9);
  EXPECT_NEAR(step.next.time_s, 501, 1e-12);
  EXPECT_NEAR(turn_angle_in_space(seen.state.velocity, step.next.velocity), max_turn(30, 500),
              1e-9);
}

TEST(PaperPilot, FirstHeadingIsFreeWhereNoneIsGiven) {
  Request request = problem(World(), {50000, 50000, 1000});
  EXPECT_LT(
      turn_angle_in_space(flight(request, "{}", 1).route[1] - request.start.position, {1, 1, 0}),
      1e-9);
  request.start.velocity = {0, -30, 0};
  EXPECT_NEAR(turn_angle_in_space(flight(request, "{}", 1).route[1] - request.start.position,
                                  request.start.velocity),
              max_turn(30, 500), 1e-9);
}

TEST(PaperPilot, ShortStepsOfTheHostKeepTheRadius) {
  Request request = table1();
  const Flown flown =
      flight(request, "{}", 3000, [](Observation& seen, int) { seen.max_dt_s = 0.25; });
  EXPECT_LE(uneven(flown.route, 7.5), 1e-6);
  EXPECT_GE(min_radius(flown.route), 500 - 1e-6);
}

TEST(PaperPilot, LimitsOfTheRequestTighten) {
  Request request = table1();
  request.limits.min_turn_radius = 900;
  EXPECT_GE(min_radius(flight(request).route), 900 - 1e-6);
  request.limits.min_turn_radius = 100;
  EXPECT_GE(min_radius(flight(request).route), 500 - 1e-6);
  // V_min^2 / (g tan 30 degrees)
  const double radius = 50 * 50 / (9.80665 * std::tan(kPi / 6));
  const Flown banked =
      flight(table1(), "{min_turn_radius_m: auto, min_speed_mps: 50, max_bank_deg: 30}", 2000);
  EXPECT_NEAR(min_radius(banked.route), radius, 1e-3);
}

TEST(PaperPilot, ThreatsGrowByTheClearanceAskedFor) {
  Request request = table1();
  request.limits.min_clearance = 150;
  const Flown grown = flight(request);
  std::vector<Cylinder> threats = kTable1;
  for (Cylinder& threat : threats) {
    threat.radius += 150;
  }
  EXPECT_EQ(grown.route, flight(problem(world_of(threats), {50000, 50000, 1000})).route);
}

TEST(PaperPilot, GivesUpAfterMostStepsAndKeepsTheRoute) {
  const Flown flown = flight(table1(), "{max_steps: 500}");
  EXPECT_EQ(flown.outcome, PilotStep::Outcome::stuck);
  EXPECT_EQ(flown.route.size(), 501U);
  EXPECT_EQ(flown.why.back(), "max_steps steps were flown without reaching the goal");
  Request request = problem(World(), {5005, 0, 1000});  // between two steps of 30 m
  request.goal.tolerance_m = 0;
  EXPECT_EQ(flight(request, "{max_steps: 500}").why.back(),
            "max_steps steps were flown without reaching the goal; the goal's tolerance of 0 m is "
            "less than half a step, 15 m");
  EXPECT_EQ(allocated_in(request, "{max_steps: 500}"), 0);
}

TEST(PaperPilot, RefusesAGoalAtAnotherHeight) {
  Request request = problem(World(), {5000, 0, 1100});
  request.level_m.reset();
  const Flown flown = flight(request);
  EXPECT_EQ(flown.outcome, PilotStep::Outcome::stuck);
  EXPECT_NE(flown.why.back().find("height"), std::string::npos) << flown.why.back();
}

TEST(PaperPilot, ReportsAVirtualTargetInsideAThreat) {
  // As in table 1, with one more threat over the virtual target of threat 2.
  std::vector<Cylinder> threats = kTable1;
  threats.push_back({3860, 14036, 300});
  const Flown flown = flight(problem(world_of(threats), {50000, 50000, 1000}), "{}", 6000);
  EXPECT_GT(flown.counter("virtual_targets_inside_threats"), 0);
  EXPECT_TRUE(std::any_of(flown.why.begin(), flown.why.end(), [](const std::string& why) {
    return why ==
           "follows the field to the virtual target of threat 2, which lies inside another "
           "threat";
  }));
}

TEST(PaperPilot, MovingObstaclesPushWhereTheyAre) {
  const Request request = problem(World(), {50000, 50000, 1000});
  const SensedObstacle sensed{"m", {1500, 1000, 1000}, 300, std::nullopt};
  const Flown flown = flight(request, "{}", 300,
                             [&](Observation& seen, int) { seen.moving = std::span(&sensed, 1); });
  const Flown around =
      flight(problem(world_of({{1500, 1000, 300}}), {50000, 50000, 1000}), "{}", 300);
  EXPECT_EQ(flown.route, around.route);
  EXPECT_NE(flown.route, flight(request, "{}", 300).route);
}

TEST(PaperPilot, TowardTheRoute) {
  const Request request = problem(World(), {50000, 50000, 1000});
  const auto east = [](Observation& seen, int) {
    seen.local_target = seen.state.position + Vec3(5000, 0, 0);
  };
  EXPECT_LT(std::abs(flight(request, "{toward: route}", 10, east).route.back().y()), 1e-9);
  EXPECT_GT(flight(request, "{}", 10, east).route.back().y(), 200);
}

/// A third party's layer with a configurable threat.
class Odd final : public Environment {
 public:
  explicit Odd(const Threat& threat) { info_.threats = {threat}; }

 private:
  Box do_bounds() const override { return Box::empty(); }
  double do_clearance(const Vec3&) const override { return kInfinity; }
  const LayerInfo& do_info() const override { return info_; }
  LayerInfo info_;
};

TEST(PaperPilot, NamesAThreatThatIsNoDisc) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Threat& odd : {Threat{{nan, 0, 0}, 1, "", "odd"}, Threat{{0, 0, 0}, -1, "", "odd"},
                            Threat{{0, 0, 0}, kInfinity, "", "odd"}}) {
    const Request request =
        problem(altiplan::testing::world_of(std::make_shared<Odd>(odd)), {5000, 0, 1000});
    try {
      make_local_planner("velocity_field")->begin(request);
      FAIL() << "a threat of radius " << odd.radius << " is taken";
    } catch (const std::exception& error) {
      EXPECT_NE(std::string(error.what()).find("'odd' is not a disc"), std::string::npos);
    }
  }
}

TEST(PaperPilot, RefusesWrongParameters) {
  const auto problems = [](std::string_view yaml) {
    return parameter_problems("local_planner", "velocity_field", yaml);
  };
  for (const char* wrong : {"{pull_weight: -1}",
                            "{guide_ratio: -0.1}",
                            "{edge_ratio: 0}",
                            "{surface_ratio: 0}",
                            "{edge_ratio: 10}",
                            "{ring_m: 0}",
                            "{step_s: 0}",
                            "{release_m: 0}",
                            "{max_steps: 0}",
                            "{min_turn_radius_m: 0}",
                            "{min_turn_radius_m: auto}",
                            "{max_bank_deg: 30}",
                            "{min_turn_radius_m: auto, max_bank_deg: 30}",
                            "{variant: best}",
                            "{toward: north}",
                            "{min_speed_mps: 25, max_bank_deg: 30}",
                            "{terrain: hills}",
                            "{max_climb_deg: 0}",
                            "{detour_m: 0}",
                            "{section_cell_m: 0}",
                            "{ring: 2000}",
                            "{pull_weight: .nan}"}) {
    EXPECT_NE(problems(wrong), "") << wrong;
  }
  for (const char* right : {"{}", "{pull_weight: 0}", "{guide_ratio: 0}",
                            "{min_turn_radius_m: auto, min_speed_mps: 25, max_bank_deg: 30}"}) {
    EXPECT_EQ(problems(right), "") << right;
  }
}
}  // namespace
}  // namespace velocity_field::paper_pilot_test
