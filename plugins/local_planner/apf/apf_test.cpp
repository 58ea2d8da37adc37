// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/random.hpp"
#include "apf_field.hpp"
#include "apf_worlds_test.hpp"
#include "support/support.hpp"

namespace altiplan::testing::apf_test {
namespace {

constexpr double kNaturalTurn = 30;

Cylinder post(double x, double y, double radius, double ceiling = kInfinity) {
  return {x, y, radius, -kInfinity, ceiling};
}

struct Flown {
  Route route;
  PilotStep::Outcome outcome = PilotStep::Outcome::flying;
  std::string why;
  Counters counters;
  double end_s = 0;
  double min_separation = kInfinity;  ///< from the moving obstacle

  std::int64_t counter(std::string_view name) const {
    for (const Counter& counter : counters) {
      if (counter.name == name) {
        return counter.value;
      }
    }
    return -1;
  }
};

/// Flies from start to goal with the goal as target, past an optional moving sphere.
Flown flight(const Request& request, std::string_view yaml, int max_steps = 4000,
             std::optional<MovingObstacle> moving = std::nullopt) {
  const auto planner = make_local_planner("apf", yaml);
  const auto pilot = planner->begin(request);
  Flown flown;
  flown.route = {request.start.position};
  Observation seen;
  seen.state = request.start;
  seen.goal = request.goal;
  seen.local_target = request.goal.position;
  seen.world = request.world.get();
  while (flown.outcome == PilotStep::Outcome::flying && --max_steps > 0) {
    SensedObstacle sensed;
    if (moving) {
      const Sphere sphere = std::get<Sphere>(moving->at(seen.state.time_s));
      sensed = {"m", sphere.centre, sphere.radius, moving->velocity};
      seen.moving = std::span(&sensed, 1);
    }
    const PilotStep step = pilot->step(seen);
    flown.outcome = step.outcome;
    flown.why = step.why;
    if (step.outcome == PilotStep::Outcome::stuck) {
      break;
    }
    if (moving) {
      flown.min_separation =
          std::min(flown.min_separation, separation(*moving, seen.state.position, seen.state.time_s,
                                                    step.next.position, step.next.time_s));
    }
    flown.route.push_back(step.next.position);
    seen.state = step.next;
  }
  flown.counters = pilot->counters();
  flown.end_s = seen.state.time_s;
  return flown;
}

double greatest_turn_deg(const Route& route) {
  double turn = 0;
  for (std::size_t i = 1; i + 1 < route.size(); ++i) {
    turn = std::max(turn, turn_angle_in_space(route[i] - route[i - 1], route[i + 1] - route[i]));
  }
  return degrees(turn);
}

void expect_arrives(const Request& request, const Flown& flown) {
  EXPECT_EQ(flown.outcome, PilotStep::Outcome::arrived) << flown.why;
  const CheckResult verdict = check(flown.route, request);
  EXPECT_TRUE(verdict.ok()) << verdict.violations.front().message;
}

TEST(ApfField, ClampTurnsByTheLimitExactly) {
  for (int raw = 31; raw <= 179; ++raw) {
    for (double ratio = 0.1; ratio <= 10; ratio *= 1.25) {
      RandomStream random = RandomStream(7).sub("clamp", std::uint64_t(raw));
      const Vec3 in = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const Vec3 across = in.cross(Vec3(0.3, -0.2, 1)).normalized();
      const Vec3 p2(12, -5, 3);
      const Vec3 p1 = p2 - in;
      const double step2 = in.norm() * ratio;
      const Vec3 p3 =
          p2 + step2 * (in.normalized() * std::cos(radians(raw)) + across * std::sin(radians(raw)));
      const Vec3 p4 = apf::clamp_turn(p1, p2, p3, radians(kNaturalTurn));
      EXPECT_NEAR(turn_angle_in_space(p2 - p1, p4 - p2), radians(kNaturalTurn), 1e-9)
          << raw << " " << ratio;
      EXPECT_LT((p4 - p2).norm(), step2) << "the step shrinks";
      const Vec3 temp = p2 + in * ratio;
      EXPECT_NEAR(point_leg_distance(p4, temp, p3), 0, 1e-9 * step2) << "P4 is on the chord";
    }
  }
}

TEST(ApfField, ClampLeavesASmallTurn) {
  const Vec3 p3(2, 0.5, 0);
  EXPECT_EQ(apf::clamp_turn({0, 0, 0}, {1, 0, 0}, p3, radians(30)), p3);
}

TEST(Apf, RefusesWrongParameters) {
  EXPECT_NE(parameter_problems("local_planner", "apf", "{influence_m: 0}"), "");
  EXPECT_NE(parameter_problems("local_planner", "apf", "{variant: better}"), "");
  EXPECT_NE(parameter_problems("local_planner", "apf", "{influense_m: 10}"), "");
  EXPECT_EQ(parameter_problems("local_planner", "apf", "{length_unit_m: auto}"), "");
}

TEST(Apf, ArrivesAroundOneCylinder) {
  const Request request =
      problem(world_of({post(15000, 15100, 1500)}), {2000, 15000, 500}, {28000, 15000, 600});
  for (const char* yaml : {"{}", "{influence_m: 1000}", "{variant: modified}"}) {
    SCOPED_TRACE(yaml);
    expect_arrives(request, flight(request, yaml));
  }
}

TEST(Apf, ArrivesAroundSeveralWithoutATurnAboveTheLimit) {
  for (const bool plane : {false, true}) {
    Request request = problem(
        world_of({post(8000, 14800, 900), post(15000, 16300, 1100, 900), post(21000, 14000, 1300)}),
        {2000, 15000, 500}, {28000, 15500, 500});
    if (plane) {
      request.level_m = 500;
    }
    const Flown flown = flight(request, "{}");
    expect_arrives(request, flown);
    EXPECT_EQ(flown.counter("clamp_yielded"), 0);
    EXPECT_EQ(flown.counter("oscillations"), 0);
    EXPECT_LE(greatest_turn_deg(flown.route), kNaturalTurn + degrees(1e-6));
  }
}

TEST(Apf, MirroredScenesGiveMirroredFlights) {
  const auto scene = [](double sign) {
    Request request = request_in(
        world_of({post(8000, sign * 400, 900), post(15000, sign * -700, 900),
                  post(21000, sign * 900, 1300)}),
        {2000, sign * 100, 500}, {28000, sign * -200, 800}, {{0, -15e3, 0}, {30e3, 15e3, 4000}});
    request.vehicle.speed_mps = 30;
    request.limits.max_climb = radians(15);
    return flight(request, "{}").route;
  };
  const Route left = scene(1);
  const Route right = scene(-1);
  ASSERT_EQ(left.size(), right.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    EXPECT_LT((left[i] - Vec3(right[i].x(), -right[i].y(), right[i].z())).norm(), 1e-6) << i;
  }
}

TEST(Apf, IsDeterministic) {
  const Request request = problem(world_of({post(8000, 14800, 900), post(15000, 15300, 1100)}),
                                  {2000, 15000, 500}, {28000, 15500, 500});
  EXPECT_EQ(flight(request, "{}").route, flight(request, "{}").route);
}

TEST(Apf, GroundRepels) {
  Request request =
      problem(world_of(std::make_shared<Slope>()), {1000, 15000, 250}, {20000, 15000, 2300});
  request.limits.min_ground_clearance = 20;
  const Flown flown = flight(request, "{}");
  expect_arrives(request, flown);
  // The straight line descends to 50 m above ground only at the start; level flight would hit the
  // ground.
  Observation seen;
  seen.state = {0, {5000, 15000, 630}, {30, 0, 0}};
  seen.goal = request.goal;
  seen.goal.position = {20000, 15000, 630};
  seen.local_target = {6000, 15000, 630};
  seen.world = request.world.get();
  const auto planner = make_local_planner("apf");
  EXPECT_GT(planner->begin(request)->step(seen).next.position.z(), 630 + 1);
}

TEST(Apf, KeepsAwayFromWhatCrosses) {
  const Request request = problem(World(), {2000, 15000, 500}, {28000, 15000, 500});
  for (const double speed : {5.0, 15.0, 30.0}) {
    for (const double angle : {70.0, 110.0, 180.0, 250.0}) {
      // Meets the straight flight at (14000, 15100) after 400 s.
      const Vec3 velocity = speed * Vec3(std::cos(radians(angle)), std::sin(radians(angle)), 0);
      MovingObstacle moving{"m", Sphere{Vec3(14000, 15050, 500) - velocity * 400, 400}, velocity};
      const Flown flown = flight(request, "{}", 4000, moving);
      EXPECT_EQ(flown.outcome, PilotStep::Outcome::arrived)
          << flown.why << speed << " m/s at " << angle << " end " << flown.route.back().transpose();
      EXPECT_GT(flown.min_separation, 2) << speed << " m/s at " << angle;
    }
  }
}

TEST(Apf, PlainFieldReportsTheLocalMinimumOfATrap) {
  const std::vector<Shape> trap{BoxShape{{{14000, 12000, 0}, {14500, 18000, 4000}}},
                                BoxShape{{{10000, 12000, 0}, {14500, 12500, 4000}}},
                                BoxShape{{{10000, 17500, 0}, {14500, 18000, 4000}}}};
  Request request = problem(world_of(trap), {2000, 15000, 500}, {28000, 15000, 500});
  request.level_m = 500;
  const Flown flown = flight(request, "{variant: plain}");
  EXPECT_EQ(flown.outcome, PilotStep::Outcome::stuck);
  EXPECT_EQ(flown.counter("local_minima"), 1);
  EXPECT_GT(flown.counter("oscillations"), 30);
  EXPECT_NE(flown.why.find("a local minimum of the field "), std::string::npos) << flown.why;
  EXPECT_NE(flown.why.find("'shapes' ("), std::string::npos) << flown.why;
  EXPECT_GT(flown.route.back().x(), 10000);
}

TEST(Apf, SaysBetweenWhichObstaclesItIsStuck) {
  World world;
  for (const auto& [id, box] : {std::pair("north", Box{{9000, 15300, 0}, {14500, 18000, 4000}}),
                                std::pair("south", Box{{9000, 12000, 0}, {14500, 14700, 4000}}),
                                std::pair("end", Box{{14000, 12000, 0}, {14500, 18000, 4000}})}) {
    world = world.with(
        {id, "box", std::make_shared<kit::ShapeLayer>(std::vector<Shape>{BoxShape{box}}), true});
  }
  Request request = problem(std::move(world), {2000, 15000, 500}, {28000, 15000, 500});
  request.level_m = 500;
  const Flown flown = flight(request, "{variant: plain}");
  ASSERT_EQ(flown.outcome, PilotStep::Outcome::stuck);
  EXPECT_NE(flown.why.find("a local minimum of the field between '"), std::string::npos)
      << flown.why;
  EXPECT_NE(flown.why.find(" m off) and '"), std::string::npos) << flown.why;
}

TEST(Apf, SaysWhyNoHeadingIsFree) {
  const Request request =
      problem(world_of({Sphere{{2000, 15000, 500}, 40}}), {2000, 15000, 500}, {28000, 15000, 500});
  const Flown inside = flight(request, "{}");
  ASSERT_EQ(inside.outcome, PilotStep::Outcome::stuck);
  EXPECT_NE(inside.why.find("no heading is free of obstacles for one step of "), std::string::npos);
  EXPECT_NE(inside.why.find("of 360 tried, 360 come too near to 'shapes'"), std::string::npos)
      << inside.why;
}

TEST(Apf, ContinuesFromTheObservedState) {
  const Request request = problem(World(), {2000, 15000, 500}, {28000, 15000, 500});
  const auto planner = make_local_planner("apf");
  const auto pilot = planner->begin(request);
  Observation seen;
  seen.state = {0, {2000, 15000, 500}, {30, 0, 0}};
  seen.goal = request.goal;
  seen.local_target = request.goal.position;
  seen.world = request.world.get();
  pilot->step(seen);
  seen.state = {50, {2500, 15800, 500}, {30, 0, 0}};  // blown off
  const PilotStep step = pilot->step(seen);
  EXPECT_NEAR((step.next.position - seen.state.position).norm(), 30, 1e-6);
  EXPECT_NEAR(step.next.time_s, 51, 1e-9);
}

}  // namespace
}  // namespace altiplan::testing::apf_test
