// SPDX-License-Identifier: Apache-2.0
// Comparison of grid planners, in cities of paper 003 and on 3-D maps. Times are thread CPU times
// of whole calls of Planner::plan; lengths are in cells.
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

/// Prints a line for each query as soon as it is read, for a program that queries two systems in
/// turn.
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
      all.add("any-angle", "compare the times of grid planners", [=](const Given& given) {
        return arguments->map.empty() ? time_cities(*arguments, *given.registry)
                                      : time_map(*arguments, *given.registry);
      });
  command.require_subcommand(1);
  command
      .add_option("--planner", arguments->planners,
                  "planner plugin and its parameters in YAML: 'astar {corner: free_box}'; "
                  "repeatable (default: astar and the available any-angle planners)")
      ->type_name("TEXT");
  command
      .add_option("--passes", arguments->passes,
                  "number of plans per query; its time is their median")
      ->check(CLI::Range(1, 1000));
  CLI::App* city = command.add_subcommand("city", "random cities, a query across each");
  city->fallthrough();
  city->add_option("--kind", arguments->kind, "kind of city: simple or complex")
      ->check(CLI::IsMember({"simple", "complex"}));
  city->add_option("--seeds", arguments->seeds, "number of cities")->check(CLI::PositiveNumber);
  city->add_option("--first-seed", arguments->first_seed,
                   "seed of the first city; the others follow")
      ->check(CLI::NonNegativeNumber);
  city->add_option("--cells", arguments->counts, "number of cells along x, y and z")->expected(3);
  city->add_option("--buildings", arguments->city.buildings,
                   "number of buildings of a complex city");
  CLI::App* map = command.add_subcommand("map", "a map with queries from a file");
  map->fallthrough();
  map->add_option("map", arguments->map, "Warframe .3dmap file")->required();
  map->add_option("ways", arguments->ways,
                  "queries: a .3dscen file, or lines of start x y z and goal x y z; - for stdin")
      ->required();
  map->add_option("--limit", arguments->limit,
                  "maximum number of queries, evenly from the shortest to the longest")
      ->check(CLI::PositiveNumber);
  map->add_option("--min-cells", arguments->min_cells,
                  "minimum distance of start and goal (cells)");
  map->add_flag("--each", arguments->each,
                "answer each query with the first planner as it is read, --passes times: prints "
                "solved (0 or 1), length (cells), cells expanded, time (us)");
}
}  // namespace altiplan::bench
