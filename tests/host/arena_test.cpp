// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>

#include "study/arena/arena_columns.hpp"

namespace altiplan::host::arena_test {
using namespace study;
namespace {

TEST(Arena, columns_have_names_that_sql_and_planner_arena_take) {
  ColumnNames names;
  EXPECT_EQ(names.add("flight.min_separation_m"), "flight_min_separation_m");
  EXPECT_EQ(names.add("flight min separation m"), "flight_min_separation_m_2");
  EXPECT_EQ(names.add("Flight__Min_Separation_M"), "flight_min_separation_m_3");
  EXPECT_EQ(names.add("steps.a\"; DROP TABLE runs; --"), "steps_a_drop_table_runs");
  EXPECT_EQ(names.add("2d"), "value_2d");
  EXPECT_EQ(names.add("\xc3\xa9"), "value_");
  EXPECT_EQ(names.add("planner"), "planner_2") << "Planner Arena joins a column of that name";
  EXPECT_EQ(names.add("id"), "id_2");
}

TEST(Arena, every_value_becomes_one_column) {
  StudyData data;
  data.columns = {"expanded", "length_m", "plan_time_s", "status", "steps.status", "waypoints"};
  ColumnNames names;
  const std::vector<ArenaColumn> columns = arena_columns(data, names);
  std::set<std::string> seen;
  std::set<std::size_t> values;
  for (const ArenaColumn& column : columns) {
    EXPECT_TRUE(seen.insert(column.name).second) << column.name;
    if (column.value < data.columns.size()) {
      EXPECT_TRUE(values.insert(column.value).second) << column.name;
    }
    EXPECT_EQ(column.name == "time", column.value == 2);
    EXPECT_EQ(column.name == "status_2", column.value == 3);
  }
  EXPECT_EQ(values.size(), data.columns.size());
}

TEST(Arena, scenarios_of_one_file_are_one_problem_with_parameters) {
  StudyData data;
  data.scenarios = {
      {"hills[seed=1]", "hills", "h.yaml", {"scenario.environment.0.hills.seed=1"}},
      {"hills[seed=2]", "hills", "h.yaml", {"scenario.environment.0.hills.seed=2"}},
      {"city", "city", "c.yaml", {}},
      {"map[file=a.map]", "map", "m.yaml", {"scenario.environment.0.grid_map.file=a.map"}}};
  ColumnNames names;
  const ArenaExperiments all = arena_experiments(data, names);
  ASSERT_EQ(all.parameters.size(), 2);
  EXPECT_EQ(all.parameters[0].column, "environment_0_grid_map_file");
  EXPECT_FALSE(all.parameters[0].numbers);
  EXPECT_EQ(all.parameters[1].column, "environment_0_hills_seed");
  EXPECT_TRUE(all.parameters[1].numbers);
  EXPECT_EQ(all.experiments[0].name, "hills");
  EXPECT_EQ(all.experiments[1].name, "hills");
  EXPECT_EQ(all.experiments[1].parameters, (std::vector<std::string>{"", "2"}));
  EXPECT_EQ(all.experiments[2].name, "city");
}

TEST(Arena, scenarios_that_nothing_sets_apart_keep_their_names) {
  StudyData data;
  data.scenarios = {{"hills", "hills", "h.yaml", {}},
                    {"hills[seed=2]", "hills", "h.yaml", {"scenario.seed=2"}}};
  ColumnNames names;
  const ArenaExperiments all = arena_experiments(data, names);
  EXPECT_TRUE(all.parameters.empty());
  EXPECT_EQ(all.experiments[0].name, "hills");
  EXPECT_EQ(all.experiments[1].name, "hills[seed=2]");
}

TEST(Arena, every_outcome_has_a_status_of_its_own) {
  std::set<int> statuses;
  for (const char* outcome :
       {"solved", "no_route", "timed_out", "cancelled", "invalid_problem", "rejected", "failed",
        "collided", "not_reached", "crashed", "out_of_memory", "bad_output", "refused"}) {
    EXPECT_TRUE(statuses.insert(arena_status(outcome)).second) << outcome;
  }
  EXPECT_FALSE(statuses.contains(0));
  EXPECT_EQ(arena_status("solved"), 6) << "OMPL's exact solution";
  EXPECT_EQ(arena_status("nonsense"), 0);
}
}  // namespace
}  // namespace altiplan::host::arena_test
