// SPDX-License-Identifier: Apache-2.0
// RRT* beside OMPL's in equal time, and beside its BIT* in four times the time.
#include <chrono>

#include "altiplan/check.hpp"
#include "altiplan/route.hpp"
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
  Ours ours;
  if (result.status == Status::solved && !check(result.route, query).ok()) {
    throw Error("star: a route that the judge refuses");
  }
  ours.length = result.status == Status::solved ? length(result.route) : kInfinity;
  for (const Counter& counter : result.counters) {
    ours.nodes = counter.name == "nodes" ? double(counter.value) : ours.nodes;
  }
  return ours;
}

/// One iteration plans every query by all; medians over the queries.
void add_star_row(const std::string& name, bool low, const std::string& plugin,
                  const std::string& peer, OmplCheck how) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) {
                                 const City city(low, kQueries);
                                 const Request& first = city.queries().front();
                                 const auto ours =
                                     planner(plugin, "{range_m: 10, max_iterations: 2000000000}");
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
                                 state.counters["nodes"] = quantile(nodes, 0.5);
                                 state.counters["ompl_nodes"] = quantile(ompl_nodes, 0.5);
                                 state.counters["more_nodes"] = quantile(more_nodes, 0.5);
                                 state.counters["over_star"] = quantile(over_star, 0.5);
                                 state.counters["over_bit"] = quantile(over_bit, 0.5);
                                 state.counters["over_bit_p90"] = quantile(over_bit, 0.9);
                               })
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
}
}  // namespace

void add_star_rows() {
  for (const bool low : {false, true}) {
    for (const auto& [plugin, peer] :
         {std::pair("rrt_star", "RRTstar"), std::pair("informed_rrt_star", "InformedRRTstar")}) {
      const std::string name = std::string(low ? "star/low/" : "star/city/") + plugin;
      add_star_row(name, low, plugin, peer, OmplCheck::samples);
      add_star_row(name + "/ompl_our_legs", low, plugin, peer, OmplCheck::legs);
    }
  }
}
}  // namespace altiplan::bench
