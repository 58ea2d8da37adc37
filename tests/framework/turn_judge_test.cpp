// SPDX-License-Identifier: Apache-2.0
// The judge of turns: their figures, their first direction, and loiter circles at the ends.
#include <gtest/gtest.h>

#include <limits>

#include "altiplan/check.hpp"
#include "altiplan/shape.hpp"
#include "support/support.hpp"

namespace altiplan::turn_judge_test {
namespace {

using Rules = std::vector<std::string>;

constexpr double kRadius = 80;
const Vec3 kStart{0, 0, 100};

Request open_request(const Vec3& goal, World world = {}) {
  Request request =
      testing::request_in(std::move(world), kStart, goal, {{-1e4, -1e4, 0}, {1e4, 1e4, 1e3}});
  request.limits.min_turn_radius = kRadius;
  return request;
}

Rules violated(const Route& route, const Request& request) {
  Rules rules;
  for (const Violation& violation : check(route, request).violations) {
    rules.push_back(violation.constraint + "@" + std::to_string(violation.at));
  }
  return rules;
}

Route route_along(const std::vector<Leg>& legs) {
  Route route;
  for (const Leg& leg : legs) {
    route.push_back(leg);
  }
  return route;
}

TEST(TurnJudge, TheFiguresOfATurnLeadToItsEnd) {
  const Leg turn = Leg::turning({kStart, 0}, kPi / 2, kRadius, 0);
  EXPECT_EQ(violated(route_along({turn}), open_request(turn.to)), Rules{});
  const double no_number = std::numeric_limits<double>::quiet_NaN();
  std::vector<Leg> wrong(8, turn);
  wrong[0].to.x() += 1e-5;
  wrong[1].heading += 0.01;
  wrong[2].turn = no_number;
  wrong[3].radius = no_number;
  wrong[4].heading = kInfinity;
  wrong[5].drift.x() = no_number;
  wrong[6].radius = -kRadius;
  wrong[7].drift.z() = 1;
  for (const Leg& leg : wrong) {
    EXPECT_EQ(violated(route_along({leg}), open_request(leg.to)), Rules{"route@0"});
  }
}

TEST(TurnJudge, LegsBeginWhereTheLastOneEnds) {
  const Leg turn = Leg::turning({kStart, 0}, kPi / 2, kRadius, 0);
  const Leg apart = Leg::turning({turn.to + Vec3(0, 300, 0), kPi / 2}, -kPi / 2, kRadius, 0);
  EXPECT_EQ(violated(route_along({turn, apart}), open_request(apart.to)), Rules{"route@1"});
}

TEST(TurnJudge, ATurnBeginsAlongItsTangentNotItsChord) {
  Request request = open_request({});
  request.limits.max_turn_horizontal = radians(10);
  const Leg ahead = Leg::straight(kStart, kStart + Vec3(500, 0, 0));
  const Leg turn = Leg::turning({ahead.to, 0}, kPi, kRadius, 0);
  request.goal.position = turn.to;
  EXPECT_EQ(violated(route_along({ahead, turn}), request), Rules{});
}

/// From one loiter circle to another along the straight tangent of both.
struct Loitering {
  Request request = open_request({});
  Route route;

  explicit Loitering(int sense) {
    request.start.loiter = Loiter{kRadius, sense};
    request.goal.loiter = Loiter{kRadius, sense};
    request.goal.position = kStart + Vec3(1000, 0, 0);
    const Vec3 leaves = kStart - sense * Vec3(0, kRadius, 0);
    const Leg ahead = Leg::straight(leaves, leaves + Vec3(1000, 0, 0));
    route = route_along({ahead});
  }
};

TEST(TurnJudge, LoiterCirclesAreLeftAndJoinedTangentially) {
  for (const int sense : {1, -1}) {
    Loitering flown(sense);
    EXPECT_EQ(violated(flown.route, flown.request), Rules{}) << sense;
    // The same circle flown the other way.
    flown.request.start.loiter->sense = -sense;
    EXPECT_EQ(violated(flown.route, flown.request), (Rules{"start_heading@0", "turn_radius@0"}));
    flown.request.start.loiter->sense = sense;
    flown.request.goal.loiter->sense = -sense;
    EXPECT_EQ(violated(flown.route, flown.request), Rules{"goal_heading@1"}) << sense;
    flown.request.goal.loiter = Loiter{kRadius + 1e-5, sense};
    EXPECT_EQ(violated(flown.route, flown.request), Rules{"goal@1"}) << sense;
    flown.request.goal.loiter = Loiter{kRadius, sense};
    flown.request.start.position.z() += 1e-5;
    EXPECT_EQ(violated(flown.route, flown.request), Rules{"start@0"}) << sense;
  }
}

TEST(TurnJudge, ALoiterCircleThatDoesNotFitIsNamed) {
  Loitering flown(1);
  Request& request = flown.request;
  EXPECT_EQ(start_problem(request), "");
  request.start.loiter->radius = kRadius - 1;
  EXPECT_EQ(start_problem(request),
            "circle of radius 79.00 m around (0.00, 0.00, 100.00) cannot be flown: the turn radius "
            "is 79.00 m, below the limit of 80.00 m");
  request.wind.layers = {{0, {5, 0, 0}}};
  request.vehicle.speed_mps = 20;
  EXPECT_NE(goal_problem(request).find("below the limit of 125.00 m"), std::string::npos)
      << goal_problem(request);
  request.wind.layers = {{0, {20, 0, 0}}};
  EXPECT_NE(goal_problem(request).find("as fast as the aeroplane (20.00 m/s)"), std::string::npos);
  request.wind = {};
  request.world =
      std::make_shared<World>(testing::world_of({Cylinder{1000 + kRadius, 0, 10, 0, 500}}));
  EXPECT_NE(goal_problem(request).find("clearance"), std::string::npos) << goal_problem(request);
  EXPECT_EQ(testing::make_planner("hybrid_astar")->plan(request).status,
            PlanStatus::invalid_problem);
}

TEST(TurnJudge, ABorderOfWindAtTheGoalsHeightBelongsToBothLayers) {
  const Vec3 goal(5000, 2000, 400);
  Request request = open_request(goal);
  request.vehicle.wing = Wing{20, radians(27), radians(8), radians(8)};
  request.vehicle.speed_mps = 20;
  apply_constraints(request, {}, AppliesTo::route);
  request.wind.layers = {{0, {5, 0, 0}}, {400, {0, -5, 0}}};
  request.start.velocity = request.ground_velocity({kStart, 0});
  request.goal.heading = 1;
  for (const char* planner : {"hybrid_astar", "rrt_connect"}) {
    const PlanResult result = testing::make_planner(planner)->plan(request);
    ASSERT_EQ(result.status, PlanStatus::solved) << planner << ": " << result.message;
    EXPECT_EQ(violated(result.route, request), Rules{}) << planner;
  }
}

TEST(TurnJudge, AStartOnTheWrongCourseIsNotAtTheGoal) {
  Request request = open_request(kStart);
  request.start.velocity = {20, 0, 0};
  request.goal.heading = kPi;
  const PlanResult result = testing::make_planner("hybrid_astar")->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_GT(result.route.size(), 1U);
  EXPECT_EQ(violated(result.route, request), Rules{});
}

class Plain final : public Constraint {
  bool do_admits_all() const override { return true; }
};

/// Another constraint, for short legs alone.
class ShortOnly final : public Constraint {
 public:
  explicit ShortOnly(std::shared_ptr<const Constraint> inner) : inner_(std::move(inner)) {}

 private:
  bool do_admits(const Motion& leg) const override {
    return (leg.to - leg.from).norm() < 10 && inner_->admits(leg);
  }
  std::shared_ptr<const Constraint> inner_;
};

TEST(Decorator, IsAskedThoughItsConstraintAdmitsAll) {
  Request request = open_request({1000, 0, 100});
  apply_constraints(request, {{"short", std::make_shared<ShortOnly>(std::make_shared<Plain>())}},
                    AppliesTo::route);
  EXPECT_FALSE(request.constraints[0].admits_all);
  EXPECT_FALSE(check(Polyline{kStart, request.goal.position}, request).ok());
}

TEST(TurnJudge, APlannerThatKnowsNoLoiterCirclesSaysSo) {
  const Loitering flown(1);
  const PlanResult result = testing::make_planner("theta_star")->plan(flown.request);
  EXPECT_EQ(result.status, PlanStatus::invalid_problem);
  EXPECT_NE(result.message.find("trait `loiters`"), std::string::npos) << result.message;
}
}  // namespace
}  // namespace altiplan::turn_judge_test
