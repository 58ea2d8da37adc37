// SPDX-License-Identifier: Apache-2.0
#include "altiplan/smoother.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "altiplan/check.hpp"
#include "altiplan/error.hpp"
#include "contract.hpp"

namespace altiplan {

Smoother::~Smoother() = default;

PlanResult Smoother::do_smooth_turns(const Route& route, const Request&) const {
  PlanResult result;
  result.status = PlanStatus::solved;
  result.message =
      "left unchanged: this smoother takes straight legs only, and the route has turns";
  result.route = route;
  return result;
}

namespace {
PlanResult unchanged(const Route& route, const std::string& why) {
  PlanResult result;
  result.status = PlanStatus::solved;
  result.message = why;
  result.route = route;
  return result;
}

/// The route as it was, where it is valid and the smoothed one costs more, or meets a moving
/// obstacle.
PlanResult without_loss(PlanResult result, const Route& before, const Request& request) {
  if (result.status != PlanStatus::solved) {
    return result;
  }
  const bool costs =
      request.objective && costs_more(cost_of(result.route, request), cost_of(before, request));
  const bool meets = avoids_moving(request) && !check(result.route, request).ok();
  if ((!costs && !meets) || !check(before, request).ok()) {
    return result;
  }
  result.route = before;
  result.message = costs ? "left unchanged: every change found would cost more"
                         : "left unchanged: the smoothed route violates a constraint in time";
  return result;
}
}  // namespace

PlanResult Smoother::smooth(const Route& route, const Request& request) const {
  if (route.is_straight() && route.size() <= 2) {
    return unchanged(route, "nothing to smooth");
  }
  if (route.waits()) {
    return unchanged(route, "left unchanged: the route waits, and its times would change");
  }
  PlanResult result = guarded([&] {
    return route.is_straight() ? do_smooth(route.waypoints(), request)
                               : do_smooth_turns(route, request);
  });
  if (result.status == PlanStatus::solved &&
      (result.route.empty() || result.route.front() != route.front() ||
       result.route.back() != route.back() ||
       !std::all_of(result.route.begin(), result.route.end(), is_finite))) {
    throw PluginError(
        "the smoother violated the contract of its interface: first and last points must stay, all "
        "finite",
        Reason::contract_of_ends);
  }
  if (result.status == PlanStatus::solved && !legs_are_well_formed(result.route)) {
    throw PluginError(
        std::string("the smoother violated the contract of its interface: ") + kMalformedLeg,
        Reason::contract);
  }
  return request.objective || avoids_moving(request)
             ? without_loss(std::move(result), route, request)
             : result;
}
}  // namespace altiplan
