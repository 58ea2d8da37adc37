// SPDX-License-Identifier: Apache-2.0
// Smoothers, constraints, tuners and plugin entries broken on purpose, a law each.
#include <atomic>
#include <limits>
#include <stdexcept>

#include "altiplan/error.hpp"
#include "altiplan/plugin_abi.hpp"
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
Cases constraining(Rule rule) {
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

enum class Flaw { none, outside, unequal, endless, restless, shared, thin, not_a_number, throws };

class ToldSearch final : public Search {
 public:
  ToldSearch(std::vector<Dimension> space, RandomStream random, Flaw flaw)
      : space_(std::move(space)), random_(random), flaw_(flaw) {}

 private:
  /// Equal weights in each group, a draw elsewhere.
  std::vector<double> point() {
    std::vector<double> point;
    for (const Dimension& d : space_) {
      double group = 0;
      for (const Dimension& other : space_) {
        group += other.group == d.group;
      }
      const double drawn = random_.uniform(d.min, d.max);
      const bool weight = d.group >= 0 && flaw_ != Flaw::unequal;
      point.push_back(weight ? 1 / group : drawn + (flaw_ == Flaw::outside) * (d.max - d.min));
    }
    if (flaw_ == Flaw::thin) {
      point.pop_back();
    }
    if (flaw_ == Flaw::not_a_number && failed_) {
      point[0] = std::numeric_limits<double>::quiet_NaN();
    }
    return point;
  }
  std::vector<std::vector<double>> do_ask() override {
    static std::atomic<int> of_all = 0;
    const int batch = flaw_ == Flaw::shared ? ++of_all % 20 : ++batches_;
    const bool ends = flaw_ == Flaw::restless ? batch == 10 : batch >= 10;
    if (ends && flaw_ != Flaw::endless) {
      return {};
    }
    std::vector<std::vector<double>> points(flaw_ == Flaw::endless ? 1000 : 3);
    for (auto& one : points) {
      one = point();
    }
    return points;
  }
  void do_tell(std::span<const double> scores) override {
    failed_ = failed_ || scores[0] == kInfinity;
    if (flaw_ == Flaw::throws && failed_) {
      throw std::runtime_error("no score");
    }
  }

  std::vector<Dimension> space_;
  RandomStream random_;
  Flaw flaw_;
  int batches_ = 0;
  bool failed_ = false;
};

class ToldTuner final : public Tuner {
 public:
  explicit ToldTuner(Flaw flaw) : flaw_(flaw) {}

 private:
  std::unique_ptr<Search> do_begin(std::vector<Dimension> space,
                                   RandomStream random) const override {
    return std::make_unique<ToldSearch>(std::move(space), random, flaw_);
  }
  Flaw flaw_;
};

TEST(CatchesTuner, Flaws) {
  const auto of = [](Flaw flaw) {
    return tuner_cases([flaw] { return std::make_unique<ToldTuner>(flaw); });
  };
  expect_clean("sound", of(Flaw::none));
  for (const Flaw flaw : {Flaw::outside, Flaw::unequal, Flaw::endless, Flaw::restless, Flaw::thin,
                          Flaw::not_a_number}) {
    expect_caught("flaw " + std::to_string(int(flaw)), of(flaw), "Tuner law 1");
  }
  expect_caught("shared", of(Flaw::shared), "Tuner law 3");
  expect_caught("throws", of(Flaw::throws), "Tuner law 2");
}

struct Sound {
  double size_m = 5;
  Vec3 cell_m{1, 2, 3};
  std::vector<double> weights;
  void describe(Fields& f) {
    f("size_m", size_m).range(1, 9).doc("of it");
    f("cell_m", cell_m).greater_than(0).doc("of a cell");
    f("weights", weights).range(0, 1).doc("of terms");
  }
};
struct BadName {
  int badName = 1;
  void describe(Fields& f) { f("badName", badName).doc("what"); }
};
struct Silent {
  int size = 1;
  void describe(Fields& f) { f("size", size); }
};
struct Wild {
  double size = 20;
  void describe(Fields& f) { f("size", size).range(1, 9).doc("of it"); }
};

template <class Params>
class Straight final : public Smoother {
 public:
  explicit Straight(const Params&) {}

 private:
  PlanResult do_smooth(const Route& route, const Request&) const override { return solved(route); }
};

template <class Params>
PluginEntry entry(const char* name = "straight", const char* sentence = "does nothing") {
  return detail::make_entry<Smoother, Straight<Params>, Params>(name, sentence);
}

TEST(CatchesPlugin, Flaws) {
  expect_clean("sound", plugin_cases(entry<Sound>()));
  expect_caught("name", plugin_cases(entry<Sound>("goStraight")), "Plugin entry: a kind");
  expect_caught("sentence", plugin_cases(entry<Sound>("straight", "")), "Plugin entry: a kind");
  PluginEntry odd = entry<Sound>();
  odd.kind = "planner";
  expect_caught("kind", plugin_cases(odd), "Plugin entry: a kind");
  expect_caught("camel", plugin_cases(entry<BadName>()), "Plugin parameters: names");
  expect_caught("silent", plugin_cases(entry<Silent>()), "Plugin parameters: names");
  expect_caught("wild", plugin_cases(entry<Wild>()), "Plugin parameters: defaults");
  PluginEntry deaf = entry<Sound>();
  deaf.describe = [](const Value*, const std::string& path) {
    return detail::describe<Sound>(nullptr, path);
  };
  expect_caught("deaf", plugin_cases(deaf), "Plugin parameters: unknown keys");
  PluginEntry throwing = entry<Sound>();
  throwing.describe = [](const Value* value, const std::string& path) {
    return value != nullptr ? throw std::runtime_error("no") : detail::describe<Sound>(value, path);
  };
  expect_caught("throwing", plugin_cases(throwing), "Plugin parameters: describe");
  PluginEntry careless = entry<Sound>();
  careless.smoother = [](const Value*) -> std::unique_ptr<Smoother> {
    return std::make_unique<Straight<Sound>>(Sound());
  };
  expect_caught("careless", plugin_cases(careless), "Plugin entry: makes");
  PluginEntry thrower = entry<Sound>();
  thrower.smoother = [](const Value*) -> std::unique_ptr<Smoother> { throw 42; };
  expect_caught("thrower", plugin_cases(thrower), "Plugin entry: makes");
}
}  // namespace
}  // namespace altiplan::conformance
