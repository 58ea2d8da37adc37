// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "altiplan/constraint.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct Params {
  std::optional<double> min_m;
  std::optional<double> max_m;

  void describe(Fields& f) {
    f("min_m", min_m).unit("m").at_least(0).doc("minimum leg length");
    f("max_m", max_m).unit("m").greater_than(0).doc("maximum leg length");
    f.check(min_m || max_m, "leg_length needs min_m, max_m or both");
    f.check(!min_m || !max_m || *min_m <= *max_m, "min_m must not exceed max_m");
  }
};

class LegLength final : public Constraint {
 public:
  explicit LegLength(const Params& params) : params_(params) {}

 private:
  AppliesTo do_applies_to() const override { return AppliesTo::route; }
  void do_tighten(Limits& limits, const Request&) const override {
    limits.min_leg = std::max(limits.min_leg, params_.min_m.value_or(0));
    limits.max_leg = std::min(limits.max_leg, params_.max_m.value_or(kInfinity));
  }
  bool do_admits_all() const override { return true; }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "leg_length", LegLength, Params,
                "Keeps every leg of the route within a minimum and a maximum length")
