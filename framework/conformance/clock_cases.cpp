// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <chrono>
#include <fstream>
#include <thread>

#include "maker.hpp"
#include "planner_bench.hpp"

namespace altiplan::conformance {
namespace {

using Clock = Budget::Clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

constexpr const char* kDeadline =
    "Planner contract 4: a deadline is overrun by at most 50 ms at the 99th percentile";
constexpr const char* kStop =
    "Planner contract 4: a stop is honoured within 50 ms at the 99th percentile";
constexpr const char* kSmootherDeadline = "Smoother: a deadline is overrun by at most 50 ms";
constexpr double kMaxLateMs = 50;

Clock::time_point after(double ms) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(Milliseconds(ms));
}

/// Milliseconds for which this thread was ready, but the machine ran others; 0 where the system
/// does not count them.
double kept_waiting() {
  std::ifstream counts("/proc/thread-self/schedstat");
  double ran_ns = 0;
  double waited_ns = 0;
  counts >> ran_ns >> waited_ns;
  return counts ? waited_ns / 1e6 : 0;
}

/// A clock that pauses while the machine lets this thread wait.
class FairClock {
 public:
  double ms() const {
    return Milliseconds(Clock::now() - from_).count() - (kept_waiting() - waited_);
  }

 private:
  double waited_ = kept_waiting();
  Clock::time_point from_ = Clock::now();
};

/// The minimum of three measurements, fewer if one is short enough: other load on the machine only
/// ever adds time, as memory and caches are shared.
template <class Measure>
double min_of_three(const Measure& measure) {
  double min_late_ms = measure();
  for (int again = 0; again < 2 && min_late_ms > kMaxLateMs; ++again) {
    min_late_ms = std::min(min_late_ms, measure());
  }
  return min_late_ms;
}

/// A million obstacles, and an unreachable goal.
Scene long_search(const PlannerBench& bench) {
  Scene scene = bench.budgeted(crowded_scene(bench.options.unit_m, bench.flight()));
  enclose_goal(scene);
  scene.request.budget.max_iterations = ~std::uint64_t(0);
  return scene;
}

void deadlines(const PlannerBench& bench, Report& report) {
  const auto planner = bench.make();
  Scene scene = long_search(bench);
  for (const double allowed : {0.0, 1.0, 3.0, 10.0, 30.0, 100.0}) {
    for (int n = 0; n < 5; ++n) {
      scene.request.random = RandomStream(bench.options.seed).sub("clock", std::uint64_t(n));
      std::string result_text;
      const double overrun = min_of_three([&] {
        const FairClock clock;
        scene.request.budget.deadline = after(allowed);
        const PlanResult result = planner->plan(scene.request);
        const double took = clock.ms();
        result_text = text(result);
        return took - allowed;
      });
      report.expect(overrun <= kMaxLateMs, kDeadline, [&] {
        return scene.name + ": of " + text(allowed) + " ms the planner took " +
               text(allowed + overrun) + " ms; it returned " + result_text;
      });
      if (overrun > kMaxLateMs) {
        break;  // the other tries would say the same
      }
    }
  }
}

void stops(const PlannerBench& bench, Report& report) {
  const auto planner = bench.make();
  Scene scene = long_search(bench);
  for (const int delay : {1, 20, 100}) {
    const double late = min_of_three([&] {
      std::stop_source source;
      scene.request.budget.stop = source.get_token();
      std::atomic<Clock::time_point> asked = Clock::now();
      const FairClock clock;
      std::jthread stopper([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(delay));
        asked = Clock::now();
        source.request_stop();
      });
      const auto from = Clock::now();
      (void)planner->plan(scene.request);
      const double took = clock.ms();
      stopper.join();
      return took - Milliseconds(asked.load() - from).count();
    });
    report.expect(late <= kMaxLateMs, kStop, [&] {
      return scene.name + ": stopped after " + std::to_string(delay) + " ms the planner took " +
             text(late) + " ms more";
    });
  }
}

void smoother_deadlines(const Factory<Smoother>& make, const Options& options, Report& report) {
  const auto smoother = make();
  Scene scene = crowded_scene(options.unit_m, Flight::spatial);
  // A walk back and forth between the obstacles.
  Polyline route;
  for (int i = 0; i <= 1000; ++i) {
    const double t = i / 1000.0;
    const Vec3 along = scene.request.start.position +
                       t * (scene.request.goal.position - scene.request.start.position);
    route.emplace_back(along + options.unit_m * Vec3(0, i % 2 == 0 ? 2 : -2, 0));
  }
  scene.request.start.position = route.front();
  scene.request.goal.position = route.back();
  scene.request.random = RandomStream(options.seed).sub("clock");
  for (const double allowed : {0.0, 5.0, 50.0}) {
    const double overrun = min_of_three([&] {
      const FairClock clock;
      scene.request.budget.deadline = after(allowed);
      (void)smoother->smooth(route, scene.request);
      return clock.ms() - allowed;
    });
    report.expect(overrun <= kMaxLateMs, kSmootherDeadline, [&] {
      return "a route of 1,001 points: of " + text(allowed) + " ms the smoother took " +
             text(allowed + overrun) + " ms";
    });
  }
}
}  // namespace

Cases clock_cases_of(const PluginEntry& entry, const Setup& setup) {
  const Options& options = setup.options;
  return with_factory(
      entry, setup.with,
      Overloaded{[&](const Factory<Planner>& make) {
                   const PlannerBench bench{make, options};
                   return Cases{make_case("deadlines_are_kept", kPlannerStatus,
                                          [bench](Report& report) { deadlines(bench, report); }),
                                make_case("stops_are_heeded_in_time", kPlannerStatus,
                                          [bench](Report& report) { stops(bench, report); })};
                 },
                 [&](const Factory<Smoother>& make) {
                   return Cases{make_case("deadlines_are_kept", kSmootherDeadline,
                                          [make, options](Report& report) {
                                            smoother_deadlines(make, options, report);
                                          })};
                 },
                 [](const auto&) { return Cases(); }});
}
}  // namespace altiplan::conformance
