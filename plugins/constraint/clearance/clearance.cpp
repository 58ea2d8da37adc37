// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "altiplan/constraint.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct Params {
  double min_m = 0;
  AppliesTo applies_to = AppliesTo::both;

  void describe(Fields& f) {
    f("min_m", min_m)
        .unit("m")
        .range(0, 100000)
        .required()
        .doc("minimum distance from the path of the vehicle's centre to any obstacle");
    f("applies_to", applies_to,
      {{"both", AppliesTo::both}, {"route", AppliesTo::route}, {"track", AppliesTo::track}})
        .doc(
            "what it restricts: a larger value for the route than for the track leaves a margin "
            "for the flight");
  }
};

class Clearance final : public Constraint {
 public:
  explicit Clearance(const Params& params) : params_(params) {}

 private:
  AppliesTo do_applies_to() const override { return params_.applies_to; }
  void do_tighten(Limits& limits, const Request&) const override {
    limits.min_clearance = std::max(limits.min_clearance, params_.min_m);
  }
  bool do_admits_all() const override { return true; }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "clearance", Clearance, Params,
                "Keeps a minimum distance between the route and every obstacle")
