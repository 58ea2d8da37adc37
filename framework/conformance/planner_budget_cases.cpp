// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <mutex>

#include "planner_bench.hpp"

namespace altiplan::conformance {
namespace {

/// The contract's bound, in iterations.
constexpr std::int64_t kStopWithin = 1024;

/// A large search space and no route.
Scene hopeless(const PlannerBench& bench) {
  Scene scene = bench.budgeted(open_scene(bench.options.unit_m, bench.flight()));
  enclose_goal(scene);
  return scene;
}

/// The same problem, with every query of its world reported.
Request watched(const Scene& scene, const Watched::Asked& asked) {
  World world;
  for (const Layer& layer : scene.request.world->layers()) {
    world = world.with(
        {layer.id, layer.plugin, std::make_shared<Watched>(layer.environment, asked), true});
  }
  Request request = scene.request;
  request.world = std::make_shared<const World>(std::move(world));
  return request;
}

/// Positions at which it queries the world, in order, with that budget.
std::vector<Vec3> queries_of(const PlannerBench& bench, const Scene& scene,
                             std::uint64_t iterations) {
  std::vector<Vec3> queries;
  std::mutex mutex;
  Request request = watched(scene, [&](const Vec3& at) {
    const std::lock_guard lock(mutex);
    queries.push_back(at);
  });
  request.budget.max_iterations = iterations;
  (void)bench.make()->plan(request);
  return queries;
}

/// Number of the queries of a larger budget made before the given iterations ended. Queries after a
/// search, for its message, differ from those with which the search continues.
std::size_t queries_within(const PlannerBench& bench, const Scene& scene, std::uint64_t iterations,
                           const std::vector<Vec3>& with_more) {
  const std::vector<Vec3> queries = queries_of(bench, scene, iterations);
  return std::size_t(
      std::mismatch(queries.begin(), queries.end(), with_more.begin(), with_more.end()).first -
      queries.begin());
}

void no_iterations(const PlannerBench& bench, Report& report) {
  for (Scene scene : {bench.budgeted(open_scene(bench.options.unit_m, bench.flight())),
                      bench.world(0, bench.flight()), bench.cells(0, bench.flight())}) {
    scene.request.budget.max_iterations = 0;
    const PlanResult result = bench.make()->plan(scene.request);
    report.expect(result.status == PlanStatus::timed_out && result.route.empty(), kPlannerBudget,
                  [&] {
                    return scene.name +
                           ", a budget of 0 iterations: expected timed_out, the planner returned " +
                           text(result);
                  });
  }
}

void iterations_kept(const PlannerBench& bench, Report& report) {
  for (Scene scene :
       {hopeless(bench), bench.world(0, bench.flight()), bench.cells(1, bench.flight())}) {
    // Also in each later phase of a larger budget: the planner may sample, then join, then search.
    const auto all = std::uint64_t(
        std::max(std::int64_t(0), counter(bench.make()->plan(scene.request).counters, "expanded")));
    for (const std::uint64_t max_iterations :
         {std::uint64_t(1), std::uint64_t(2), std::uint64_t(17), std::uint64_t(300),
          std::uint64_t(2000), all / 2, all * 3 / 4, all * 9 / 10, all - all / 100}) {
      scene.request.budget.max_iterations = max_iterations;
      const PlanResult result = bench.make()->plan(scene.request);
      judge(report, result, scene);
      const std::int64_t expanded = counter(result.counters, "expanded");
      report.expect(expanded <= std::int64_t(max_iterations), kPlannerBudget, [&] {
        return scene.name + ": of a budget of " + std::to_string(max_iterations) +
               " iterations the planner used " + std::to_string(expanded) +
               (expanded == std::int64_t(max_iterations) + 1
                    ? ": does it count one in `expanded` before it asks the budget for it?"
                    : "");
      });
      report.expect(result.status != PlanStatus::timed_out || result.budget_hit, kPlannerBudget,
                    [&] {
                      return scene.name + ": timed_out without budget_hit, of " +
                             std::to_string(max_iterations) + " iterations";
                    });
    }
  }
}

void stopped_before(const PlannerBench& bench, Report& report) {
  for (Scene scene : {hopeless(bench), bench.world(0, bench.flight())}) {
    std::stop_source source;
    source.request_stop();
    scene.request.budget.stop = source.get_token();
    const PlanResult result = bench.make()->plan(scene.request);
    judge(report, result, scene);
    report.expect(result.status == PlanStatus::cancelled || result.status == PlanStatus::solved ||
                      result.status == PlanStatus::no_route,
                  kPlannerBudget, [&] {
                    return scene.name + ", stopped before it begins: the planner returned " +
                           text(result);
                  });
    report.expect(counter(result.counters, "expanded") <= kStopWithin, kPlannerBudget, [&] {
      return scene.name + ", stopped before it begins: the planner went on for " +
             std::to_string(counter(result.counters, "expanded")) + " iterations";
    });
  }
}

/// The stop fires within a query of the world. Whether that query comes within so many iterations
/// is what a run with so many shows: equal requests do equal things.
void stopped_at_a_query(const PlannerBench& bench, Report& report) {
  const Scene scene = hopeless(bench);
  const std::vector<Vec3> queries = queries_of(bench, scene, bench.options.iterations);
  const std::size_t all = queries.size();
  for (const std::size_t query : {std::size_t(1), all / 3, 2 * all / 3}) {
    if (query < 1) {
      continue;
    }
    std::stop_source source;
    std::atomic<std::size_t> asked = 0;
    Request request = watched(scene, [&](const Vec3&) {
      if (++asked == query) {
        source.request_stop();
      }
    });
    request.budget.stop = source.get_token();
    const PlanResult result = bench.make()->plan(request);
    judge(report, result, scene);
    const std::int64_t expanded = counter(result.counters, "expanded");
    const std::int64_t too_early = expanded - kStopWithin - 1;
    const bool late =
        too_early > 0 && queries_within(bench, scene, std::uint64_t(too_early), queries) >= query;
    report.expect(!late, kPlannerBudget, [&] {
      return scene.name + ", stopped at query " + std::to_string(query) +
             " (by the end of iteration " + std::to_string(too_early) +
             "): the planner went on to iteration " + std::to_string(expanded);
    });
  }
}

class StopAt final : public Trace {
 public:
  explicit StopAt(std::int64_t event) : event_(event) {}
  void add(const TraceEvent& event) override {
    if (++events_ == event_) {
      source_.request_stop();
    } else if (events_ > event_ && event.kind == TraceEvent::Kind::expanded) {
      ++late_;
    }
  }
  std::stop_token token() const { return source_.get_token(); }
  std::int64_t late() const { return late_; }

 private:
  std::stop_source source_;
  std::int64_t event_;
  std::int64_t events_ = 0;
  std::int64_t late_ = 0;
};

void stopped_at_an_event(const PlannerBench& bench, Report& report) {
  Scene scene = hopeless(bench);
  for (const std::int64_t event : {1, 500, 2500}) {
    StopAt trace(event);
    scene.request.trace = &trace;
    scene.request.budget.stop = trace.token();
    const PlanResult result = bench.make()->plan(scene.request);
    judge(report, result, scene);
    report.expect(trace.late() <= kStopWithin, kPlannerBudget, [&] {
      return scene.name + ", stopped at trace event " + std::to_string(event) +
             ": the planner expanded " + std::to_string(trace.late()) + " more";
    });
  }
}
}  // namespace

Cases planner_budget_cases(const PlannerBench& bench) {
  return planner_cases_on(bench, {{"no_iterations_give_timed_out", no_iterations},
                                  {"iterations_are_kept", iterations_kept},
                                  {"stopped_before_it_begins", stopped_before},
                                  {"stopped_at_a_query_of_the_world", stopped_at_a_query},
                                  {"stopped_at_a_trace_event", stopped_at_an_event}});
}
}  // namespace altiplan::conformance
