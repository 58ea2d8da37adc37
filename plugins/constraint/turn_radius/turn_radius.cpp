// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "altiplan/constraint.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct Params {
  double min_m = 0;

  void describe(Fields& f) {
    f("min_m", min_m)
        .unit("m")
        .range(0, 1000000)
        .required()
        .doc("minimum turn radius at a waypoint and along a track");
  }
};

class TurnRadius final : public Constraint {
 public:
  explicit TurnRadius(const Params& params) : params_(params) {}

 private:
  void do_tighten(Limits& limits, const Request&) const override {
    limits.min_turn_radius = std::max(limits.min_turn_radius, params_.min_m);
  }
  bool do_admits_all() const override { return true; }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "turn_radius", TurnRadius, Params,
                "Limits how tightly the route bends at a waypoint")
