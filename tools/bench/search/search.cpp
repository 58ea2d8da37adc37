// SPDX-License-Identifier: Apache-2.0
// Grid planners compared with a plain A*, on one city in three sizes. A row is timed only after all
// its lengths have been compared.
#include <cmath>
#include <string>

#include "altiplan/kit/layers/cell_layer.hpp"
#include "altiplan/plan_result.hpp"
#include "altiplan/random.hpp"
#include "google_rows.hpp"
#include "paper_worlds.hpp"
#include "plain_astar.hpp"

namespace altiplan::bench {
namespace {

constexpr std::size_t kQueries = 16;

struct Query {
  Cell start;
  Cell goal;
  double length;  ///< found by the plain A*
};

/// Towers on three tenths of the ground, and queries across it whose routes are not straight.
/// Scaled by a whole number: the same city in smaller cells.
struct City {
  std::string name;
  std::shared_ptr<const World> world;
  std::vector<Query> queries;
  double plain_expanded = 0;

  const VoxelGrid& grid() const {
    return static_cast<const kit::CellLayer&>(*world->layers().front().environment).cells();
  }
  bool is_level() const { return grid().spec().counts[2] == 1; }

  City(std::string name_, Cell counts, int scale) : name(std::move(name_)) {
    GridSpec spec;
    spec.rule = GridSpec::Rule::native;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      spec.counts[axis] = axis == 2 && counts[2] == 1 ? 1 : counts[axis] * scale;
    }
    VoxelGrid cells(spec);
    RandomStream random{1};
    const auto below = [&](int n) { return int(random.integer(0, n - 1)); };
    const int towers = counts[0] * counts[1] / 80;  // 5 x 5 cells each, some overlapping
    for (int n = 0; n < towers; ++n) {
      const int i = below(counts[0] - 4);
      const int j = below(counts[1] - 4);
      const int height = counts[2] == 1 ? 1 : (1 + below(9 * counts[2] / 10)) * scale;
      for (int k = 0; k < height; ++k) {
        for (int row = j * scale; row < (j + 5) * scale; ++row) {
          cells.block_run(i * scale, (i + 5) * scale - 1, row, k);
        }
      }
    }
    find_queries(cells, counts, scale, random);
    const World empty;
    world = std::make_shared<const World>(
        empty.with({"city", "city", std::make_shared<kit::CellLayer>(std::move(cells))}));
  }

  void find_queries(const VoxelGrid& cells, const Cell& counts, int scale, RandomStream& random) {
    while (queries.size() < kQueries) {
      Query query{};
      for (Cell* c : {&query.start, &query.goal}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          // Close to the ground, among the towers.
          const int count = axis == 2 ? std::max(counts[2] / 4, 1) : counts[axis];
          (*c)[axis] = int(random.integer(0, count - 1)) *
                       (cells.spec().counts[2] == 1 && axis == 2 ? 1 : scale);
        }
      }
      const double apart =
          std::hypot(query.start[0] - query.goal[0], query.start[1] - query.goal[1]);
      if (cells.blocked(query.start) || cells.blocked(query.goal) ||
          apart < 0.5 * counts[0] * scale) {
        continue;
      }
      const PlainResult plain = plain_astar(cells, query.start, query.goal);
      if (plain.length < kInfinity) {
        query.length = plain.length;
        plain_expanded += double(plain.expanded);
        queries.push_back(query);
      }
    }
  }

  Request request(const Query& query) const {
    Request request;
    request.world = world;
    request.volume = grid().spec().box();
    request.start.position = grid().spec().centre(query.start);
    request.goal = {grid().spec().centre(query.goal), 0};
    if (is_level()) {
      request.level_m = request.start.position.z();
    }
    return request;
  }
};

void report(benchmark::State& state, double expanded) {
  using benchmark::Counter;
  state.counters["expanded"] = expanded / kQueries;
  // Inverted: time divided by number.
  state.counters["per_expansion"] =
      Counter(expanded / kQueries, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void add_plain_row(const std::shared_ptr<const City>& city) {
  benchmark::RegisterBenchmark((city->name + "/plain").c_str(), [city](benchmark::State& state) {
    std::size_t n = 0;
    for (auto _ : state) {
      const Query& query = city->queries[n++ % kQueries];
      benchmark::DoNotOptimize(plain_astar(city->grid(), query.start, query.goal));
    }
    report(state, city->plain_expanded);
  });
}

void add_row(const std::shared_ptr<const City>& city, const std::string& name,
             host::Registry& registry) {
  const std::shared_ptr<const Planner> planner = bench::planner(registry, name);
  const std::size_t before = allocated();
  double expanded = 0;
  for (std::size_t n = 0; n < kQueries; ++n) {
    const Request request = city->request(city->queries[n]);
    const PlanResult result = planner->plan(request);
    const std::string row = city->name + "/" + name + ": query " + std::to_string(n);
    const double way = solved_length(result, request, row);
    if (!(std::abs(way - city->queries[n].length) <= 1e-6 * way)) {
      throw WrongAnswer(row + " has the length " + std::to_string(way) + ", by the plain A* " +
                        std::to_string(city->queries[n].length));
    }
    expanded += counter(result, "expanded");
  }
  const double bytes_per_cell =
      double(allocated() - before) / double(city->grid().spec().cell_count());
  benchmark::RegisterBenchmark((city->name + "/" + name).c_str(), [=](benchmark::State& state) {
    std::size_t n = 0;
    for (auto _ : state) {
      const Query& query = city->queries[n++ % kQueries];
      benchmark::DoNotOptimize(planner->plan(city->request(query)));
    }
    report(state, expanded);
    state.counters["bytes_per_cell"] = bytes_per_cell;
  });
}

void add_rows(host::Registry& registry) {
  for (const int scale : {1, 2, 4}) {  // 1, 8 and 64 times the cells
    const std::string name = "city_3d/" + std::to_string(scale * scale * scale) + "x";
    const auto city = std::make_shared<const City>(name, Cell{64, 64, 64}, scale);
    add_row(city, "astar", registry);
    add_plain_row(city);
  }
  for (const int scale : {1, 3, 8}) {  // 1, 9 and 64 times the cells
    const std::string name = "city_2d/" + std::to_string(scale * scale) + "x";
    const auto city = std::make_shared<const City>(name, Cell{256, 256, 1}, scale);
    add_row(city, "astar", registry);
    add_row(city, "jps", registry);
    add_plain_row(city);
  }
}
}  // namespace

void add_search(Subcommands& all) {
  const auto paper_alone = std::make_shared<bool>(false);
  add_google(all, "search", "time grid planners against a plain A*, and on worlds of paper 002",
             [=](const Given& given) {
               add_paper_rows(given.registry);
               if (!*paper_alone) {
                 add_rows(*given.registry);
               }
             })
      .add_flag("--paper-worlds", *paper_alone,
                "only the worlds of the paper; the others take a minute to build and compare");
}
}  // namespace altiplan::bench
