// SPDX-License-Identifier: Apache-2.0
// The terrain of paper 002 as fitted (the paper's own is not published): known lengths of A* on it.
#include <gtest/gtest.h>

#include "altiplan/world.hpp"
#include "support/support.hpp"

namespace altiplan::fitted_terrain_test {
namespace {

/// Kilometres: x, y, height, half widths.
constexpr double kPeaks[][5] = {{57, 33, 2.4, 6, 3}, {62, 53, 1.9, 9, 6}, {51, 34, 2.0, 9, 8},
                                {24, 22, 3.2, 3, 3}, {35, 76, 2.2, 6, 5}, {55, 55, 3.4, 9, 7},
                                {46, 27, 3.4, 2, 9}, {74, 23, 3.1, 4, 6}, {59, 33, 2.7, 4, 4},
                                {33, 42, 2.4, 9, 6}, {26, 74, 2.6, 2, 3}, {44, 19, 2.1, 6, 7}};

Request fitted_terrain() {
  std::string yaml = "{base_m: 500, cap_m: 4000, peaks: [";
  for (const auto& peak : kPeaks) {
    const auto metres = [&](int i) { return std::to_string(1000 * peak[i]); };
    yaml += "{at_m: [" + metres(0) + ", " + metres(1) + "], height_m: " + metres(2) +
            ", sigma_m: [" + metres(3) + ", " + metres(4) + "]},";
  }
  const Box volume = {{0, 0, 0}, {100e3, 100e3, 5e3}};
  const World nothing;
  Site site;
  site.volume = volume;
  site.before = &nothing;
  World world = testing::world_of(
      {Shape{Cylinder{48e3, 41e3, 5e3, 0, 1e4}}, Shape{Cylinder{60e3, 70e3, 5e3, 0, 1e4}}});
  world = world.with({"hills", "hills", testing::make_environment("hills", yaml + "]}", site)});
  Request request =
      testing::request_in(std::move(world), {25e3, 70e3, 2e3}, {55e3, 10e3, 2800}, volume);
  request.limits.altitude = {{AltitudeBand::Datum::sea, 1e3, 4e3}};
  request.limits.min_ground_clearance = 1;
  request.limits.max_climb = radians(15);
  request.limits.max_turn_space = radians(55);
  return request;
}

double planned_km(const Request& request, const std::string& parameters,
                  const char* planner = "astar") {
  const PlanResult result =
      testing::make_planner(planner, "{cell_m: [1000, 1000, 200], " + parameters + "}")
          ->plan(request);
  EXPECT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_TRUE(check(result.route, request).ok());
  return length(result.route) / 1e3;
}

TEST(FittedTerrain, AStarHasItsKnownLengths) {
  const Request request = fitted_terrain();
  const double optimum = planned_km(request, "heuristic: octile");
  EXPECT_NEAR(optimum, 74.995, 0.001);
  EXPECT_NEAR(planned_km(request, "heuristic: euclidean"), optimum, 1e-9);
  EXPECT_NEAR(planned_km(request, "heuristic: manhattan, weight_g: 0.7, weight_h: 0.3"), optimum,
              1e-9);
  EXPECT_NEAR(planned_km(request, "heuristic: manhattan"), 76.68, 0.01);
  EXPECT_NEAR(planned_km(request, "heuristic: manhattan, weight_g: 0.3, weight_h: 0.7"), 82.53,
              0.3);
}

TEST(FittedTerrain, EverySearchFindsTheOptimum) {
  const Request request = fitted_terrain();
  for (const char* planner : {"astar", "bidirectional_astar"}) {
    for (const char* state : {"parent", "cell_and_heading", "auto"}) {
      EXPECT_NEAR(planned_km(request, std::string("state: ") + state, planner), 74.995, 0.001);
    }
    EXPECT_NEAR(planned_km(request, "anytime: true", planner), 74.995, 0.001);
  }
}

TEST(FittedTerrain, SmoothersShortenAndStaySound) {
  const Request request = fitted_terrain();
  Route route = testing::make_planner("astar", "{cell_m: [1000, 1000, 200]}")->plan(request).route;
  for (const char* smoother : {"prune", "bspline"}) {
    const Route smoothed = testing::make_smoother(smoother)->smooth(route, request).route;
    EXPECT_LT(length(smoothed), length(route)) << smoother;
    EXPECT_TRUE(check(smoothed, request).ok()) << smoother;
    route = smoothed;
  }
  EXPECT_LT(length(route), 70.9e3);
}
}  // namespace
}  // namespace altiplan::fitted_terrain_test
