// SPDX-License-Identifier: Apache-2.0
// Planners that improve a population of whole routes.
#include <gtest/gtest.h>

#include "altiplan/check.hpp"
#include "altiplan/kit/population/population.hpp"
#include "altiplan/kit/population/variation.hpp"
#include "support/populations.hpp"
#include "support/published_routes.hpp"

namespace altiplan::population_test {
namespace {

/// A route through the column has a finite cost: the rule of the objective lets it pass.
TEST(Population, TheRuleDecidesWhoseWordCounts) {
  const Request request = testing::around_a_column();
  const PlanResult result = testing::population_planner("pso", ", rule: objective")->plan(request);
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
  const Request request = testing::around_a_column();
  EXPECT_THROW(testing::population_planner("pso", ", above_ground_m: [50, 60]")->plan(request),
               ParameterError);
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
