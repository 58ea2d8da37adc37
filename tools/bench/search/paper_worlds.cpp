// SPDX-License-Identifier: Apache-2.0
#include "paper_worlds.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "altiplan/error.hpp"
#include "altiplan/route.hpp"
#include "host/config/config.hpp"
#include "host/mission/mission.hpp"

namespace altiplan::bench {
namespace {

constexpr const char* kAngles = "pipelines/fusion_paper_astar_angles.yaml";
constexpr int kWorlds = 100;

std::shared_ptr<host::Registry> registry() {
  static const auto shared = std::make_shared<host::Registry>(host::Registry::search_path({}));
  return shared;
}

/// The problem of the row "A*, 55/15" in a scenario of the paper.
Request problem(const char* scenario, std::int64_t seed) {
  const std::filesystem::path configs = ALTIPLAN_CONFIGS;
  host::Overrides overrides;
  overrides.scenario = configs / "scenarios" / scenario;
  overrides.seed = seed;
  const host::Config config = host::load_config(configs / kAngles, overrides, registry());
  return host::build_mission(config, 1).request;
}

/// Parameters as written on the command line: {"heuristic", "octile"}.
using Texts = std::vector<std::pair<std::string, std::string>>;

Value parameters(Texts texts) {
  Value map;
  map.kind = Value::Kind::map;
  Value cell;
  cell.kind = Value::Kind::list;
  for (const char* edge : {"1000", "1000", "200"}) {
    Value number;
    number.text = edge;
    cell.items.push_back(number);
  }
  map.entries.push_back({"cell_m", {}, std::move(cell)});
  for (auto& [key, text] : texts) {
    Value value;
    value.text = std::move(text);
    map.entries.push_back({key, {}, std::move(value)});
  }
  return map;
}

std::shared_ptr<const Planner> planner(const std::string& name, Texts texts) {
  const Value value = parameters(std::move(texts));
  return host::plugin(*registry(), "planner", name).planner(&value);
}

std::shared_ptr<const Smoother> smoother(const std::string& name) {
  Value map;
  map.kind = Value::Kind::map;
  return host::plugin(*registry(), "smoother", name).smoother(&map);
}

double expanded(const PlanResult& result) {
  for (const Counter& counter : result.counters) {
    if (counter.name == "expanded") {
      return double(counter.value);
    }
  }
  return 0;
}

PlanResult solved(const Planner& planner, const Request& request) {
  PlanResult result = planner.plan(request);
  if (result.status != Status::solved) {
    throw Error("a problem of paper 002 is not solved: " + result.message);
  }
  return result;
}

void add_fitted_row(const std::string& name, const std::shared_ptr<const Request>& request,
                    std::shared_ptr<const Planner> planner, bool smoothed) {
  benchmark::RegisterBenchmark(("fusion_fitted/" + name).c_str(), [=](benchmark::State& state) {
    const auto prune = smoother("prune");
    const auto bspline = smoother("bspline");
    PlanResult result;
    for (auto _ : state) {
      result = solved(*planner, *request);
      if (smoothed) {
        result.route = prune->smooth(result.route, *request).route;
        result.route = bspline->smooth(result.route, *request).route;
      }
    }
    state.counters["expanded"] = expanded(result);
    state.counters["length_km"] = length(result.route) / 1000;
  })->Unit(benchmark::kMillisecond);
}

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

double seconds(const Planner& planner, const Request& request) {
  const double before = thread_seconds();
  benchmark::DoNotOptimize(planner.plan(request));
  return thread_seconds() - before;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// Time of one planner over that of another on the random worlds, world by world: the median over
/// the worlds of the ratio of the medians of three alternating passes.
void add_ratio_row(const std::string& name, std::shared_ptr<const Planner> of,
                   std::shared_ptr<const Planner> over) {
  benchmark::RegisterBenchmark(("fusion_random/" + name).c_str(),
                               [=](benchmark::State& state) {
                                 std::vector<double> ratios;
                                 std::vector<double> of_s;
                                 for (auto _ : state) {
                                   for (int seed = 1; seed <= kWorlds; ++seed) {
                                     const Request request = problem("fusion_random.yaml", seed);
                                     const double way = length(solved(*of, request).route);
                                     const double other = length(solved(*over, request).route);
                                     if (std::abs(way - other) > 1e-9 * way) {
                                       throw Error(name + ", seed " + std::to_string(seed) +
                                                   ": lengths of " + std::to_string(way) + " and " +
                                                   std::to_string(other));
                                     }
                                     std::vector<double> ours;
                                     std::vector<double> theirs;
                                     for (int pass = 0; pass < 3; ++pass) {
                                       ours.push_back(seconds(*of, request));
                                       theirs.push_back(seconds(*over, request));
                                     }
                                     ratios.push_back(median(ours) / median(theirs));
                                     of_s.push_back(median(ours));
                                   }
                                 }
                                 state.counters["ratio"] = median(ratios);
                                 state.counters["median_ms"] = 1000 * median(of_s);
                               })
      ->Unit(benchmark::kMillisecond)
      ->Iterations(1);
}
}  // namespace

void add_paper_rows() {
  const auto fitted = std::make_shared<const Request>(problem("fusion_fitted.yaml", 1));
  const auto one_way = planner("astar", {{"heuristic", "octile"}});
  add_fitted_row("astar_octile", fitted, one_way, false);
  add_fitted_row("astar_cell_and_heading", fitted,
                 planner("astar", {{"heuristic", "octile"}, {"state", "cell_and_heading"}}), false);
  add_fitted_row("bidirectional_octile", fitted,
                 planner("bidirectional_astar", {{"heuristic", "octile"}}), false);
  add_fitted_row(
      "bidirectional_cell_and_heading", fitted,
      planner("bidirectional_astar", {{"heuristic", "octile"}, {"state", "cell_and_heading"}}),
      false);
  const Texts tuned = {{"heuristic", "manhattan"}, {"weight_g", "0.7"}, {"weight_h", "0.3"}};
  add_fitted_row("plan", fitted, planner("astar", tuned), false);
  add_fitted_row("plan_and_smooth", fitted, planner("astar", tuned), true);
  add_ratio_row("bidirectional_over_astar",
                planner("bidirectional_astar", {{"heuristic", "octile"}}), one_way);
}
}  // namespace altiplan::bench
