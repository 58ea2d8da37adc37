// SPDX-License-Identifier: Apache-2.0
// Planners that search cells, among real buildings with heights: routes are judged, and looked at
// again by sampling their clearance.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>

#include "altiplan/environment.hpp"
#include "altiplan/world.hpp"
#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::real_cities_test {
namespace {

constexpr double kRadius = 1.5;

struct City {
  const char* name;
  const char* file;
  const char* more;    ///< parameters of city beside the file
  const char* volume;  ///< its two corners, the ceiling below many roofs
  Vec3 start;          ///< with a building in the way to the goal
  Vec3 goal;
};

// Metres from the place that the file names: San Francisco its own, the others their south-west
// corner.
const City kCities[] = {{"san_francisco",
                         "city/sf_colliders.csv",
                         "",
                         "{min_m: [-440, -310, 0], max_m: [470, 600, 60]}",
                         {-300, 400, 25},
                         {350, -150, 20}},
                        {"berlin",
                         "city/berlin_buildings.geojson",
                         ", levels_property: levels, default_height_m: 15",
                         "{min_m: [-20, -20, 0], max_m: [920, 880, 14]}",
                         {5, 860, 5},
                         {880, 20, 5}},
                        {"brussels",
                         "city/brussels_place_saint_jean.geojson",
                         "",
                         "{min_m: [-20, -20, 0], max_m: [300, 280, 30]}",
                         {-10, 270, 10},
                         {290, -10, 10}}};

struct Plan {
  const char* planner;
  const char* with;
};

const Plan kPlans[] = {{"astar", "{cell_m: [5, 5, 5], moves: cells, corner: free_box}"},
                       {"theta_star", "{cell_m: [5, 5, 5]}"},
                       {"lazy_theta_star", "{cell_m: [5, 5, 5]}"},
                       {"stratified_theta", "{cell_m: [5, 5, 5]}"},
                       {"dstar_lite", "{cell_m: [5, 5, 5], moves: cells, corner: free_box}"}};

struct Case {
  City city;
  Plan plan;
};

void PrintTo(const Case& instance, std::ostream* out) {
  *out << instance.city.name << ", " << instance.plan.planner;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const City& city : kCities) {
    for (const Plan& plan : kPlans) {
      all.push_back({city, plan});
    }
  }
  return all;
}

std::string text(const Vec3& p) {
  return "[" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ", " + std::to_string(p.z()) +
         "]";
}

class RealCities : public ::testing::TestWithParam<Case> {};

TEST_P(RealCities, ARouteIsPlannedAndSound) {
  const auto& [city, plan] = GetParam();
  ALTIPLAN_DATA_OR_SKIP(file, city.file);
  const std::string buildings = "{file: " + file.string() + city.more + "}";
  const auto world = testing::make_environment("city", buildings);
  ASSERT_TRUE(world->blocked(city.start, city.goal, kRadius))
      << "the straight line is free: this case shows nothing";

  const testing::TempFolder folder;
  folder.write("scenario.yaml",
               "altiplan: 1\nenvironment:\n  - city: " + buildings + "\nvolume: " + city.volume +
                   "\nvehicle: {radius_m: " + std::to_string(kRadius) + "}\nstart: {at_m: " +
                   text(city.start) + "}\ngoal: {at_m: " + text(city.goal) + "}\n");
  const auto pipeline = folder.write(
      "pipeline.yaml", std::string("altiplan: 1\nscenario: scenario.yaml\nsteps:\n  - plan: ") +
                           plan.planner + "\n    with: " + plan.with + "\n");
  const testing::Ran ran = testing::run_file(pipeline);
  const host::Json& result = ran.json;
  ASSERT_EQ(result["status"], "solved") << result["message"];
  EXPECT_TRUE(result["check"]["ok"]);

  Polyline route;
  for (const host::Json& p : result["route"]) {
    route.emplace_back(p[0].get<double>(), p[1].get<double>(), p[2].get<double>());
  }
  EXPECT_GT(length(route), (city.goal - city.start).norm() * 1.0001);
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    const Vec3 way = route[i + 1] - route[i];
    const int steps = 1 + int(way.norm());
    for (int n = 0; n <= steps; ++n) {
      EXPECT_GE(world->clearance(route[i] + way * (double(n) / steps)), kRadius - 1e-6) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(City, RealCities, ::testing::ValuesIn(cases()), [](const auto& instance) {
  return std::string(instance.param.city.name) + "_" + instance.param.plan.planner;
});
}  // namespace
}  // namespace altiplan::real_cities_test
