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
/// The route as it was, where it is valid and the smoothed one costs more.
PlanResult without_loss(PlanResult result, const Route& before, const Request& request) {
  const double cost = cost_of(before, request);
  if (result.status != PlanStatus::solved || !costs_more(cost_of(result.route, request), cost) ||
      !check(before, request).ok()) {
    return result;
  }
  result.route = before;
  result.message = "left unchanged: every change found would cost more";
  return result;
}
}  // namespace

PlanResult Smoother::smooth(const Route& route, const Request& request) const {
  if (route.is_straight() && route.size() <= 2) {
    PlanResult result;
    result.status = PlanStatus::solved;
    result.message = "nothing to smooth";
    result.route = route;
    return result;
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
  return request.objective ? without_loss(std::move(result), route, request) : result;
}
}  // namespace altiplan
