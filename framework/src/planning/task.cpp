// SPDX-License-Identifier: Apache-2.0
#include "altiplan/task.hpp"

#include <cmath>

#include "altiplan/attributed.hpp"
#include "altiplan/environment.hpp"
#include "altiplan/flown_route.hpp"
#include "altiplan/request.hpp"

namespace altiplan {
namespace {

[[noreturn]] void fail_contract(const std::string& what) {
  throw PluginError("the task violated the contract of its interface: " + what, Reason::contract);
}

void expect_within(const Polyline& points, const Box& bounds, std::size_t pass) {
  for (const Vec3& p : points) {
    if (!p.allFinite() || !bounds.contains(p, kLengthTolerance)) {
      fail_contract("a point of pass " + std::to_string(pass) + " is not within its bounds");
    }
  }
}

void expect_possible(const Stop& stop, const Request& request, std::size_t pass) {
  if (!std::isfinite(stop.hold_s) || stop.hold_s < 0) {
    fail_contract("pass " + std::to_string(pass) + " waits for a time that is none");
  }
  if (stop.acts() && request.vehicle.wing) {
    fail_contract("an aeroplane stops after pass " + std::to_string(pass));
  }
}
}  // namespace

double Stop::seconds(const Vec3& at, const Request& request) const {
  if (!lands) {
    return hold_s;
  }
  const Vec3 foot(at.x(), at.y(), request.world->ground(at.x(), at.y()).value_or(at.z()));
  return hold_s + (foot == at ? 0 : flown_time(Route{at, foot, at}, request));
}

Route TaskOrder::route(const TaskEnds& ends, const Request& request) const {
  Route flown{first(ends)};
  const auto fly = [&flown](const Polyline& points) {
    for (const Vec3& p : points) {
      flown.push_back(p);
    }
  };
  for (const Pass& pass : passes) {
    fly(pass.join);
    fly(pass.points);
    if (const double seconds = pass.stop.seconds(flown.back(), request); seconds > 0) {
      flown.push_back(Leg::hold(flown.back(), seconds));
    }
  }
  fly(last_join);
  flown.push_back(last(ends));
  return without_repeats(flown);
}

Task::~Task() = default;
std::shared_ptr<const Environment> Task::do_obstacles() const { return nullptr; }

TaskOrder Task::order(const Request& request, const TaskEnds& ends) const {
  TaskOrder order;
  if (BudgetWatch watch(request.budget); watch.spent(0)) {
    order.status = watch.cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out;
    order.message = "the budget ended before the first order";
    return order;
  }
  order =
      attributed([] { return std::string("the task"); }, [&] { return do_order(request, ends); });
  if ((order.status == PlanStatus::solved) == order.passes.empty()) {
    fail_contract(order.passes.empty() ? "it is solved without a pass"
                                       : "it has passes and is not solved");
  }
  const Box box = bounds();
  for (std::size_t i = 0; i < order.passes.size(); ++i) {
    if (order.passes[i].points.empty()) {
      fail_contract("pass " + std::to_string(i) + " has no point");
    }
    const Pass& pass = order.passes[i];  // a flight begins where the route does
    expect_within(pass.points, pass.takes_off && ends.start ? box.with(*ends.start) : box, i);
    expect_possible(pass.stop, request, i);
  }
  if (!(order.bound_s >= 0 && order.time_s >= order.bound_s * (1 - 1e-9))) {
    fail_contract("its time is " + std::to_string(order.time_s) + " s, its bound " +
                  std::to_string(order.bound_s) + " s");
  }
  return order;
}
}  // namespace altiplan
