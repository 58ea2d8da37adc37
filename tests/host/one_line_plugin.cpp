// SPDX-License-Identifier: Apache-2.0
// Built twice, the second time with one more line: the test looks at what follows from it.
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"

namespace {

struct Params {
  double first_m = 5;
  double extra_m = 3;
  void describe(altiplan::Fields& f) {
    f("first_m", first_m).unit("m").at_least(1).doc("a distance");
#ifdef ONE_MORE_LINE
    f("extra_m", extra_m).unit("m").range(1, 9).doc("another distance");
#endif
  }
};

class Straight final : public altiplan::Planner {
 public:
  explicit Straight(const Params& params) : params_(params) {}

 private:
  altiplan::PlanResult do_plan(const altiplan::Request& request) const override {
    altiplan::PlanResult result;
    result.status = altiplan::PlanStatus::solved;
    result.route = {request.start.position, request.goal.position};
    result.counters = {{"extra", std::int64_t(params_.extra_m)}};
    return result;
  }
  altiplan::Traits do_traits() const override { return {}; }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "one_line", Straight, Params, "the straight line")
