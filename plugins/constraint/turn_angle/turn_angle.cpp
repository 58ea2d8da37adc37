// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "altiplan/constraint.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

enum class Plane { horizontal, spatial };

struct Params {
  double max_deg = 180;
  Plane plane = Plane::horizontal;

  void describe(Fields& f) {
    f("max_deg", max_deg)
        .unit("deg")
        .range(0, 180)
        .required()
        .doc("maximum change of direction between two legs");
    f("plane", plane, {{"horizontal", Plane::horizontal}, {"spatial", Plane::spatial}})
        .doc("measure the turn in the horizontal plane or in three dimensions");
  }
};

class TurnAngle final : public Constraint {
 public:
  explicit TurnAngle(const Params& params) : params_(params) {}

 private:
  AppliesTo do_applies_to() const override { return AppliesTo::route; }
  void do_tighten(Limits& limits, const Request&) const override {
    double& limit =
        params_.plane == Plane::spatial ? limits.max_turn_space : limits.max_turn_horizontal;
    limit = std::min(limit, radians(params_.max_deg));
  }
  bool do_admits_all() const override { return true; }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "turn_angle", TurnAngle, Params,
                "Limits the turn at a waypoint, in the horizontal plane or in 3-D")
