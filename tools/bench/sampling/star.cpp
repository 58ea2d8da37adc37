// SPDX-License-Identifier: Apache-2.0
// RRT* compared with OMPL's in equal time, and with its BIT* in four times the time.
#include <chrono>

#include "city.hpp"
#include "ompl_planners.hpp"
#include "rows.hpp"

namespace altiplan::bench {
namespace {

constexpr std::size_t kQueries = 24;
constexpr double kRange = 10;  // cells
constexpr double kShort = 0.05;
constexpr double kLong = 0.2;

struct Ours {
  double length = 0;
  double nodes = 0;
};

Ours plan(const Planner& planner, Request query) {
  using Clock = Budget::Clock;
  query.budget.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                             std::chrono::duration<double>(kShort));
  const PlanResult result = planner.plan(query);
  query.budget.deadline.reset();
  return {judged_length(result, query, "star"), counter(result, "nodes")};
}

/// One iteration plans every query by all; medians over the queries.
void add_star_row(host::Registry& registry, const std::string& name, bool low,
                  const std::string& plugin, const std::string& peer, OmplCheck how) {
  benchmark::RegisterBenchmark(
      name.c_str(),
      [=, &registry](benchmark::State& state) {
        const City city(low, kQueries);
        const Request& first = city.queries().front();
        const auto ours = planner(registry, plugin + " {range_m: 10, max_iterations: 2000000000}");
        OmplPlanner star(peer, first, how, kRange);
        OmplPlanner bit("BITstar", first, how, 0);
        std::vector<double> nodes;
        std::vector<double> ompl_nodes;
        std::vector<double> more_nodes;
        std::vector<double> over_star;
        std::vector<double> over_bit;
        for (auto _ : state) {
          for (const Request& query : city.queries()) {
            const Ours mine = plan(*ours, query);
            const OmplResult its = star.solve(query, kShort, true);
            const OmplResult batch = bit.solve(query, kLong, true);
            nodes.push_back(mine.nodes);
            ompl_nodes.push_back(double(its.nodes));
            more_nodes.push_back(mine.nodes / double(its.nodes));
            over_star.push_back(mine.length / its.length);
            over_bit.push_back(mine.length / batch.length);
          }
        }
        state.counters["nodes"] = median(nodes);
        state.counters["ompl_nodes"] = median(ompl_nodes);
        state.counters["more_nodes"] = median(more_nodes);
        state.counters["over_star"] = median(over_star);
        state.counters["over_bit"] = median(over_bit);
        state.counters["over_bit_p90"] = quantile(over_bit, 0.9);
      })
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
}
}  // namespace

void add_star_rows(host::Registry& registry) {
  for (const bool low : {false, true}) {
    for (const auto& [plugin, peer] :
         {std::pair("rrt_star", "RRTstar"), std::pair("informed_rrt_star", "InformedRRTstar")}) {
      const std::string name = std::string(low ? "star/low/" : "star/city/") + plugin;
      add_star_row(registry, name, low, plugin, peer, OmplCheck::samples);
      add_star_row(registry, name + "/ompl_our_legs", low, plugin, peer, OmplCheck::legs);
    }
  }
}
}  // namespace altiplan::bench
