// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "altiplan/check.hpp"
#include "altiplan/constraint.hpp"
#include "altiplan/environment.hpp"
#include "altiplan/local_planner.hpp"
#include "altiplan/objective.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin_abi.hpp"
#include "altiplan/smoother.hpp"
#include "altiplan/task.hpp"
#include "altiplan/tuner.hpp"

namespace altiplan::testing {

// Plugins of this build, loaded as the host loads them, with parameters as a user writes them:
// make_planner("astar", "{cell_m: [50, 50, 10]}").
std::unique_ptr<Planner> make_planner(std::string_view name, std::string_view yaml = "{}");
std::unique_ptr<LocalPlanner> make_local_planner(std::string_view name,
                                                 std::string_view yaml = "{}");
std::unique_ptr<Smoother> make_smoother(std::string_view name, std::string_view yaml = "{}");
std::unique_ptr<Constraint> make_constraint(std::string_view name, std::string_view yaml = "{}");
std::unique_ptr<Tuner> make_tuner(std::string_view name, std::string_view yaml = "{}");
std::unique_ptr<Environment> make_environment(std::string_view name, std::string_view yaml,
                                              const Site& site);
std::unique_ptr<Environment> make_environment(std::string_view name, std::string_view yaml = "{}");
std::unique_ptr<Objective> make_objective(std::string_view name, std::string_view yaml = "{}",
                                          const Frame& frame = {});
std::unique_ptr<Objective> make_objective(std::string_view name, std::string_view yaml,
                                          const Site& site);
/// One that looks at the layers of a world.
std::unique_ptr<Objective> make_objective(std::string_view name, std::string_view yaml,
                                          const World& before);
std::unique_ptr<Task> make_task(std::string_view name, std::string_view yaml = "{}",
                                const World& before = {});
/// Problems of the parameters, as the user would read them, one a line; "" where there are none.
std::string parameter_problems(std::string_view kind, std::string_view name, std::string_view yaml);

/// The value of a counter, -1 where there is none of the name.
std::int64_t counter(const PlanResult& result, std::string_view name);

/// A world of one layer.
World world_of(std::shared_ptr<const Environment> environment, std::string id = "layer");
/// A world of solid shapes (one layer, through kit::ObstacleSet).
World world_of(std::vector<Shape> shapes);

/// A request in that world; volume from `volume`, everything else at its default.
Request request_in(World world, const Vec3& start, const Vec3& goal, const Box& volume);

/// A cell world drawn as text, one string a level from the lowest, rows from the north (highest y),
/// '#' blocked, '.' free, 'S' and 'G' start and goal; cells are cubes of `cell_m`.
struct Drawn {
  std::shared_ptr<const World> world;
  Request request;
};
Drawn draw(const std::vector<std::string>& levels, double cell_m = 1);

/// Files of ALTIPLAN_TEST_DATA (default ../shared/data); empty where absent: then the test skips.
std::filesystem::path test_data(std::string_view relative);
/// The source tree's configs folder.
std::filesystem::path configs();

/// SKIPs with a message when real data are not there.
#define ALTIPLAN_DATA_OR_SKIP(variable, relative)                 \
  const auto variable = ::altiplan::testing::test_data(relative); \
  if (variable.empty())                                           \
  GTEST_SKIP() << "no test data: set ALTIPLAN_TEST_DATA (" << relative << ")"
}  // namespace altiplan::testing
