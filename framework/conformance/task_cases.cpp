// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "altiplan/environment.hpp"
#include "altiplan/flown_route.hpp"
#include "task_bench.hpp"

namespace altiplan::conformance {
namespace {

constexpr const char* kTaskPure =
    "Task contract 1: pure and const, callable from any number of threads";
constexpr const char* kClear = "Task contract 2: passes and joins do not cross obstacles()";
constexpr const char* kBudget =
    "Task contract 3: the budget is kept; more of it never makes the time longer";
constexpr const char* kBound =
    "Task contract 4: time_s is that of passes, joins and stops, and no order of the passes takes "
    "less than bound_s";

void is_clear(const TaskBench& bench, Report& report) {
  const auto task = bench.made();
  const Route route = task->order(bench.within(100), {}).route({}, bench.request);
  const std::shared_ptr<const Environment> solid = task->obstacles();
  for (std::size_t i = 1; i < route.size() && solid != nullptr; ++i) {
    report.expect(!solid->blocked(route[i - 1], route[i], 0), kClear, [&] {
      return "the leg from " + text(route[i - 1]) + " to " + text(route[i]) + " crosses one";
    });
  }
}

void keeps_budget(const TaskBench& bench, Report& report) {
  const auto task = bench.made();
  double time_s = kInfinity;
  for (const std::uint64_t iterations : {0, 1, 10, 100, 1000}) {
    const TaskOrder order = task->order(bench.within(iterations), {});
    if (order.status != PlanStatus::solved) {
      report.expect(!std::isfinite(time_s), kBudget,
                    [] { return "with more iterations it finds no order"; });
      continue;
    }
    report.expect(order.time_s <= time_s * (1 + 1e-12), kBudget, [&] {
      return "within " + std::to_string(iterations) + " iterations it takes " + text(order.time_s) +
             " s, within fewer " + text(time_s);
    });
    time_s = order.time_s;
  }
}

/// The same passes, shuffled and turned around, joined by straight legs that are not blocked.
void is_bounded(const TaskBench& bench, Report& report) {
  const auto task = bench.made();
  const TaskOrder order = task->order(bench.within(100), {});
  const double flown = flown_time(order.route({}, bench.request), bench.request);
  report.expect(std::abs(flown - order.time_s) <= 1e-6 * flown, kBound, [&] {
    return "its passes, joins and stops take " + text(flown) + " s, its time is " +
           text(order.time_s);
  });
  RandomStream random = bench.request.random.sub("shuffle");
  const std::shared_ptr<const Environment> solid = task->obstacles();
  for (int n = 0; n < 20 * bench.options.rounds; ++n) {
    TaskOrder other = order;
    other.last_join.clear();
    // Nearby orders: a few neighbours change places, or a pass turns around.
    for (int k = 0; k < 1 + n % 3 && other.passes.size() > 2; ++k) {
      const auto at = std::size_t(random.uniform() * double(other.passes.size() - 1));
      std::swap(other.passes[at], other.passes[std::min(at + 1, other.passes.size() - 1)]);
      std::reverse(other.passes[at].points.begin(), other.passes[at].points.end());
    }
    for (Pass& pass : other.passes) {
      pass.join.clear();
    }
    const Route route = other.route({}, bench.request);
    bool valid = true;
    for (std::size_t i = 1; i < route.size() && solid != nullptr; ++i) {
      valid = valid && !solid->blocked(route[i - 1], route[i], 0);
    }
    const double takes = flown_time(route, bench.request);
    report.expect(!valid || takes >= order.bound_s * (1 - 1e-9), kBound, [&] {
      return "the passes in another order take " + text(takes) + " s, its bound is " +
             text(order.bound_s);
    });
  }
}

void pure(const TaskBench& bench, Report& report) {
  const std::string first = bench.answers(*bench.made());
  const auto task = bench.made();
  std::string one;
  std::string other;
  in_two_threads([&] { one = bench.answers(*task); }, [&] { other = bench.answers(*task); });
  report.expect(first == one && one == other, kTaskPure,
                [] { return "two objects, or two threads, get different answers"; });
}
}  // namespace

Cases task_cases(const TaskFactory& make, const Options& options,
                 const std::shared_ptr<const World>& before) {
  const TaskBench bench(make, options, before);
  return {
      make_case("is_clear", kClear, [bench](Report& report) { is_clear(bench, report); }),
      make_case("keeps_budget", kBudget, [bench](Report& report) { keeps_budget(bench, report); }),
      make_case("is_bounded", kBound, [bench](Report& report) { is_bounded(bench, report); }),
      make_case("same_answers", kTaskPure, [bench](Report& report) { pure(bench, report); })};
}
}  // namespace altiplan::conformance
