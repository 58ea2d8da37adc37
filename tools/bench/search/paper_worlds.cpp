// SPDX-License-Identifier: Apache-2.0
#include "paper_worlds.hpp"

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "altiplan/route.hpp"
#include "host/config/config.hpp"
#include "host/mission/mission.hpp"
#include "measuring.hpp"

namespace altiplan::bench {
namespace {

constexpr const char* kAngles = "pipelines/fusion_paper_astar_angles.yaml";
constexpr int kWorlds = 100;

using Registry = std::shared_ptr<host::Registry>;

/// The problem of the row "A*, 55/15" in a scenario of the paper.
Request problem(const Registry& registry, const char* scenario, std::int64_t seed) {
  const std::filesystem::path configs = ALTIPLAN_CONFIGS;
  host::Overrides overrides;
  overrides.scenario = configs / "scenarios" / scenario;
  overrides.seed = seed;
  const host::Config config = host::load_config(configs / kAngles, overrides, registry);
  return host::build_mission(config, 1).request;
}

std::unique_ptr<Smoother> smoother(host::Registry& registry, const std::string& name) {
  const Chosen of = chosen(registry, "smoother", name);
  return of.entry.smoother(&of.parameters);
}

PlanResult solved(const Planner& planner, const Request& request) {
  PlanResult result = planner.plan(request);
  if (result.status != PlanStatus::solved) {
    throw WrongAnswer("a problem of paper 002 is not solved: " + result.message);
  }
  return result;
}

void add_fitted_row(const Registry& registry, const std::string& name,
                    const std::shared_ptr<const Request>& request, const std::string& text,
                    bool smoothed = false) {
  const std::shared_ptr<const Planner> planner = bench::planner(*registry, text);
  benchmark::RegisterBenchmark(("fusion_fitted/" + name).c_str(), [=](benchmark::State& state) {
    const auto prune = smoother(*registry, "prune");
    const auto bspline = smoother(*registry, "bspline");
    PlanResult result;
    for (auto _ : state) {
      result = solved(*planner, *request);
      if (smoothed) {
        result.route = prune->smooth(result.route, *request).route;
        result.route = bspline->smooth(result.route, *request).route;
      }
    }
    state.counters["expanded"] = counter(result, "expanded");
    state.counters["length_km"] = length(result.route) / 1000;
  })->Unit(benchmark::kMillisecond);
}

double seconds(const Planner& planner, const Request& request) {
  const double before = thread_s();
  benchmark::DoNotOptimize(planner.plan(request));
  return thread_s() - before;
}

/// Time of one planner over that of another on the random worlds, world by world: the median over
/// the worlds of the ratio of the medians of three alternating passes.
void add_ratio_row(const Registry& registry, const std::string& name, const std::string& of_text,
                   const std::string& over_text) {
  const std::shared_ptr<const Planner> of = planner(*registry, of_text);
  const std::shared_ptr<const Planner> over = planner(*registry, over_text);
  benchmark::RegisterBenchmark(
      ("fusion_random/" + name).c_str(),
      [=](benchmark::State& state) {
        std::vector<double> ratios;
        std::vector<double> of_s;
        for (auto _ : state) {
          for (int seed = 1; seed <= kWorlds; ++seed) {
            const Request request = problem(registry, "fusion_random.yaml", seed);
            const double way = length(solved(*of, request).route);
            const double other = length(solved(*over, request).route);
            if (std::abs(way - other) > 1e-9 * way) {
              throw WrongAnswer(name + ", seed " + std::to_string(seed) + ": lengths of " +
                                std::to_string(way) + " and " + std::to_string(other));
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

void add_paper_rows(const std::shared_ptr<host::Registry>& registry) {
  const auto fitted = std::make_shared<const Request>(problem(registry, "fusion_fitted.yaml", 1));
  const std::string cells = " {cell_m: [1000, 1000, 200], ";
  const std::string octile = cells + "heuristic: octile}";
  const std::string headings = cells + "heuristic: octile, state: cell_and_heading}";
  const std::string tuned = cells + "heuristic: manhattan, weight_g: 0.7, weight_h: 0.3}";
  add_fitted_row(registry, "astar_octile", fitted, "astar" + octile);
  add_fitted_row(registry, "astar_cell_and_heading", fitted, "astar" + headings);
  add_fitted_row(registry, "bidirectional_octile", fitted, "bidirectional_astar" + octile);
  add_fitted_row(registry, "bidirectional_cell_and_heading", fitted,
                 "bidirectional_astar" + headings);
  add_fitted_row(registry, "plan", fitted, "astar" + tuned);
  add_fitted_row(registry, "plan_and_smooth", fitted, "astar" + tuned, true);
  add_ratio_row(registry, "bidirectional_over_astar", "bidirectional_astar" + octile,
                "astar" + octile);
}
}  // namespace altiplan::bench
