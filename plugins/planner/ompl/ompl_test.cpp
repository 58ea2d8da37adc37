// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>
#include <thread>

#include "support/support.hpp"

namespace altiplan::ompl_test {
namespace {

using testing::make_planner;
using testing::parameter_problems;

const std::vector<std::string> kPlanners = {
    "ABITstar", "AITstar",    "BFMT",     "BITstar",         "BKPIECE1",  "BiEST",    "BiTRRT",
    "EST",      "FMT",        "KPIECE1",  "InformedRRTstar", "LBKPIECE1", "LazyPRM",  "LazyRRT",
    "PDST",     "PRM",        "PRMstar",  "ProjEST",         "RRT",       "RRTstar",  "RRTConnect",
    "SBL",      "RRTXstatic", "RRTsharp", "STRIDE",          "TRRT",      "SORRTstar"};

/// A wall with a window in it.
Request through_a_window() {
  const std::vector<Shape> wall = {
      BoxShape{{{480, 0, 0}, {520, 400, 400}}}, BoxShape{{{480, 700, 0}, {520, 1000, 400}}},
      BoxShape{{{480, 0, 0}, {520, 1000, 100}}}, BoxShape{{{480, 0, 300}, {520, 1000, 400}}}};
  Request request = testing::request_in(testing::world_of(wall), {100, 100, 50}, {900, 900, 350},
                                        {{0, 0, 0}, {1000, 1000, 400}});
  request.limits.min_clearance = request.vehicle.radius_m = 5;
  request.random = RandomStream(7);
  return request;
}

std::string with(const std::string& planner, int iterations) {
  return "{planner: " + planner + ", max_iterations: " + std::to_string(iterations) + "}";
}

class Ompl : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Each, Ompl, ::testing::ValuesIn(kPlanners));

TEST_P(Ompl, FindsTheWindow) {
  const Request request = through_a_window();
  const PlanResult result = make_planner("ompl", with(GetParam(), 20'000))->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_FALSE(result.budget_hit);
}

TEST_P(Ompl, FliesOnALevel) {
  Request request = through_a_window();
  request.level_m = request.start.position.z() = request.goal.position.z() = 200;
  const PlanResult result = make_planner("ompl", with(GetParam(), 20'000))->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_TRUE(check(result.route, request).ok());
}

TEST_P(Ompl, GivesTheSameAnswerAgain) {
  const Request request = through_a_window();
  const PlanResult first = make_planner("ompl", with(GetParam(), 3000))->plan(request);
  const PlanResult again = make_planner("ompl", with(GetParam(), 3000))->plan(request);
  EXPECT_EQ(first.route, again.route);
  EXPECT_EQ(first.message, again.message);
}

TEST_P(Ompl, KeepsTheBudget) {
  Request request = through_a_window();
  for (const std::uint64_t maximum : {0, 1, 40, 400}) {
    request.budget.max_iterations = maximum;
    const PlanResult result = make_planner("ompl", with(GetParam(), 20'000))->plan(request);
    ASSERT_FALSE(result.counters.empty());
    EXPECT_LE(std::uint64_t(result.counters[0].value), maximum);
    EXPECT_TRUE(result.status != PlanStatus::solved || check(result.route, request).ok());
    EXPECT_TRUE(maximum > 0 || result.status == PlanStatus::timed_out) << result.message;
  }
}

TEST(OmplPlugin, SaysNothingOnTheConsole) {
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  for (const std::string& planner : kPlanners) {
    make_planner("ompl", with(planner, 500))->plan(through_a_window());
  }
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(OmplPlugin, TheSeedDecides) {
  Request request = through_a_window();
  const auto planner = make_planner("ompl");
  const Route first = planner->plan(request).route;
  request.random = RandomStream(8);
  EXPECT_NE(planner->plan(request).route, first);
}

TEST(OmplPlugin, ParametersAreHandedOver) {
  const Request request = through_a_window();
  const auto samples = [&](int count) {
    const PlanResult result =
        make_planner("ompl",
                     "{planner: FMT, parameters: {num_samples: " + std::to_string(count) + "}}")
            ->plan(request);
    return result.counters.at(1).value;
  };
  EXPECT_LT(samples(100), 500);
  EXPECT_GT(samples(1000), 900);
  EXPECT_EQ(parameter_problems("planner", "ompl",
                               "{planner: RRT, range_m: 40, parameters: {goal_bias: 0.2, "
                               "intermediate_states: true}}"),
            "");
}

TEST(OmplPlugin, BadParametersAreNamed) {
  const auto problem = [](const std::string& yaml) {
    return parameter_problems("planner", "ompl", yaml);
  };
  const auto says = [&](const std::string& yaml, const std::string& what) {
    EXPECT_NE(problem(yaml).find(what), std::string::npos) << problem(yaml);
  };
  says("{planner: RTTConnect}", "RRTConnect");
  says("{planner: PRM, range_m: 5}", "range_m: PRM has no range");
  says("{planner: RRT, parameters: {goalbias: 0.1}}",
       "parameters.goalbias: RRT has no such parameter, it has goal_bias");
  says("{planner: RRT, parameters: {goal_bias: often}}", "parameters.goal_bias: ");
  says("{planner: RRT, parameters: {goal_bias: [1]}}", "parameters.goal_bias: ");
  says("{planner: RRT, parameters: 3}", "expected a map");
}

TEST(OmplPlugin, ATurnThatItDoesNotKnowOfIsSaid) {
  Request request = through_a_window();
  request.limits.max_turn_space = radians(2);
  const PlanResult result = make_planner("ompl", "{planner: RRT, range_m: 50}")->plan(request);
  EXPECT_EQ(result.status, PlanStatus::no_route);
  EXPECT_TRUE(result.route.empty());
  EXPECT_NE(result.message.find("OMPL cannot check, turn_angle at waypoint"), std::string::npos)
      << result.message;
  request.limits.max_turn_space = kPi;
  EXPECT_EQ(make_planner("ompl", "{planner: RRT, range_m: 50}")->plan(request).status,
            PlanStatus::solved);
}

TEST(OmplPlugin, WithoutAWayItEndsWithItsQuestions) {
  Request request = through_a_window();
  request.world = std::make_shared<const World>(
      testing::world_of({Shape{BoxShape{{{480, -10, -10}, {520, 1010, 410}}}}}));
  for (const std::string& planner : kPlanners) {
    const PlanResult result = make_planner("ompl", with(planner, 2000))->plan(request);
    EXPECT_EQ(result.status, PlanStatus::no_route) << planner << ": " << result.message;
    EXPECT_FALSE(result.proved);
  }
}

/// An empty world that, at the hundredth query, runs something in another thread.
class Interruption final : public Environment {
 public:
  explicit Interruption(std::function<void()> by) : by_(std::move(by)) {}

 private:
  double do_clearance(const Vec3&) const override {
    if (++asked_ == 100) {
      std::thread(by_).join();
    }
    return 1000;
  }
  Box do_bounds() const override { return {{0, 0, 0}, {1000, 1000, 400}}; }

  std::function<void()> by_;
  mutable int asked_ = 0;
};

TEST(OmplPlugin, APlanWaitsForTheOneBeforeAsLongAsItHasTime) {
  const auto planner = make_planner("ompl", with("RRTstar", 1000));
  Request hurried = through_a_window();
  hurried.budget.max_iterations = 0;
  PlanResult beside;
  Request request = through_a_window();
  request.world = std::make_shared<const World>(
      testing::world_of(std::make_shared<Interruption>([&] { beside = planner->plan(hurried); })));
  EXPECT_EQ(planner->plan(request).status, PlanStatus::solved);
  EXPECT_EQ(beside.status, PlanStatus::timed_out);
  EXPECT_NE(beside.message.find("another plan used OMPL"), std::string::npos) << beside.message;
}

TEST(OmplPlugin, AStopEndsThoseThatGoOn) {
  Request request = through_a_window();
  std::stop_source source;
  source.request_stop();
  request.budget.stop = source.get_token();
  for (const std::string& planner : kPlanners) {
    const PlanResult result = make_planner("ompl", with(planner, 20'000))->plan(request);
    EXPECT_EQ(result.status, PlanStatus::cancelled) << planner << ": " << result.message;
  }
}
}  // namespace
}  // namespace altiplan::ompl_test
