// SPDX-License-Identifier: Apache-2.0
// A suite that cannot fail is worth nothing: planners broken on purpose, a law each.
#include <atomic>
#include <stdexcept>

#include "catches.hpp"
#include "support/support.hpp"

namespace altiplan::conformance {
namespace {

using Breaks = std::function<PlanResult(const Planner& good, const Request& request)>;

PlanResult plain(const Planner& good, const Request& request) { return good.plan(request); }

/// A sound planner whose answers a test spoils.
class Spoiled final : public Planner {
 public:
  Spoiled(Breaks breaks, Traits traits, const std::string& yaml)
      : good_(testing::make_planner("astar", yaml)), breaks_(std::move(breaks)), traits_(traits) {}

 private:
  PlanResult do_plan(const Request& request) const override { return breaks_(*good_, request); }
  Traits do_traits() const override { return traits_; }

  std::unique_ptr<Planner> good_;
  Breaks breaks_;
  Traits traits_;
};

const std::string kCells = "{cell_m: [50, 50, 50]}";

Options few() {
  Options options;
  options.rounds = 4;
  options.calls = 60;
  return options;
}

Cases spoiled(Breaks breaks, Traits traits = {}, const std::string& yaml = kCells) {
  return planner_cases([breaks = std::move(breaks), traits,
                        yaml] { return std::make_unique<Spoiled>(breaks, traits, yaml); },
                       few());
}

PlanResult with(PlanResult result, const std::function<void(PlanResult&)>& change) {
  if (result.status == Status::solved) {
    change(result);
  }
  return result;
}

TEST(CatchesPlanner, NothingInASoundOne) {
  Traits traits;
  traits.complete = true;
  traits.optimal = true;
  expect_clean("astar", spoiled(plain, traits));
}

TEST(CatchesPlanner, WrongEnds) {
  for (const bool first : {true, false}) {
    expect_caught(first ? "start" : "goal", spoiled([first](const Planner& good, const Request& r) {
                    return with(good.plan(r), [&](PlanResult& result) {
                      (first ? result.route.front() : result.route.back()).x() += 1e-3;
                    });
                  }),
                  "Planner law 1");
  }
}

TEST(CatchesPlanner, UnsoundLegs) {
  expect_caught("straight through", spoiled([](const Planner& good, const Request& request) {
                  return with(good.plan(request), [](PlanResult& result) {
                    result.route = {result.route.front(), result.route.back()};
                  });
                }),
                "Planner law 2");
  expect_caught("straight through, far from the origin",
                spoiled([](const Planner& good, const Request& request) {
                  return with(good.plan(request), [](PlanResult& result) {
                    if (result.route.front().y() > 1e6) {
                      result.route = {result.route.front(), result.route.back()};
                    }
                  });
                }),
                "Planner law 2");
  // Each rule in turn is not told to the sound planner.
  const std::vector<std::pair<const char*, void (*)(Request&)>> forgotten{
      {"climb", [](Request& r) { r.limits.max_climb = kPi / 2; }},
      {"turn", [](Request& r) { r.limits.max_turn_horizontal = kPi; }},
      {"turn in space", [](Request& r) { r.limits.max_turn_space = kPi; }},
      {"turn radius", [](Request& r) { r.limits.min_turn_radius = 0; }},
      {"clearance", [](Request& r) { r.limits.min_clearance = r.vehicle.radius_m = 0; }},
      {"longest leg", [](Request& r) { r.limits.max_leg = kInfinity; }},
      {"shortest leg", [](Request& r) { r.limits.min_leg = 0; }},
      {"altitude", [](Request& r) { r.limits.altitude.clear(); }},
      {"route length", [](Request& r) { r.limits.max_route_length = kInfinity; }},
      {"ground clearance", [](Request& r) { r.limits.min_ground_clearance.reset(); }},
      {"level", [](Request& r) { r.level_m.reset(); }}};
  // Small cells turn and climb anyhow; large ones make long legs.
  for (const auto& [rule, forget] : forgotten) {
    const std::string yaml =
        rule == std::string("longest leg") ? "{cell_m: [260, 260, 60]}" : "{cell_m: [20, 20, 30]}";
    expect_caught(std::string("forgets ") + rule,
                  spoiled(
                      [forget = forget](const Planner& good, const Request& request) {
                        Request told = request;
                        forget(told);
                        return good.plan(told);
                      },
                      {}, yaml),
                  "Planner law 2");
  }
}

TEST(CatchesPlanner, WrongStatus) {
  expect_caught("throws", spoiled([](const Planner&, const Request&) -> PlanResult {
                  throw std::runtime_error("lost");
                }),
                "Planner law 3");
  expect_caught("throws under a limit", spoiled([](const Planner& good, const Request& request) {
                  if (request.limits.max_climb < 1) {
                    throw 42;
                  }
                  return good.plan(request);
                }),
                "Planner law 3");
  expect_caught("solved without a route", spoiled([](const Planner& good, const Request& request) {
                  return with(good.plan(request), [](PlanResult& result) { result.route.clear(); });
                }),
                "Planner law 3");
  expect_caught("a route without solved", spoiled([](const Planner& good, const Request& request) {
                  return with(good.plan(request),
                              [](PlanResult& result) { result.status = Status::timed_out; });
                }),
                "Planner law 3");
  expect_caught("a flight's status", spoiled([](const Planner& good, const Request& request) {
                  PlanResult result = good.plan(request);
                  if (result.status == Status::no_route) {
                    result.status = Status::not_reached;
                  }
                  return result;
                }),
                "Planner law 3");
  expect_caught("proves what is not so", spoiled([](const Planner&, const Request&) {
                  PlanResult result;
                  result.status = Status::no_route;
                  result.proved = true;
                  return result;
                }),
                "Planner law 3: no_route is `proved`");
}

TEST(CatchesPlanner, BudgetsNotKept) {
  expect_caught("ignores iterations", spoiled([](const Planner& good, const Request& request) {
                  Request told = request;
                  told.budget.max_iterations = ~std::uint64_t{0};
                  return good.plan(told);
                }),
                "Planner law 4");
  expect_caught("one iteration too many", spoiled([](const Planner& good, const Request& request) {
                  Request told = request;
                  ++told.budget.max_iterations;
                  return good.plan(told);
                }),
                "Planner law 4");
  const Breaks deaf = [](const Planner& good, const Request& request) {
    Request told = request;
    told.budget.stop = {};
    return good.plan(told);
  };
  expect_caught("deaf to the stop token", spoiled(deaf, {}, "{cell_m: [25, 25, 25]}"),
                "Planner law 4");
  expect_caught("deaf once it has begun",
                spoiled(
                    [deaf](const Planner& good, const Request& request) {
                      return request.budget.stop.stop_requested() ? good.plan(request)
                                                                  : deaf(good, request);
                    },
                    {}, "{cell_m: [25, 25, 25]}"),
                "Planner law 4");
  expect_caught("counts nothing", spoiled([](const Planner& good, const Request& request) {
                  return with(good.plan(request),
                              [](PlanResult& result) { result.counters.clear(); });
                }),
                "Planner law 4");
}

TEST(CatchesPlanner, AnswersThatDepend) {
  const auto noted = [](PlanResult result, std::int64_t value) {
    result.counters.push_back({"noted", value});
    return result;
  };
  static std::atomic<std::int64_t> calls = 0;
  expect_caught("on how often it was asked",
                spoiled([noted](const Planner& good, const Request& request) {
                  return noted(good.plan(request), ++calls / 50);
                }),
                "Planner law 5");
  expect_caught("on the number of threads",
                spoiled([noted](const Planner& good, const Request& request) {
                  return noted(good.plan(request), request.threads);
                }),
                "Planner law 5");
  expect_caught("on what was asked before",
                spoiled([noted](const Planner& good, const Request& request) {
                  static std::atomic<double> last = 0;
                  const double before = last.exchange(request.start.position.x());
                  return noted(good.plan(request), before != request.start.position.x());
                }),
                "Planner law 5");
  expect_caught("writes into its request", spoiled([](const Planner& good, const Request& request) {
                  PlanResult result = good.plan(request);
                  const_cast<Request&>(request).limits.min_clearance += 1;
                  return result;
                }),
                "Planner law 5");
}

TEST(CatchesPlanner, TraitsNotHeld) {
  Traits complete;
  complete.complete = true;
  expect_caught("gives up early",
                spoiled(
                    [](const Planner& good, const Request& request) {
                      PlanResult result = good.plan(request);
                      if (result.route.size() > 9) {
                        result = {};
                        result.status = Status::no_route;
                      }
                      return result;
                    },
                    complete),
                "Planner trait `complete`");
  expect_caught("calls a dead end a matter of time",
                spoiled(
                    [](const Planner& good, const Request& request) {
                      PlanResult result = good.plan(request);
                      if (result.status == Status::no_route) {
                        result.status = Status::timed_out;
                      }
                      return result;
                    },
                    complete),
                "Planner trait `complete`");
  Traits optimal;
  optimal.optimal = true;
  expect_caught("greedy", spoiled(plain, optimal, "{weight_g: 0.05, weight_h: 0.95}"),
                "Planner trait `optimal`");
  Traits any_angle;
  any_angle.any_angle = true;
  expect_caught("along the axes", spoiled(plain, any_angle, "{neighbours: 6}"),
                "Planner trait `any_angle`");
  Traits anytime;
  anytime.anytime = true;
  expect_caught(
      "longer with more",
      spoiled(
          [](const Planner& good, const Request& request) {
            PlanResult result = good.plan(request);
            if (result.status == Status::solved && request.budget.max_iterations < 50'000 &&
                request.budget.max_iterations > 2 * std::uint64_t(result.counters[0].value) - 1) {
              const auto middle = result.route.begin() + 1;
              const Vec3 again = *middle;
              result.route.insert(middle, {again, result.route.front()});
            }
            return result;
          },
          anytime),
      "Planner trait `anytime`");
  Traits incremental;
  incremental.incremental = true;
  expect_caught("plans afresh", spoiled(plain, incremental), "Planner trait `incremental`");
}
}  // namespace
}  // namespace altiplan::conformance
