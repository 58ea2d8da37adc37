// SPDX-License-Identifier: Apache-2.0
#include "host/base/built_in.hpp"

#include "altiplan/constraint.hpp"
#include "altiplan/environment.hpp"
#include "altiplan/kit/layers/mean_cost.hpp"
#include "altiplan/objective.hpp"
#include "host/base/shapes.hpp"

namespace altiplan::host {
namespace {

/// Length as an objective among others; alone it is the default, which no object stands for.
class Length final : public Objective, public kit::MeanCost {
 public:
  Length(const NoParams&, const Site&) {}
  double per_metre(const Vec3&, const Vec3&) const override { return 1; }

 private:
  double do_cost(const Leg& leg, double, const Request&) const override { return leg.length(); }
  double do_bound(const Vec3& from, const Vec3& to, const Request&) const override {
    return (to - from).norm();
  }
  std::string do_unit() const override { return "m"; }
  Traits do_traits() const override { return {.place = false}; }
};

/// Without a factory: the objectives that it is made of are made by the host
/// (mission/objective.cpp).
template <class Params>
PluginEntry made_by_host(const char* kind, const char* name, const char* sentence) {
  PluginEntry entry{};
  entry.kind = kind;
  entry.name = name;
  entry.sentence = sentence;
  entry.describe = &detail::describe<Params>;
  return entry;
}
}  // namespace

const std::vector<PluginEntry>& built_in_plugins() {
  static const std::vector<PluginEntry> kAll = [] {
    std::vector<PluginEntry> all(built_in_environments().begin(), built_in_environments().end());
    all.push_back(detail::make_entry<Objective, Length, NoParams>(
        "length", "Length of the route, the default"));
    all.push_back(made_by_host<WeightedParams>(detail::kKind<Objective>, "weighted",
                                               "Sum of several objectives, each times a weight"));
    all.push_back(made_by_host<LimitParams>(detail::kKind<Constraint>, "limit",
                                            "Limits what an objective adds up to along a route"));
    return all;
  }();
  return kAll;
}

void ObjectiveTerm::describe(Fields& f) {
  f("weight", weight).greater_than(0).at_most(1e12).doc("factor of its costs");
  f.plugin("objective", plugin, parameters).doc("an objective").required();
}

void WeightedParams::describe(Fields& f) {
  f("of", of).min_items(1).required().doc("the objectives, each with its weight");
}

void LimitedObjective::describe(Fields& f) {
  f.plugin("objective", plugin, parameters).doc("an objective").required();
}

void LimitParams::describe(Fields& f) {
  f("of", of).required().doc("the objective");
  f("maximum", maximum).at_least(0).required().doc("maximum total of a route, in its unit");
}

void for_each_objective(const std::string& name, const Value& parameters, const std::string& path,
                        const VisitObjective& visit) {
  const std::string key = path + "." + name;
  visit(name, parameters, key);
  if (name == "weighted") {
    WeightedParams weighted;
    bind(weighted, &parameters);
    for (std::size_t i = 0; i < weighted.of.size(); ++i) {
      for_each_objective(weighted.of[i].plugin, weighted.of[i].parameters,
                         key + ".of." + std::to_string(i), visit);
    }
  }
}
}  // namespace altiplan::host
