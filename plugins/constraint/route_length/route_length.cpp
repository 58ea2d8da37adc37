// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "altiplan/constraint.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/request.hpp"

namespace {
using namespace altiplan;

struct Params {
  std::optional<double> max_m;
  std::optional<double> max_ratio;

  void describe(Fields& f) {
    f("max_m", max_m).unit("m").greater_than(0).doc("maximum route length");
    f("max_ratio", max_ratio)
        .at_least(1)
        .doc("maximum route length, as a multiple of the distance from start to goal");
    f.check(max_m.has_value() != max_ratio.has_value(),
            "route_length needs exactly one of max_m and max_ratio");
  }
};

class RouteLength final : public Constraint {
 public:
  explicit RouteLength(const Params& params) : params_(params) {}

 private:
  void do_tighten(Limits& limits, const Request& request) const override {
    const double straight = (request.goal.position - request.start.position).norm();
    const double longest = params_.max_m ? *params_.max_m : *params_.max_ratio * straight;
    limits.max_route_length = std::min(limits.max_route_length, longest);
  }
  bool do_admits_all() const override { return true; }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "route_length", RouteLength, Params,
                "Limits the length of the whole route")
