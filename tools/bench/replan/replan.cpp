// SPDX-License-Identifier: Apache-2.0
// Time of dstar_lite to repair its plan after cell changes, compared with replanning by astar in
// the same world. Each is timed once, one after the other, and all lengths are compared.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/kit/lattice/move_rules.hpp"
#include "altiplan/kit/layers/cell_layer.hpp"
#include "altiplan/random.hpp"
#include "altiplan/route.hpp"
#include "measuring.hpp"
#include "subcommand.hpp"

namespace altiplan::bench {
namespace {

double ms_of(const std::function<void()>& work) {
  const double before = thread_s();
  work();
  return 1e3 * (thread_s() - before);
}

double expanded(const PlanResult& result) { return counter(result, "expanded"); }

/// A world of cells, and a query in it.
struct Map {
  std::string name;
  VoxelGrid cells;
  Cell start;
  Cell goal;
};

World world_of(VoxelGrid cells) {
  return World().with(
      {"cells", "voxel_map", std::make_shared<const kit::CellLayer>(std::move(cells)), true});
}

Request request_in(const Map& map, const std::shared_ptr<const World>& world) {
  Request request;
  request.world = world;
  request.volume = map.cells.spec().box();
  request.start.position = map.cells.spec().centre(map.start);
  request.goal = {map.cells.spec().centre(map.goal), 0};
  return request;
}

Map city(host::Registry& registry, int seed) {
  Site site;
  GridSpec spec;
  spec.cell = Vec3::Constant(10);
  spec.counts = {80, 80, 100};
  spec.rule = GridSpec::Rule::native;
  site.start = spec.centre({1, 2, 4});
  site.goal = spec.centre({67, 64, 4});
  VoxelGrid cells(spec);
  const std::string text = "city {generate: complex, seed: " + std::to_string(seed) + "}";
  environment(registry, text, site)->rasterize(cells);
  return {"city " + std::to_string(seed), std::move(cells), {1, 2, 4}, {67, 64, 4}};
}

Cell random_cell(const GridSpec& spec, RandomStream& random) {
  Cell c{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    c[axis] = int(random.integer(0, spec.counts[axis] - 1));
  }
  return c;
}

/// Distant free cells without an easy connection; empty if many tries fail.
std::optional<Map> voxel_map(host::Registry& registry, const std::string& file,
                             RandomStream& random) {
  const auto layer = environment(registry, "voxel_map {file: '" + file + "'}");
  VoxelGrid cells(*layer->info().native_grid);
  layer->rasterize(cells);
  Map map{file.substr(file.rfind('/') + 1), std::move(cells), {}, {}};
  const auto astar = planner(registry, "astar {moves: cells}");
  const auto world = std::make_shared<const World>(world_of(map.cells));
  for (int tries = 0; tries < 1000; ++tries) {
    map.start = random_cell(map.cells.spec(), random);
    map.goal = random_cell(map.cells.spec(), random);
    const double apart = std::hypot(map.start[0] - map.goal[0], map.start[1] - map.goal[1]);
    if (map.cells.blocked(map.start) || map.cells.blocked(map.goal) ||
        apart < 0.3 * map.cells.spec().counts[0]) {
      continue;
    }
    const PlanResult way = astar->plan(request_in(map, world));
    if (way.status == PlanStatus::solved && expanded(way) > 5000) {
      return map;
    }
  }
  return std::nullopt;
}

/// A kind of change to the cells; the ends stay free.
struct Kind {
  std::string name;
  std::function<void(VoxelGrid&, const Map&, const Route&, RandomStream&)> edit;
};

void flip(VoxelGrid& cells, const Map& map, const Cell& c) {
  if (cells.spec().holds(c) && c != map.start && c != map.goal) {
    cells.set(c, !cells.blocked(c));
  }
}

Kind anywhere(const std::string& name, double share) {
  return {name, [share](VoxelGrid& cells, const Map& map, const Route&, RandomStream& random) {
            const int count = std::max(1, int(share * double(cells.spec().cell_count())));
            for (int n = 0; n < count; ++n) {
              flip(cells, map, random_cell(cells.spec(), random));
            }
          }};
}

/// `count` cells of a box around the route point at the fraction `share` of the route.
Kind around(const std::string& name, double share, int reach, int count) {
  return {name, [=](VoxelGrid& cells, const Map& map, const Route& route, RandomStream& random) {
            const Vec3& at = route[std::size_t(share * double(route.size() - 1))];
            const Cell middle = cells.spec().cell_of(at);
            for (int n = 0; n < count; ++n) {
              Cell c = middle;
              for (int& index : c) {
                index += int(random.integer(-reach, reach));
              }
              flip(cells, map, c);
            }
          }};
}

/// A solid cube on the route, some cells from its start or its end.
Kind block(const std::string& name, bool at_start, int cells_on, int half) {
  return {name, [=](VoxelGrid& cells, const Map& map, const Route& route, RandomStream&) {
            const int last = int(route.size()) - 1;
            const int n = std::min(cells_on, last / 2);
            const Cell middle = cells.spec().cell_of(route[std::size_t(at_start ? n : last - n)]);
            for (int k = -half; k <= half; ++k) {
              for (int j = -half; j <= half; ++j) {
                for (int i = -half; i <= half; ++i) {
                  const Cell c = {middle[0] + i, middle[1] + j, middle[2] + k};
                  if (cells.spec().holds(c) && c != map.start && c != map.goal) {
                    cells.set(c, true);
                  }
                }
              }
            }
          }};
}

std::vector<Kind> kinds() {
  return {anywhere("no cell", 0),
          anywhere("1e-5 of cells, anywhere", 1e-5),
          anywhere("1e-4 of cells, anywhere", 1e-4),
          anywhere("1e-3 of cells, anywhere", 1e-3),
          around("64 cells around the start", 0, 6, 64),
          around("64 cells around the goal", 1, 6, 64),
          around("640 cells around the start", 0, 12, 640),
          around("640 cells around the goal", 1, 12, 640),
          around("640 cells around the middle", 0.5, 12, 640),
          block("cube of 3, 5 cells from the start", true, 5, 1),
          block("cube of 5, 10 cells from the start", true, 10, 2),
          block("cube of 5, 10 cells from the goal", false, 10, 2)};
}

struct Row {
  std::vector<double> afresh_ms;
  std::vector<double> repair_ms;
  std::vector<double> ratio;
  std::vector<double> expanded;
  std::vector<double> share;
};

/// Throws WrongAnswer if the two lengths differ.
void time_one(const Planner& astar, const Planner& dstar, const Map& map, const Kind& kind,
              std::uint64_t trial, Row& row) {
  const auto world = std::make_shared<const World>(world_of(map.cells));
  Request request = request_in(map, world);
  const auto session = dstar.begin(request);
  const PlanResult first = session->result();
  if (first.status != PlanStatus::solved) {
    return;
  }
  RandomStream random = RandomStream(trial).sub(kind.name);
  VoxelGrid cells = map.cells;
  if (kind.name != "no cell") {
    kind.edit(cells, map, first.route, random);
  }
  std::vector<Change> changes;
  Box box = Box::empty();
  for (const Cell& c : VoxelGrid::diff(map.cells, cells)) {
    box = box.united(cells.spec().cell_box(c));
  }
  changes.push_back({Change::Kind::set_cells, "cells", box});
  const auto changed = std::make_shared<const World>(world->with_replaced(
      {"cells", "voxel_map", std::make_shared<const kit::CellLayer>(std::move(cells)), true}));
  request.world = changed;
  // The new occupancy is computed once for both planners. It is in the cache of neither.
  kit::occupancy(request, kit::Lattice(request, Vec3::Ones(), kit::Neighbourhood::all, {}));
  PlanResult afresh;
  PlanResult repaired;
  const double plan_ms = ms_of([&] { afresh = astar.plan(request); });
  const double repair_ms = ms_of([&] {
    repaired = session->update(request.start, request.goal, changed, changes, request.budget);
  });
  row.afresh_ms.push_back(plan_ms);
  row.repair_ms.push_back(repair_ms);
  row.ratio.push_back(plan_ms / repair_ms);
  row.expanded.push_back(expanded(repaired));
  row.share.push_back(expanded(repaired) / expanded(first));
  const bool same =
      repaired.status == afresh.status && std::abs(length(repaired.route) - length(afresh.route)) <=
                                              1e-9 * std::max(1.0, length(afresh.route));
  if (!same) {
    throw WrongAnswer(map.name + ", " + kind.name + ": repaired " +
                      std::to_string(length(repaired.route)) + " m, planned afresh " +
                      std::to_string(length(afresh.route)) + " m");
  }
}

/// Medians over the maps.
Json first_plans(host::Registry& registry, const std::string& name, const std::vector<Map>& maps) {
  const auto astar = planner(registry, "astar {moves: cells}");
  const auto dstar = planner(registry, "dstar_lite {moves: cells}");
  std::vector<double> ratio;
  std::vector<double> dstar_ms;
  std::vector<double> expansions;
  for (const Map& map : maps) {
    const Request request = request_in(map, std::make_shared<const World>(world_of(map.cells)));
    const double by_astar = expanded(astar->plan(request));
    const double by_dstar = expanded(dstar->plan(request));
    std::vector<double> a;
    std::vector<double> d;
    for (int n = 0; n < 5; ++n) {
      a.push_back(ms_of([&] { astar->plan(request); }));
      d.push_back(ms_of([&] { dstar->plan(request); }));
    }
    ratio.push_back(median(d) / median(a));
    dstar_ms.push_back(median(d));
    expansions.push_back(by_dstar / std::max(by_astar, 1.0));
  }
  return {{"maps", name},
          {"ms", median(dstar_ms)},
          {"times_of_astar", median(ratio)},
          {"expansions_of_astar", median(expansions)}};
}

void time_all(Json& figures, host::Registry& registry, const std::string& name,
              const std::vector<Map>& maps, std::size_t trials) {
  figures["first_plans"].push_back(first_plans(registry, name, maps));
  const auto astar = planner(registry, "astar {moves: cells}");
  const auto dstar = planner(registry, "dstar_lite {moves: cells}");
  for (const Kind& kind : kinds()) {
    Row row;
    for (std::size_t trial = 0; trial < trials; ++trial) {
      time_one(*astar, *dstar, maps[trial % maps.size()], kind, trial, row);
    }
    if (row.ratio.empty()) {
      continue;
    }
    figures["repairs"].push_back({{"change", kind.name},
                                  {"maps", name},
                                  {"afresh_ms", median(row.afresh_ms)},
                                  {"repair_ms", median(row.repair_ms)},
                                  {"ratio", median(row.ratio)},
                                  {"min_tenth", quantile(row.ratio, 0.1)},
                                  {"minimum", quantile(row.ratio, 0)},
                                  {"expanded", median(row.expanded)},
                                  {"of_first_plan", median(row.share)}});
  }
}

struct Arguments {
  std::size_t trials = 20;
  std::vector<std::string> maps;
};

Json time_repairs(host::Registry& registry, const Arguments& arguments) {
  std::vector<Map> cities;
  for (int seed = 0; seed < int(std::min<std::size_t>(arguments.trials, 20)); ++seed) {
    cities.push_back(city(registry, seed));
  }
  Json figures;
  time_all(figures, registry, "complex cities", cities, arguments.trials);
  RandomStream random(1);
  for (const std::string& file : arguments.maps) {
    std::vector<Map> maps;
    for (int way = 0; way < 10; ++way) {
      if (auto map = voxel_map(registry, file, random)) {
        maps.push_back(*std::move(map));
      }
    }
    if (maps.empty()) {
      throw Error(file + ": found no way that takes a search");
    }
    time_all(figures, registry, maps.front().name, maps, arguments.trials);
  }
  return figures;
}
}  // namespace

void add_replan(Subcommands& all) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      all.add("replan", "compare repairs by dstar_lite with replanning by astar",
              [=](const Given& given) { return time_repairs(*given.registry, *arguments); });
  command.add_option("maps", arguments->maps, "Warframe .3dmap files to use besides the cities");
  command.add_option("--trials", arguments->trials, "number of changes of each kind")
      ->check(CLI::PositiveNumber);
}
}  // namespace altiplan::bench
