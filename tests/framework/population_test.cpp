// SPDX-License-Identifier: Apache-2.0
// Planners that improve a population of whole routes.
#include <gtest/gtest.h>

#include "altiplan/check.hpp"
#include "altiplan/kit/population/population.hpp"
#include "altiplan/kit/population/variation.hpp"
#include "support/published_routes.hpp"

namespace altiplan::population_test {
namespace {

const char* const kAll[] = {"pso",     "spso",      "differential_evolution",
                            "genetic", "grey_wolf", "nsga2"};

/// A column between start and goal.
Request around_a_column() {
  return testing::request_in(testing::world_of(std::vector<Shape>{Cylinder{500, 10, 120}}),
                             {0, 0, 100}, {1000, 0, 100}, {{0, -400, 50}, {1000, 400, 150}});
}

std::unique_ptr<Planner> planner(const std::string& name, const std::string& more = "") {
  return testing::make_planner(
      name, "{waypoints: 3, evaluations: 4000, encoding: cartesian" + more + "}");
}

TEST(Population, EachPlannerFindsARouteAroundAColumn) {
  const Request request = around_a_column();
  for (const char* name : kAll) {
    const PlanResult result = planner(name)->plan(request);
    ASSERT_EQ(result.status, PlanStatus::solved) << name << ": " << result.message;
    EXPECT_TRUE(check(result.route, request).ok()) << name;
    EXPECT_EQ(result.route.size(), 5U) << name;
    EXPECT_LT(length(result.route), 1700) << name;
    EXPECT_EQ(testing::counter(result, "expanded"), 4000) << name;
  }
}

TEST(Population, OneResultForAnyNumberOfThreads) {
  Request request = around_a_column();
  for (const char* name : kAll) {
    request.threads = 1;
    const PlanResult alone = planner(name)->plan(request);
    request.threads = 3;
    EXPECT_EQ(alone.route, planner(name)->plan(request).route) << name;
  }
}

TEST(Population, AnEvaluationIsAnIterationOfTheBudget) {
  Request request = around_a_column();
  for (const char* name : kAll) {
    double before = kInfinity;
    for (const std::uint64_t budget : {300U, 1000U, 2777U}) {
      request.budget.max_iterations = budget;
      const PlanResult result = planner(name)->plan(request);
      EXPECT_EQ(testing::counter(result, "expanded"), std::int64_t(budget)) << name;
      EXPECT_TRUE(result.budget_hit) << name;
      const double now = result.status == PlanStatus::solved ? length(result.route) : kInfinity;
      EXPECT_LE(now, before) << name;
      before = now;
    }
  }
}

/// A route through the column has a finite cost: the rule of the objective lets it pass.
TEST(Population, TheRuleDecidesWhoseWordCounts) {
  const Request request = around_a_column();
  const PlanResult result = planner("pso", ", rule: objective")->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved);
  EXPECT_FALSE(check(result.route, request).ok());
  EXPECT_NEAR(length(result.route), 1000, 5);
}

/// Feasible first, then the violation; not evaluated is worse than all.
TEST(Population, TheRulesOfFeasibility) {
  const kit::Score cheap{0, 1};
  const kit::Score dear{0, 2};
  const kit::Score wrong{0.5, 0};
  EXPECT_TRUE(kit::better(cheap, dear));
  EXPECT_FALSE(kit::better(dear, cheap));
  EXPECT_TRUE(kit::better(dear, wrong));
  EXPECT_FALSE(kit::better(wrong, dear));
  EXPECT_TRUE(kit::better(wrong, kit::Score{}));
}

/// SphericalToCart of the published program.
TEST(RouteSpace, SphericalVectorsAreThoseOfTheAuthorsProgram) {
  ALTIPLAN_DATA_OR_SKIP(file, "costs/spso_spherical.csv");
  const Request request =
      testing::published_map("spso.tif", {{1, 1, 1}}, {200, 100, 150}, {800, 800, 150});
  kit::RouteSpaceParams params;
  params.encoding = kit::Encoding::spherical_mirrored;
  params.waypoints = 10;
  params.above_ground_m = {{100, 200}};
  const kit::RouteSpace space(request, params);
  const double r_max = 2 * std::hypot(600, 700) / 10;
  const double phi_0 = std::atan2(700, 600);
  int rows = 0;
  for (const testing::NumberRow& row : testing::rows_of(file)) {
    kit::Position x;
    for (int k = 1; k <= 10; ++k) {
      const std::string n = std::to_string(k);
      x.push_back(row.at("r" + n) / r_max);
      x.push_back((row.at("phi" + n) - phi_0) / (kPi / 2) + 0.5);
      x.push_back(row.at("psi" + n) / (kPi / 2) + 0.5);
    }
    const Polyline route = space.route(x);
    ASSERT_EQ(route.size(), 12U);
    const Route wanted = testing::published_route(row, request);
    for (std::size_t k = 0; k < route.size(); ++k) {
      EXPECT_LT((route[k] - wanted[k]).norm(), 1e-9) << "row " << row.at("id") << ", " << k;
    }
    ++rows;
  }
  EXPECT_EQ(rows, 15);
}

TEST(RouteSpace, HeightsAboveGroundNeedAGround) {
  const Request request = around_a_column();
  EXPECT_THROW(planner("pso", ", above_ground_m: [50, 60]")->plan(request), ParameterError);
  EXPECT_NE(testing::parameter_problems("planner", "pso", "{above_ground_m: [60, 50]}"), "");
}

/// Crossover without mutation keeps the mean of the parents; both stay in the cube.
TEST(Variation, ChildrenLieAboutTheirParents) {
  RandomStream random(1);
  kit::VariationParams params;
  params.crossover = 1;
  params.mutation_eta = 1000;  // hardly any step
  const kit::Member a{{0.4, 0.5, 0.6}};
  const kit::Member b{{0.6, 0.45, 0.6}};
  for (int n = 0; n < 1000; ++n) {
    const auto [first, second] = kit::children_of(a, b, params, random);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(first.x[i] + second.x[i], a.x[i] + b.x[i], 0.05);
      EXPECT_GE(first.x[i], 0);
      EXPECT_LE(first.x[i], 1);
    }
    EXPECT_NEAR(first.x[2], 0.6, 0.02);  // the parents agree
  }
}
}  // namespace
}  // namespace altiplan::population_test
