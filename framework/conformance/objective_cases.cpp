// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "altiplan/measures.hpp"
#include "objective_bench.hpp"

namespace altiplan::conformance {
namespace {

constexpr const char* kObjectivePure =
    "Objective contract 1: pure and const, callable from any number of threads";
constexpr const char* kAdditive =
    "Objective contract 2: cost is at least 0 and additive: the sum of the costs of the leg's "
    "pieces, each at its own time";
constexpr const char* kConsistent =
    "Objective contract 3: bound is consistent: bound(a, a) = 0 and bound(a, c) <= cost(a-b) + "
    "bound(b, c)";
constexpr const char* kOfRoutes =
    "Objective contract 5: without the trait `waypoints` costs add up to at least the sum of cost "
    "over the legs; min_cost is at most the costs of any route";
constexpr const char* kNoPrice = "Suite: there must be something to judge";
constexpr const char* kDenied = "Objective contract 4: cost depends on nothing that traits denies";

/// Rounding of an integral over many pieces, and what chords of a turn are off by.
constexpr double kOfStraight = 1e-9;
constexpr double kOfTurn = 1e-4;

bool is_near(double a, double b, double share) {
  return a == b || std::abs(a - b) <= share * std::max(std::abs(a), std::abs(b));
}

void additive(const ObjectiveBench& bench, Report& report) {
  const auto objective = bench.made();
  RandomStream random = bench.stream("additive");
  bool any_has_price = false;
  for (int n = 0; n < bench.count(); ++n) {
    const Leg leg = bench.leg(random);
    const double cut = random.uniform(0.05, 0.95);
    const Leg first = leg.piece(0, cut);
    const Leg second = leg.piece(cut, 1);
    const double begins = random.uniform(0, 1000);
    const double whole = objective->cost(leg, begins, bench.request);
    any_has_price |= whole < kInfinity;
    const double parts =
        objective->cost(first, begins, bench.request) +
        objective->cost(second, begins + leg_duration(first, bench.request), bench.request);
    report.expect(is_near(whole, parts, leg.turns() ? kOfTurn : kOfStraight), kAdditive, [&] {
      return "the leg from " + text(leg.from) + " to " + text(leg.to) + " costs " + text(whole) +
             ", cut at " + text(cut) + " its pieces cost " + text(parts);
    });
  }
  report.expect(any_has_price, kNoPrice, [] {
    return "no leg has a finite cost: give a parameter set with the layers that the objective "
           "needs, such as ground (`before:`), and a `volume` in which it has a value";
  });
}

void consistent(const ObjectiveBench& bench, Report& report) {
  const auto objective = bench.made();
  RandomStream random = bench.stream("consistent");
  for (int n = 0; n < bench.count(); ++n) {
    const Vec3 a = bench.place(random);
    // Half of the legs are short: a bound that is wrong nearby is seldom wrong from far away.
    const Vec3 b = n % 2 == 0 ? bench.place(random) : bench.beside(a, random);
    const Vec3 c = bench.place(random);
    const double whole = objective->bound(a, c, bench.request);
    const double leg = objective->cost(Leg::straight(a, b), random.uniform(0, 1000), bench.request);
    const double rest = objective->bound(b, c, bench.request);
    const double rounding = kOfStraight * (whole + rest);
    report.expect(whole <= leg + rest + rounding, kConsistent, [&] {
      return "from " + text(a) + " to " + text(c) + " the bound is " + text(whole) +
             ", but by way of " + text(b) + " the leg costs " + text(leg) +
             " and the bound of the rest is " + text(rest);
    });
    report.expect(objective->bound(a, a, bench.request) == 0, kConsistent, [&] {
      return "from " + text(a) + " to itself the bound is " +
             text(objective->bound(a, a, bench.request));
    });
  }
}

void whole_routes(const ObjectiveBench& bench, Report& report) {
  constexpr int kLegs = 3;
  const auto objective = bench.made();
  RandomStream random = bench.stream("routes");
  for (int n = 0; n < bench.count() / kLegs; ++n) {
    Polyline points{bench.place(random)};
    while (points.size() <= kLegs) {
      points.push_back(n % 2 == 0 ? bench.place(random) : bench.beside(points.back(), random));
    }
    const Route route(points);
    const double whole = objective->cost(route, bench.request);
    double legs = 0;
    double time_s = 0;
    for (std::size_t i = 0; i < route.leg_count(); ++i) {
      legs += objective->cost(route.leg(i), time_s, bench.request);
      time_s += leg_duration(route.leg(i), bench.request);
    }
    if (!objective->traits().waypoints) {
      report.expect(legs <= whole * (1 + kOfStraight), kOfRoutes, [&] {
        return "the route from " + text(points.front()) + " to " + text(points.back()) + " costs " +
               text(whole) + ", its legs alone " + text(legs);
      });
    }
    Request ends = bench.request;
    ends.start.position = points.front();
    ends.goal.position = points.back();
    const double minimum = objective->min_cost(ends);
    report.expect(minimum <= whole * (1 + kOfStraight), kOfRoutes, [&] {
      return "a route from " + text(points.front()) + " to " + text(points.back()) + " costs " +
             text(whole) + ", min_cost is " + text(minimum);
    });
  }
}

void traits_hold(const ObjectiveBench& bench, Report& report) {
  const auto objective = bench.made();
  const Objective::Traits traits = objective->traits();
  RandomStream random = bench.stream("traits");
  const auto same = [&](const char* what, double one, double other, const Leg& leg) {
    report.expect(is_near(one, other, leg.turns() ? kOfTurn : kOfStraight), kDenied, [&] {
      return "the leg from " + text(leg.from) + " to " + text(leg.to) + " costs " + text(one) +
             ", " + what + " " + text(other);
    });
  };
  for (int n = 0; n < bench.count(); ++n) {
    const Leg leg = bench.leg(random);
    const double cost = objective->cost(leg, 0, bench.request);
    if (!traits.time) {
      same("an hour later", cost, objective->cost(leg, 3600, bench.request), leg);
    }
    if (!traits.heading) {
      same("flown backwards", cost, objective->cost(leg.reversed(), 0, bench.request), leg);
    }
    if (!traits.place && !leg.turns()) {
      const Vec3 by = bench.place(random) - leg.from;
      const Leg moved = Leg::straight(leg.from + by, leg.to + by);
      same("moved elsewhere", cost, objective->cost(moved, 0, bench.request), leg);
    }
  }
}

void pure(const ObjectiveBench& bench, Report& report) {
  const std::string first = bench.answers(*bench.made());
  const auto objective = bench.made();
  std::string one;
  std::string other;
  in_two_threads([&] { one = bench.answers(*objective); },
                 [&] { other = bench.answers(*objective); });
  report.expect(first == one && one == other, kObjectivePure,
                [] { return "two objects, or two threads, get different answers"; });
  report.expect(bench.answers(*objective) == one, kObjectivePure,
                [] { return "the same questions get other answers later"; });
}
}  // namespace

Cases objective_cases(const ObjectiveFactory& make, const Options& options,
                      const std::shared_ptr<const World>& before) {
  const ObjectiveBench bench(make, options, before);
  return {
      make_case("costs_are_additive", kAdditive,
                [bench](Report& report) { additive(bench, report); }),
      make_case("bounds_are_consistent", kConsistent,
                [bench](Report& report) { consistent(bench, report); }),
      make_case("routes_cost_their_legs", kOfRoutes,
                [bench](Report& report) { whole_routes(bench, report); }),
      make_case("traits_hold", kDenied, [bench](Report& report) { traits_hold(bench, report); }),
      make_case("same_answers", kObjectivePure, [bench](Report& report) { pure(bench, report); })};
}
}  // namespace altiplan::conformance
