// SPDX-License-Identifier: Apache-2.0
// Cost limits of a step: no allocations, and a bounded search for an escape.
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "apf_worlds_test.hpp"
#include "support/counted_allocations.hpp"

namespace altiplan::testing::apf_step_cost_test {
namespace {

/// One pillar in closed form: a layer whose own queries allocate nothing.
class Pillar final : public Environment {
  Cylinder shape_{5000, 15000, 500, -kInfinity, kInfinity};
  Box do_bounds() const override { return altiplan::bounds(shape_); }
  double do_clearance(const Vec3& p) const override { return signed_distance(shape_, p); }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    return leg_distance(shape_, a, b) < r - kLengthTolerance;
  }
  double do_over_approximation() const override { return 0; }
};

TEST(Apf, AllocatesNothingInAStep) {
  Request request = problem(world_of(std::make_shared<Slope>(), "slope"), {1000, 15000, 700},
                            {20000, 15000, 2300});
  request.world = std::make_shared<World>(
      request.world->with({"pillar", "pillar", std::make_shared<Pillar>(), true}));
  request.limits.min_ground_clearance = 20;
  const auto planner = make_local_planner("apf");
  const auto pilot = planner->begin(request);
  const SensedObstacle sensed{"m", {4000, 15400, 900}, 200, Vec3(5, -8, 0)};
  Observation seen;
  seen.state = request.start;
  seen.goal = request.goal;
  seen.local_target = request.goal.position;
  seen.world = request.world.get();
  seen.moving = std::span(&sensed, 1);
  allocations = 0;
  for (int i = 0; i < 300; ++i) {
    counting = true;
    const PilotStep step = pilot->step(seen);
    counting = false;
    ASSERT_EQ(step.outcome, PilotStep::Outcome::flying) << step.why;
    seen.state = step.next;
  }
  EXPECT_EQ(allocations, 0);
}

TEST(Apf, LeavesAClosingRingThroughItsGapWithoutAllocating) {
  // Ten of twelve points on a circle around the vehicle, the gap behind it and to the side.
  std::array<SensedObstacle, 10> ring;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const double angle = radians(30 * double(i) - 120);
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    ring[i] = {"m", Vec3(5000, 15000, 500) + 1200 * out, 300, Vec3(-20 * out)};
  }
  for (const bool observed : {true, false}) {
    Request request = problem(World(), {5000, 15000, 500}, {28000, 15000, 500});
    request.level_m = 500;
    const auto pilot = make_local_planner("apf", "{influence_m: 1000}")->begin(request);
    std::array<SensedObstacle, 10> now = ring;
    const std::array<std::string, 10> ids{"0", "1", "2", "3", "4", "5", "6", "7", "8", "9"};
    Observation seen;
    seen.state = {0, {5000, 15000, 500}, {30, 0, 0}};
    seen.goal = request.goal;
    seen.local_target = request.goal.position;
    seen.world = request.world.get();
    seen.moving = now;
    allocations = 0;
    for (int step = 0; step < 90; ++step) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        now[i].id = ids[i];
        now[i].position = ring[i].position + *ring[i].velocity * seen.state.time_s;
        now[i].velocity = observed ? ring[i].velocity : std::nullopt;
        ASSERT_GT((now[i].position - seen.state.position).norm(), 300 + 2) << step << observed;
      }
      counting = true;
      seen.state = pilot->step(seen).next;
      counting = false;
    }
    EXPECT_EQ(allocations, 0);
  }
}

TEST(Apf, AllocatesNothingWhereNothingEscapes) {
  std::array<SensedObstacle, 12> ring;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const double angle = radians(30 * double(i));
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    ring[i] = {"m", Vec3(5000, 15000, 500) + 1150 * out, 300, Vec3(-20 * out)};
  }
  Request request = problem(World(), {5000, 15000, 500}, {28000, 15000, 500});
  request.level_m = 500;
  const auto pilot = make_local_planner("apf", "{influence_m: 1000}")->begin(request);
  Observation seen;
  seen.state = {0, {5000, 15000, 500}, {30, 0, 0}};
  seen.goal = request.goal;
  seen.local_target = request.goal.position;
  seen.world = request.world.get();
  seen.moving = ring;
  allocations = 0;
  counting = true;
  const PilotStep step = pilot->step(seen);
  counting = false;
  EXPECT_EQ(step.outcome, PilotStep::Outcome::flying) << "it flies on while it can";
  EXPECT_EQ(allocations, 0);
}

/// An empty layer that counts its queries.
class Asked final : public Environment {
 public:
  mutable int legs = 0;

 private:
  Box do_bounds() const override { return {}; }
  double do_clearance(const Vec3&) const override { return 1e6; }
  bool do_blocked(const Vec3&, const Vec3&, double) const override {
    ++legs;
    return false;
  }
  double do_over_approximation() const override { return 0; }
};

TEST(Apf, SearchesForAWayOutInBoundedStepsAndNotTwice) {
  const auto asked = std::make_shared<Asked>();
  Request request = problem(world_of(asked, "asked"), {5000, 15000, 500}, {28000, 15000, 500});
  request.level_m = 500;
  const auto pilot = make_local_planner("apf", "{influence_m: 1000}")->begin(request);
  std::array<SensedObstacle, 16> ring;
  const std::array<std::string, 16> ids{"0", "1", "2",  "3",  "4",  "5",  "6",  "7",
                                        "8", "9", "10", "11", "12", "13", "14", "15"};
  const auto place = [&](double time, double turn) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const double angle = radians(22.5 * double(i) + turn);
      const Vec3 out(std::cos(angle), std::sin(angle), 0);
      ring[i] = {ids[i], request.start.position + (1150 - 20 * time) * out, 300, Vec3(-20 * out)};
    }
  };
  Observation seen;
  seen.state = {0, request.start.position, {30, 0, 0}};
  seen.goal = request.goal;
  seen.local_target = request.goal.position;
  seen.world = request.world.get();
  seen.moving = ring;
  const auto legs_asked = [&](double turn) {
    place(seen.state.time_s, turn);
    asked->legs = 0;
    seen.state = pilot->step(seen).next;
    return asked->legs;
  };
  constexpr int kMaxLooks = 128;  // each except the first is one leg away from another
  int maximum = 0;
  int minimum = std::numeric_limits<int>::max();
  for (int step = 0; step < 12; ++step) {
    const int legs = legs_asked(0);
    maximum = std::max(maximum, legs);
    minimum = std::min(minimum, legs);
  }
  EXPECT_LE(maximum - minimum, kMaxLooks);
  EXPECT_GT(maximum, minimum) << "it searches,";
  EXPECT_EQ(legs_asked(0), minimum) << "and no more once all searches have failed,";
  EXPECT_GT(legs_asked(10), minimum) << "until all fly otherwise";
}
}  // namespace
}  // namespace altiplan::testing::apf_step_cost_test
