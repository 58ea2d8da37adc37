// SPDX-License-Identifier: Apache-2.0
// Smoothers and constraints broken on purpose, a law each.
#include <atomic>
#include <limits>
#include <stdexcept>

#include "catches.hpp"

namespace altiplan::conformance {
namespace {

using Smooths = std::function<PlanResult(const Route&, const Request&)>;

class ToldSmoother final : public Smoother {
 public:
  explicit ToldSmoother(Smooths smooths) : smooths_(std::move(smooths)) {}

 private:
  PlanResult do_smooth(const Route& route, const Request& request) const override {
    return smooths_(route, request);
  }
  Smooths smooths_;
};

PlanResult solved(Route route) {
  PlanResult result;
  result.status = Status::solved;
  result.route = std::move(route);
  return result;
}

Cases smoothing(const Smooths& smooths) {
  Options options;
  options.calls = 5;
  return smoother_cases([smooths] { return std::make_unique<ToldSmoother>(smooths); }, options);
}

TEST(CatchesSmoother, Flaws) {
  expect_clean("leaves all as it is",
               smoothing([](const Route& route, const Request&) { return solved(route); }));
  expect_caught("moves the end", smoothing([](const Route& route, const Request&) {
                  Route moved = route;
                  moved.back().x() += 1e-9;
                  return solved(moved);
                }),
                "Smoother law 1");
  expect_caught("cuts through", smoothing([](const Route& route, const Request&) {
                  return solved({route.front(), route.back()});
                }),
                "Smoother law 2");
  expect_caught("sharpens a corner of unsound routes",
                smoothing([](const Route& route, const Request& request) {
                  Route sharper = route;
                  if (request.limits.max_turn_horizontal < 2 && route.size() > 8) {
                    sharper[1] = route[2] + (route[0] - route[2]) * 1e-3;
                  }
                  return solved(sharper);
                }),
                "Smoother law 2");
  expect_caught("throws at repeats", smoothing([](const Route& route, const Request&) {
                  if (without_repeats(route).size() < route.size()) {
                    throw std::runtime_error("division by zero");
                  }
                  return solved(route);
                }),
                "Smoother: what it cannot do");
  static std::atomic<int> calls = 0;
  expect_caught("counts its calls", smoothing([](const Route& route, const Request&) {
                  PlanResult result = solved(route);
                  result.counters = {{"calls", ++calls}};
                  return result;
                }),
                "Smoother: const and shareable");
  expect_caught("works in its input", smoothing([](const Route& route, const Request&) {
                  PlanResult result = solved(route);
                  const_cast<Route&>(route)[1].z() += 1;
                  return result;
                }),
                "Smoother: const and shareable");
}

struct Rule {
  double limit = 100;
  std::function<void(Limits&, double limit)> tighten;
  std::function<bool(const Leg&, double limit)> admits;
  std::function<std::vector<Violation>(const Route&, double limit)> violations;
};

class ToldConstraint final : public Constraint {
 public:
  explicit ToldConstraint(Rule rule) : rule_(std::move(rule)) {}

 private:
  void do_tighten(Limits& limits, const Request&) const override {
    if (rule_.tighten) {
      rule_.tighten(limits, rule_.limit);
    }
  }
  bool do_admits(const Leg& leg) const override {
    return !rule_.admits || rule_.admits(leg, rule_.limit);
  }
  std::vector<Violation> do_violations(const Route& route, const Request&) const override {
    return rule_.violations ? rule_.violations(route, rule_.limit) : std::vector<Violation>{};
  }
  Rule rule_;
};

/// A constraint whose stricter parameter is half of the other.
Cases constraining(const Rule& rule) {
  Rule tighter = rule;
  tighter.limit /= 2;
  return constraint_cases([rule] { return std::make_unique<ToldConstraint>(rule); },
                          [tighter] { return std::make_unique<ToldConstraint>(tighter); });
}

Cases limiting(std::function<void(Limits&, double)> tighten) {
  Rule rule;
  rule.tighten = std::move(tighten);
  return constraining(rule);
}

Cases admitting(std::function<bool(const Leg&, double)> admits) {
  Rule rule;
  rule.admits = std::move(admits);
  return constraining(rule);
}

Cases finding(std::function<std::vector<Violation>(const Route&, double)> violations) {
  Rule rule;
  rule.violations = std::move(violations);
  return constraining(rule);
}

TEST(CatchesConstraint, Flaws) {
  const auto short_leg = [](const Leg& leg, double limit) {
    return (leg.to - leg.from).norm() <= 10 * limit;
  };
  expect_clean("sound", admitting(short_leg));
  expect_caught("loosens", limiting([](Limits& limits, double limit) { limits.max_leg = limit; }),
                "Constraint law 2");
  expect_caught("not a number", limiting([](Limits& limits, double) {
                  limits.max_climb = std::numeric_limits<double>::quiet_NaN();
                }),
                "Constraint law 2");
  expect_caught("adds up",
                limiting([](Limits& limits, double limit) { limits.min_clearance += limit; }),
                "Constraint law 2");
  expect_caught("takes the place of a band", limiting([](Limits& limits, double limit) {
                  limits.altitude = {{AltitudeBand::Datum::sea, -limit, limit}};
                }),
                "Constraint law 2");
  expect_caught("looser with the stricter parameter", limiting([](Limits& limits, double limit) {
                  limits.min_clearance = std::max(limits.min_clearance, limit);
                }),
                "Constraint law 2");
  static std::atomic<int> calls = 0;
  expect_caught("tires", admitting([](const Leg&, double) { return ++calls % 7 != 0; }),
                "Constraint law 3");
  expect_caught("remembers the leg before", admitting([](const Leg& leg, double) {
                  static thread_local double last = 0;
                  const double before = std::exchange(last, leg.from.x());
                  return before < leg.from.x();
                }),
                "Constraint law 3");
  expect_caught("admits more with the stricter parameter",
                admitting([](const Leg& leg, double limit) {
                  return (leg.to - leg.from).norm() >= 10 * limit;
                }),
                "Constraint law 3");
  expect_caught("impure", finding([](const Route&, double limit) {
                  return std::vector<Violation>{{"", 0, limit + ++calls, limit, "so"}};
                }),
                "Constraint law 1");
  expect_caught("throws at an empty route", finding([](const Route& route, double limit) {
                  const double x = route.at(0).x();
                  return x > limit ? std::vector<Violation>{{"", 0, x, limit, "too far east"}}
                                   : std::vector<Violation>{};
                }),
                "Constraint law 1");
  expect_caught("violations of nothing", finding([](const Route&, double limit) {
                  return std::vector<Violation>{{"", 0, limit, limit, "just so"}};
                }),
                "Constraint law 4");
  expect_caught("violations beyond the route", finding([](const Route& route, double limit) {
                  return std::vector<Violation>{{"", route.size(), 2 * limit, limit, "there"}};
                }),
                "Constraint law 4");
  expect_caught("violations without words", finding([](const Route&, double limit) {
                  return std::vector<Violation>{{"", 0, 2 * limit, limit, ""}};
                }),
                "Constraint law 4");
  expect_caught("kept with the stricter parameter", finding([](const Route& route, double limit) {
                  const double total = length(route);
                  return total < 30 * limit ? std::vector<Violation>{{"", 0, total, limit, "short"}}
                                            : std::vector<Violation>{};
                }),
                "Constraint law 4");
  expect_caught("says nothing", constraining({}), "Suite");
}
}  // namespace
}  // namespace altiplan::conformance
