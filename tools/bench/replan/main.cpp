// SPDX-License-Identifier: Apache-2.0
// altiplan-replan: how long dstar_lite takes to repair its plan where cells change, beside astar
// planning afresh by cells in the same world. Each is timed once, one after the other, and every
// length is compared. Arguments: trials for each row (20), voxel maps (MovingAI .3dmap) to use
// beside the cities.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/kit/lattice/move_rules.hpp"
#include "altiplan/kit/layers/cell_layer.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/random.hpp"
#include "host/config/config.hpp"
#include "host/config/yaml.hpp"

namespace altiplan::bench {
namespace {

host::Registry& registry() {
  static host::Registry all(host::Registry::search_path({}));
  return all;
}

std::shared_ptr<const Planner> planner(const std::string& name, const std::string& with) {
  const Value parameters = host::parse_yaml(with, name);
  return host::plugin(registry(), "planner", name).planner(&parameters);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// On this thread's own clock: what else runs does not count.
double now_ms() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
}

double ms_of(const std::function<void()>& work) {
  const double before = now_ms();
  work();
  return now_ms() - before;
}

std::int64_t expanded(const PlanResult& result) {
  return result.counters.empty() ? 0 : result.counters.front().value;
}

/// A world of cells, and a way through it.
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

Map city(int seed) {
  const std::string with = "{generate: complex, seed: " + std::to_string(seed) + "}";
  const Value parameters = host::parse_yaml(with, "city");
  Site site;
  const World none;
  site.before = &none;
  GridSpec spec;
  spec.cell = Vec3::Constant(10);
  spec.counts = {80, 80, 100};
  spec.rule = GridSpec::Rule::native;
  site.start = spec.centre({1, 2, 4});
  site.goal = spec.centre({67, 64, 4});
  VoxelGrid cells(spec);
  host::plugin(registry(), "environment", "city").environment(&parameters, site)->rasterize(cells);
  return {"city " + std::to_string(seed), std::move(cells), {1, 2, 4}, {67, 64, 4}};
}

/// Free cells far apart that are not easily joined; nothing where many tries find none.
std::optional<Map> voxel_map(const std::string& file, RandomStream& random) {
  const Value parameters = host::parse_yaml("{file: '" + file + "'}", "voxel_map");
  Site site;
  const World none;
  site.before = &none;
  const auto layer =
      host::plugin(registry(), "environment", "voxel_map").environment(&parameters, site);
  VoxelGrid cells(*layer->native_grid());
  layer->rasterize(cells);
  Map map{file.substr(file.rfind('/') + 1), std::move(cells), {}, {}};
  const Cell& counts = map.cells.spec().counts;
  const auto draw = [&] {
    Cell c{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      c[axis] = int(random.integer(0, counts[axis] - 1));
    }
    return c;
  };
  const auto world = std::make_shared<const World>(world_of(map.cells));
  for (int tries = 0; tries < 1000; ++tries) {
    map.start = draw();
    map.goal = draw();
    const double apart = std::hypot(map.start[0] - map.goal[0], map.start[1] - map.goal[1]);
    if (map.cells.blocked(map.start) || map.cells.blocked(map.goal) || apart < 0.3 * counts[0]) {
      continue;
    }
    const PlanResult way = planner("astar", "{moves: cells}")->plan(request_in(map, world));
    if (way.status == Status::solved && expanded(way) > 5000) {
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

Cell random_cell(const GridSpec& spec, RandomStream& random) {
  Cell c{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    c[axis] = int(random.integer(0, spec.counts[axis] - 1));
  }
  return c;
}

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

/// As many cells of a box around a place that lies `share` of the way along the route.
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

/// Whether the two lengths are one.
bool time_one(const Planner& astar, const Planner& dstar, const Map& map, const Kind& kind,
              std::uint64_t trial, Row& row) {
  const auto world = std::make_shared<const World>(world_of(map.cells));
  Request request = request_in(map, world);
  const auto session = dstar.begin(request);
  const PlanResult first = session->result();
  if (first.status != Status::solved) {
    return true;
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
  // The new occupancy is made once, for both. Neither has its memory in the processor's caches.
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
  row.expanded.push_back(double(expanded(repaired)));
  row.share.push_back(double(expanded(repaired)) / double(expanded(first)));
  const bool same =
      repaired.status == afresh.status && std::abs(length(repaired.route) - length(afresh.route)) <=
                                              1e-9 * std::max(1.0, length(afresh.route));
  if (!same) {
    std::cerr << map.name << ", " << kind.name << ": repaired " << length(repaired.route)
              << " m, planned afresh " << length(afresh.route) << " m\n";
  }
  return same;
}

void first_plans(const std::vector<Map>& maps) {
  const auto astar = planner("astar", "{moves: cells}");
  const auto dstar = planner("dstar_lite", "{moves: cells}");
  std::vector<double> ratio;
  std::vector<double> dstar_ms;
  std::vector<double> expansions;
  for (const Map& map : maps) {
    const Request request = request_in(map, std::make_shared<const World>(world_of(map.cells)));
    const std::int64_t by_astar = expanded(astar->plan(request));
    const std::int64_t by_dstar = expanded(dstar->plan(request));
    std::vector<double> a;
    std::vector<double> d;
    for (int n = 0; n < 5; ++n) {
      a.push_back(ms_of([&] { astar->plan(request); }));
      d.push_back(ms_of([&] { dstar->plan(request); }));
    }
    ratio.push_back(median(d) / median(a));
    dstar_ms.push_back(median(d));
    expansions.push_back(double(by_dstar) / double(std::max<std::int64_t>(by_astar, 1)));
  }
  std::printf("first plan: %.3f ms, %.2f times astar's time, %.2f times its expansions (medians)\n",
              median(dstar_ms), median(ratio), median(expansions));
}

bool time_all(const std::string& name, const std::vector<Map>& maps, std::size_t trials) {
  std::printf("%s\n", name.c_str());
  first_plans(maps);
  std::printf(
      "| change | afresh, ms | repair, ms | ratio: median | least tenth | least | expanded | of "
      "the first plan |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  const auto astar = planner("astar", "{moves: cells}");
  const auto dstar = planner("dstar_lite", "{moves: cells}");
  bool same = true;
  for (const Kind& kind : kinds()) {
    Row row;
    for (std::size_t trial = 0; trial < trials; ++trial) {
      same = time_one(*astar, *dstar, maps[trial % maps.size()], kind, trial, row) && same;
    }
    if (row.ratio.empty()) {
      continue;
    }
    std::sort(row.ratio.begin(), row.ratio.end());
    std::printf("| %s | %.3f | %.4f | %.1f | %.1f | %.1f | %.0f | %.4f |\n", kind.name.c_str(),
                median(row.afresh_ms), median(row.repair_ms), median(row.ratio),
                row.ratio[row.ratio.size() / 10], row.ratio.front(), median(row.expanded),
                median(row.share));
    std::fflush(stdout);
  }
  return same;
}

bool run(int argc, char** argv) {
  const std::size_t trials = argc > 1 ? std::size_t(std::stoul(argv[1])) : 20;
  std::vector<Map> cities;
  for (int seed = 0; seed < int(std::min<std::size_t>(trials, 20)); ++seed) {
    cities.push_back(city(seed));
  }
  bool same = time_all("complex cities, 80 x 80 x 100 cells", cities, trials);
  RandomStream random(1);
  for (int n = 2; n < argc; ++n) {
    std::vector<Map> maps;
    for (int way = 0; way < 10; ++way) {
      if (auto map = voxel_map(argv[n], random)) {
        maps.push_back(*std::move(map));
      }
    }
    same = !maps.empty() && time_all(argv[n], maps, trials) && same;
  }
  return same;
}
}  // namespace
}  // namespace altiplan::bench

int main(int argc, char** argv) {
  try {
    return altiplan::bench::run(argc, argv) ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
}
