// SPDX-License-Identifier: Apache-2.0
// The tree of `rrt` over real ground, the main layout of paper 000's page: whole plans, the cost of
// a threat that appears, and growth to a million nodes.
#include "host/mission/mission.hpp"
#include "reference/pop_ups.hpp"
#include "rows.hpp"

namespace altiplan::bench {
namespace {

constexpr std::uint64_t kSeeds = 100;
constexpr double kThreat = 2000;  // metres
constexpr double kRoom = 600;

const Request& main_layout() {
  static const Request kRequest =
      host::build_mission(
          host::load_config(
              std::filesystem::path(ALTIPLAN_CONFIGS) / "pipelines/rrt_jacksboro.yaml", {}),
          1)
          .request;
  return kRequest;
}

Request with_seed(std::uint64_t seed) {
  Request request = main_layout();
  request.random = RandomStream(seed);
  return request;
}

/// A row whose iteration times a case for each seed: median and 99th percentile in microseconds.
template <class Case>
void add_row(const std::string& name, const Case& time_case) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) {
                                 std::vector<double> times;
                                 for (auto _ : state) {
                                   double total = 0;
                                   for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
                                     times.push_back(time_case(seed));
                                     total += times.back();
                                   }
                                   state.SetIterationTime(total / double(kSeeds));
                                 }
                                 state.counters["median_us"] = 1e6 * median(times);
                                 state.counters["p99_us"] = 1e6 * quantile(times, 0.99);
                               })
      ->UseManualTime()
      ->Iterations(5)
      ->Unit(benchmark::kMicrosecond);
}

double time_plan(const Planner& planner, std::uint64_t seed) {
  const Request request = with_seed(seed);
  const double before = wall_s();
  const PlanResult result = planner.plan(request);
  const double time = wall_s() - before;
  solved_length(result, request, "rrt");
  return time;
}

double time_update(const Planner& planner, std::uint64_t seed) {
  Request request = with_seed(seed);
  const auto session = planner.begin(request);
  solved_length(session->result(), request, "rrt");
  const testing::PopUp pop_up = testing::draw_pop_up(session->result().route, request, kThreat,
                                                     kRoom, request.random.sub("pop-up"));
  request.world = pop_up.world;
  request.start = pop_up.state;
  const double before = wall_s();
  session->update(pop_up.state, request.goal, pop_up.world, std::span(&pop_up.change, 1), {});
  const double time = wall_s() - before;
  solved_length(session->result(), request, "rrt");
  return time;
}

/// No route is short enough, so the tree of the basic choice grows in all iterations; nodes per
/// second are the mean from the first to the last.
void grow(host::Registry& registry, benchmark::State& state, bool over_ground) {
  const auto tree = planner(registry,
                            "rrt {step_m: 150, weight_goal: 0, random_share: 1, max_failures: 0, "
                            "toward_goal_once: false, max_iterations: 100000000}");
  Request request = with_seed(1);
  request.limits = {};
  request.limits.max_route_length = 1;
  if (over_ground) {
    request.limits.min_ground_clearance = 150;
  } else {
    request.world = std::make_shared<const World>();
  }
  request.budget.max_iterations = std::uint64_t(state.range(0));
  PlanResult result;
  for (auto _ : state) {
    result = tree->plan(request);
  }
  const double nodes = counter(result, "nodes");
  state.counters["nodes"] = nodes;
  state.counters["nodes_per_s"] =
      benchmark::Counter(nodes, benchmark::Counter::kIsIterationInvariantRate);
}
}  // namespace

void add_tree_rows(host::Registry& registry) {
  const auto plain = planner(registry, "rrt {step_m: 150}");
  add_row("tree/plan", [=](std::uint64_t seed) { return time_plan(*plain, seed); });
  for (const std::string cut_off : {"afresh", "drop", "reconnect"}) {
    const auto rrt = planner(registry, "rrt {step_m: 150, cut_off: " + cut_off + "}");
    add_row("tree/threat/" + cut_off, [=](std::uint64_t seed) { return time_update(*rrt, seed); });
  }
  for (const bool over_ground : {false, true}) {
    benchmark::RegisterBenchmark(
        over_ground ? "tree/growth/ground" : "tree/growth/open",
        [=, &registry](benchmark::State& state) { grow(registry, state, over_ground); })
        ->RangeMultiplier(10)
        ->Range(1000, 1000000)
        ->Unit(benchmark::kMillisecond);
  }
}
}  // namespace altiplan::bench
