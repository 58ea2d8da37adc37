// SPDX-License-Identifier: Apache-2.0
#include <altiplan/objective.hpp>
#include <altiplan/plugin.hpp>
#include <altiplan/request.hpp>

#include <algorithm>

namespace {
using namespace altiplan;

struct Params {
  double climb = 10;

  void describe(Fields& f) {  // the only place that lists them
    f("climb", climb).at_least(0).doc("metres of flight that a metre of climb is worth");
  }
};

class ClimbCost final : public Objective {
 public:
  ClimbCost(const Params& params, const Site&) : params_(params) {}

 private:
  // Called for each leg by planners, smoothers and the judge.
  double do_cost(const Leg& leg, double, const Request&) const override {
    return leg.length() + params_.climb * climbed(leg.from, leg.to);
  }

  // No route is shorter, and none climbs less.
  double do_bound(const Vec3& from, const Vec3& to, const Request&) const override {
    return (to - from).norm() + params_.climb * climbed(from, to);
  }

  std::string do_unit() const override { return "m"; }

  // The same anywhere, but not the same up as down.
  Traits do_traits() const override { return {.place = false, .heading = true}; }

  static double climbed(const Vec3& from, const Vec3& to) {
    return std::max(0.0, to.z() - from.z());
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Objective, "@name@", ClimbCost, Params, "Length, and climb at a price")
