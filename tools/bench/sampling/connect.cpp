// SPDX-License-Identifier: Apache-2.0
// RRT-Connect compared with OMPL's, whole plans: ours with all checks of the request, OMPL's
// `solve` alone.
#include <functional>

#include "city.hpp"
#include "ompl_planners.hpp"
#include "rows.hpp"

namespace altiplan::bench {
namespace {

constexpr std::size_t kQueries = 64;
constexpr std::uint64_t kSeeds = 32;
constexpr double kRange = 10;  // cells

/// The queries of both kinds, created on first use.
const City& city(bool low) {
  static const City kCity(false, kQueries);
  static const City kLow(true, kQueries);
  return low ? kLow : kCity;
}

/// Seconds of one plan of a query with a seed.
using Plan = std::function<double(const Request& query, std::uint64_t seed)>;

/// A row whose iteration plans each query with each seed: the median and the 95th percentile of the
/// times, in microseconds, and the share of the queries whose straight leg is free. `make` creates
/// the planning function.
template <class Make>
void add_row(const std::string& name, bool low, const Make& make) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) {
                                 const std::vector<Request>& queries = city(low).queries();
                                 const Plan plan = make();
                                 std::vector<double> seconds;
                                 for (auto _ : state) {
                                   double total = 0;
                                   for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
                                     for (const Request& query : queries) {
                                       seconds.push_back(plan(query, seed));
                                       total += seconds.back();
                                     }
                                   }
                                   state.SetIterationTime(total / double(kSeeds * queries.size()));
                                 }
                                 state.counters["median_us"] = 1e6 * median(seconds);
                                 state.counters["p95_us"] = 1e6 * quantile(seconds, 0.95);
                                 state.counters["straight"] =
                                     double(city(low).open()) / double(queries.size());
                               })
      ->UseManualTime()
      ->Iterations(1)
      ->Unit(benchmark::kMicrosecond);
}

Plan ours(host::Registry& registry, bool low) {
  const auto connect = planner(registry, "rrt_connect {range_m: 10}");
  for (const Request& query : city(low).queries()) {
    solved_length(connect->plan(query), query, "connect");
  }
  return [connect](const Request& query, std::uint64_t seed) {
    Request seeded = query;
    seeded.random = RandomStream(seed);
    const double before = wall_s();
    benchmark::DoNotOptimize(connect->plan(seeded));
    return wall_s() - before;
  };
}

Plan its(bool low, OmplCheck how) {
  const auto peer =
      std::make_shared<OmplPlanner>("RRTConnect", city(low).queries().front(), how, kRange);
  return
      [peer](const Request& query, std::uint64_t) { return peer->solve(query, 10, false).seconds; };
}
}  // namespace

void add_connect_rows(host::Registry& registry) {
  for (const bool low : {false, true}) {
    const std::string of = low ? "connect/low" : "connect/city";
    add_row(of + "/altiplan", low, [&registry, low] { return ours(registry, low); });
    add_row(of + "/ompl", low, [low] { return its(low, OmplCheck::samples); });
    add_row(of + "/ompl_our_legs", low, [low] { return its(low, OmplCheck::legs); });
  }
}
}  // namespace altiplan::bench
