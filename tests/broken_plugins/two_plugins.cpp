// SPDX-License-Identifier: Apache-2.0
// Nothing is wrong with this one.
#include "altiplan/constraint.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"

namespace {

struct Params {
  double min_m = 5;
  void describe(altiplan::Fields& f) { f("min_m", min_m).unit("m").at_least(1).doc("a distance"); }
};

class Nowhere final : public altiplan::Planner {
 public:
  explicit Nowhere(const Params&) {}

 private:
  altiplan::PlanResult do_plan(const altiplan::Request&) const override { return {}; }
  altiplan::Traits do_traits() const override { return {}; }
};

class Anything final : public altiplan::Constraint {
 public:
  explicit Anything(const Params&) {}
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "alpha", Nowhere, Params, "finds no route")
ALTIPLAN_PLUGIN(Constraint, "beta", Anything, Params, "admits every route")
