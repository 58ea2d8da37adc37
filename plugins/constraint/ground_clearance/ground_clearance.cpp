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
        .range(0, 100000)
        .required()
        .doc("minimum height of the route above the ground below it");
  }
};

class GroundClearance final : public Constraint {
 public:
  explicit GroundClearance(const Params& params) : params_(params) {}

 private:
  void do_tighten(Limits& limits, const Request&) const override {
    limits.min_ground_clearance =
        std::max(params_.min_m, limits.min_ground_clearance.value_or(-kInfinity));
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "ground_clearance", GroundClearance, Params,
                "Keeps the route at a minimum height above the ground")
