// SPDX-License-Identifier: Apache-2.0
// Planners over cells side by side, in cities of paper 003 and on maps in space. Times are the
// thread's, of whole calls of Planner::plan; lengths are in cells.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <optional>

#include "rows.hpp"

namespace altiplan::bench {
namespace {

struct Arguments {
  std::vector<std::string> planners;
  int passes = 3;
  CityKind city;
  std::string kind = "complex";
  std::vector<int> counts{80, 80, 100};
  int first_seed = 0;
  int seeds = 20;
  std::string map;
  std::string ways;
  std::size_t limit = 50;
  double min_cells = 0;
  bool each = false;
};

std::vector<Row> make_rows(host::Registry& registry, std::vector<std::string> planners) {
  if (planners.empty()) {
    planners = {"astar {corner: free_box}"};
    const std::vector<std::string> offered = registry.names("planner");
    for (const char* name : {"theta_star", "lazy_theta_star", "stratified_theta"}) {
      if (std::find(offered.begin(), offered.end(), name) != offered.end()) {
        planners.emplace_back(name);
      }
    }
  }
  std::vector<Row> rows;
  for (const std::string& planner : planners) {
    rows.emplace_back(registry, planner);
  }
  return rows;
}

Json time_cities(const Arguments& arguments, host::Registry& registry) {
  std::vector<Row> rows = make_rows(registry, arguments.planners);
  CityKind kind = arguments.city;
  kind.complex = arguments.kind == "complex";
  kind.counts = {arguments.counts[0], arguments.counts[1], arguments.counts[2]};
  double build_ms = 0;
  double occupancy_ms = 0;
  double blocked = 0;
  std::size_t cell_count = 0;
  for (int n = 0; n < arguments.seeds; ++n) {
    const Cells cells = make_city(registry, kind, arguments.first_seed + n);
    cell_count = cells.spec().cell_count();
    build_ms += cells.build_ms() / arguments.seeds;
    occupancy_ms += cells.occupancy_ms() / arguments.seeds;
    blocked += double(cells.blocked()) / double(cell_count) / arguments.seeds;
    plan_all(rows, cells, {kind.way()}, arguments.passes);
  }
  Json figures{{"cities", arguments.seeds}, {"kind", arguments.kind},
               {"cells", cell_count},       {"blocked", blocked},
               {"build_ms", build_ms},      {"occupancy_ms", occupancy_ms}};
  add(figures, rows, cell_count);
  return figures;
}

/// A line for each way as soon as it is read, for a program that asks two systems in turn.
void print_each(const Arguments& arguments, const Cells& cells, Row& row, Ways& ways) {
  while (const std::optional<Way> way = ways.next()) {
    for (int pass = 0; pass < arguments.passes; ++pass) {
      const Row::Plan plan = row.plan(cells, *way);
      std::printf("%d %.9g %.0f %.3f\n", int(plan.length < kInfinity),
                  plan.length < kInfinity ? plan.length : 0, plan.expanded, 1e3 * plan.ms);
    }
    std::fflush(stdout);
  }
}

Json time_map(const Arguments& arguments, host::Registry& registry) {
  std::vector<Row> rows = make_rows(registry, arguments.planners);
  std::ifstream file;
  if (arguments.ways != "-") {
    file.open(arguments.ways);
    if (!file) {
      throw Error(arguments.ways + ": cannot be read");
    }
  }
  Ways ways(arguments.ways == "-" ? std::cin : file, arguments.ways);
  const Cells cells = load_map(registry, arguments.map);
  if (arguments.each) {
    print_each(arguments, cells, rows.front(), ways);
    return nullptr;
  }
  std::vector<Way> all;
  while (const std::optional<Way> way = ways.next()) {
    all.push_back(*way);
  }
  const std::size_t cell_count = cells.spec().cell_count();
  plan_all(rows, cells, spread(std::move(all), arguments.min_cells, arguments.limit),
           arguments.passes);
  Json figures{{"map", arguments.map},
               {"cells", cell_count},
               {"blocked", double(cells.blocked()) / double(cell_count)},
               {"build_ms", cells.build_ms()},
               {"occupancy_ms", cells.occupancy_ms()}};
  add(figures, rows, cell_count);
  return figures;
}
}  // namespace

void add_any_angle(Subcommands& all) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      all.add("any-angle", "time planners over cells side by side", [=](const Given& given) {
        return arguments->map.empty() ? time_cities(*arguments, *given.registry)
                                      : time_map(*arguments, *given.registry);
      });
  command.require_subcommand(1);
  command
      .add_option("--planner", arguments->planners,
                  "name and parameters in YAML: 'astar {corner: free_box}'; again for more. By "
                  "default astar and those for straight legs that there are")
      ->type_name("TEXT");
  command.add_option("--passes", arguments->passes, "plans of each way; its time is their median")
      ->check(CLI::Range(1, 1000));
  CLI::App* city = command.add_subcommand("city", "drawn cities, a way across each");
  city->fallthrough();
  city->add_option("--kind", arguments->kind, "of city")
      ->check(CLI::IsMember({"simple", "complex"}));
  city->add_option("--seeds", arguments->seeds, "how many cities")->check(CLI::PositiveNumber);
  city->add_option("--first-seed", arguments->first_seed, "of the first; the others follow")
      ->check(CLI::NonNegativeNumber);
  city->add_option("--cells", arguments->counts, "cells along x, y and z")->expected(3);
  city->add_option("--buildings", arguments->city.buildings, "how many a complex city draws");
  CLI::App* map = command.add_subcommand("map", "a map, and ways from a file");
  map->fallthrough();
  map->add_option("map", arguments->map, "a Warframe .3dmap")->required();
  map->add_option("ways", arguments->ways,
                  "a .3dscen file, or lines of start x y z and goal x y z; - for standard input")
      ->required();
  map->add_option("--limit", arguments->limit, "ways, from the shortest to the longest, evenly")
      ->check(CLI::PositiveNumber);
  map->add_option("--least-cells", arguments->min_cells, "between the ends of a way");
  map->add_flag("--each", arguments->each,
                "answer all ways by the first planner, one by one as they are read, --passes times "
                "each: solved (0 or 1), length in cells, cells expanded, microseconds");
}
}  // namespace altiplan::bench
