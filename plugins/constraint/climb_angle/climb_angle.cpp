// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "altiplan/constraint.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct Params {
  double max_deg = 0;
  std::optional<double> max_sink_deg;

  void describe(Fields& f) {
    f("max_deg", max_deg)
        .unit("deg")
        .range(0, 90)
        .required()
        .doc("maximum climb angle of a leg, and descent angle unless max_sink_deg is given");
    f("max_sink_deg", max_sink_deg).unit("deg").range(0, 90).doc("maximum descent angle of a leg");
  }
};

class ClimbAngle final : public Constraint {
 public:
  explicit ClimbAngle(const Params& params) : params_(params) {}

 private:
  void do_tighten(Limits& limits, const Request&) const override {
    const double sink = radians(params_.max_sink_deg.value_or(params_.max_deg));
    limits.max_sink = std::min(limits.max_descent(), sink);
    limits.max_climb = std::min(limits.max_climb, radians(params_.max_deg));
  }
  bool do_admits_all() const override { return true; }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "climb_angle", ClimbAngle, Params,
                "Limits how steeply a leg climbs or descends")
