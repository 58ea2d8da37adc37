// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "altiplan/constraint.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct Params {
  double max_deg = 0;

  void describe(Fields& f) {
    f("max_deg", max_deg)
        .unit("deg")
        .range(0, 90)
        .required()
        .doc("maximum climb or descent angle of a leg");
  }
};

class ClimbAngle final : public Constraint {
 public:
  explicit ClimbAngle(const Params& params) : params_(params) {}

 private:
  void do_tighten(Limits& limits, const Request&) const override {
    limits.max_climb = std::min(limits.max_climb, radians(params_.max_deg));
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "climb_angle", ClimbAngle, Params,
                "Limits how steeply a leg climbs or descends")
