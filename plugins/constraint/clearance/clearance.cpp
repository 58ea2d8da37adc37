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
        .doc("minimum distance from the path of the vehicle's centre to any obstacle");
  }
};

class Clearance final : public Constraint {
 public:
  explicit Clearance(const Params& params) : params_(params) {}

 private:
  void do_tighten(Limits& limits, const Request&) const override {
    limits.min_clearance = std::max(limits.min_clearance, params_.min_m);
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "clearance", Clearance, Params,
                "Keeps a minimum distance between the route and every obstacle")
