// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "grid.hpp"
#include "guarded.hpp"

namespace {
using namespace altiplan;

void print(const nlohmann::ordered_json& json) {
  for (const auto& [key, value] : json.items()) {
    std::printf("%-17s %s\n", key.c_str(),
                value.is_string() ? value.get<std::string>().c_str() : value.dump().c_str());
  }
}

int run(int argc, char** argv) {
  CLI::App app("Measures altiplan's planners against published figures.", "altiplan-bench");
  app.set_version_flag("--version", ALTIPLAN_VERSION);
  app.require_subcommand(1);
  bench::GridArguments grid;
  bool as_json = false;
  CLI::App* command =
      app.add_subcommand("grid", "plan a grid map's scenarios and compare with their lengths");
  command->add_option("map", grid.map, "a MovingAI .map or a Warframe .3dmap")->required();
  command->add_option("scenarios", grid.scenarios, "its .scen or .3dscen file")->required();
  command->add_option("--planner", grid.planner, "planner plugin; astar by default")
      ->type_name("NAME");
  command
      ->add_option("--corner", grid.corner,
                   "the planner's rule for diagonal steps; free_box by default, by which the "
                   "printed lengths were made")
      ->type_name("RULE");
  command
      ->add_option("--with", grid.with, "a further parameter of the planner: heuristic=euclidean")
      ->type_name("KEY=VALUE");
  command
      ->add_option("--repeat", grid.repeat,
                   "plan each scenario N times and take the median of its times")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  command->add_flag("--each", grid.each,
                    "first print a line for each scenario: number from 0, solved (0 or 1), length "
                    "in cells, cells expanded, microseconds");
  command->add_option("--limit", grid.limit, "plan the first N scenarios only")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  command->add_option("--plugin-path", grid.plugin_path, "folder of plugin libraries")
      ->type_name("DIR");
  command->add_flag("--json", as_json, "print one JSON object, after the lines of --each");
  command->footer("Example:\n  altiplan-bench grid arena.map arena.map.scen --limit 100");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? cli::kDone : cli::kUsage;
  }
  return cli::guarded("altiplan-bench", [&] {
    const nlohmann::ordered_json json = bench::run_grid(grid);
    if (as_json) {
      std::cout << json.dump(1) << '\n';
    } else {
      print(json);
    }
    return cli::kDone;
  });
}
}  // namespace

int main(int argc, char** argv) { return run(argc, argv); }
