// SPDX-License-Identifier: Apache-2.0
#include "support/published_routes.hpp"

namespace altiplan::nmopso_objective_test {
namespace {

const std::vector<Vec3> kThreats{{200, 230, 70}, {600, 250, 70}, {450, 550, 70},
                                 {700, 600, 50}, {200, 500, 60}, {500, 800, 60}};

TEST(NmopsoObjective, EqualsTheAuthorsProgram) {
  ALTIPLAN_DATA_OR_SKIP(file, "costs/nmopso_routes.csv");
  Request request = testing::published_map("nmopso.tif", kThreats, {50, 50, 150}, {800, 800, 170});
  request.objective = testing::make_objective("nmopso", "{}", *request.world);
  int finite = 0;
  for (const testing::NumberRow& row : testing::rows_of(file)) {
    const Route route = testing::published_route(row, request);
    const std::vector<double> terms = request.objective->costs(route, request);
    ASSERT_EQ(terms.size(), 4U);
    for (std::size_t k = 0; k < 4; ++k) {
      testing::expect_published(terms[k], row.at("J" + std::to_string(k + 1) + "_octave"),
                                row.at("id"));
    }
    finite += std::isfinite(cost_of(route, request)) ? 1 : 0;
    EXPECT_LE(min_cost(request), cost_of(route, request));
  }
  EXPECT_GT(finite, 10);
}

/// The straight line is barred: no route around the threat is as short.
TEST(NmopsoObjective, TheBoundIsTheWayAroundThreats) {
  const World world = testing::world_of(
      testing::make_environment("zones", "{list: [{cylinder: {at_m: [500, 0], radius_m: 99}}]}"));
  Request request =
      testing::request_in(world, {0, 0, 150}, {1000, 0, 150}, {{0, -500, 0}, {1000, 500, 300}});
  request.objective = testing::make_objective("nmopso", "{}", *request.world);
  const double half = std::acos(100.0 / 500);
  const double length = 2 * std::sqrt(500.0 * 500 - 100 * 100) + 100 * (kPi - 2 * half);
  EXPECT_NEAR(min_cost(request), 1 - 1000 / length, 1e-9);
}
}  // namespace
}  // namespace altiplan::nmopso_objective_test
