// SPDX-License-Identifier: Apache-2.0
#include <altiplan/flown_route.hpp>
#include <altiplan/plugin.hpp>
#include <altiplan/request.hpp>
#include <altiplan/task.hpp>

#include <algorithm>

namespace {
using namespace altiplan;

struct Params {
  std::vector<Vec3> stops_m{{0, 0, 200}, {400, 0, 200}, {0, 300, 200}};

  void describe(Fields& f) {  // the only place that lists them
    f("stops_m", stops_m).unit("m").min_items(1).doc("places to pass");
  }
};

// Passes each place, always flying on to the nearest.
class Nearest final : public Task {
 public:
  Nearest(const Params& params, const Site&) : params_(params) {}

 private:
  // Called once per plan step: a planner then joins the passes.
  TaskOrder do_order(const Request& request, const TaskEnds& ends) const override {
    TaskOrder order;
    order.status = PlanStatus::solved;
    std::vector<Vec3> left = params_.stops_m;
    Vec3 here = ends.start.value_or(left.front());
    while (!left.empty()) {
      const auto next = std::min_element(left.begin(), left.end(), [&](auto& a, auto& b) {
        return (a - here).norm() < (b - here).norm();
      });
      here = *next;
      order.passes.push_back({{here}});
      left.erase(next);
    }
    // The bound stays 0: nothing is known of other orders.
    order.time_s = flown_time(order.route(ends, request), request);
    return order;
  }

  Box do_bounds() const override {
    Box box = Box::empty();
    for (const Vec3& p : params_.stops_m) {
      box = box.with(p);
    }
    return box;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Task, "@name@", Nearest, Params, "Places to pass, always the nearest next")
