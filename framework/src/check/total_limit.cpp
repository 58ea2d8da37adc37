// SPDX-License-Identifier: Apache-2.0
#include "altiplan/total_limit.hpp"

#include <cmath>
#include <utility>

#include "altiplan/objective.hpp"
#include "altiplan/request.hpp"
#include "words.hpp"

namespace altiplan {

TotalLimit::TotalLimit(std::shared_ptr<const Objective> of, double maximum)
    : of_(std::move(of)), maximum_(maximum) {}

double TotalLimit::do_left_at(const Vec3&, const Request&, double) const { return 0; }

std::vector<Violation> TotalLimit::violations_of(const Route& route, const Request& request) const {
  const std::string unit = of_->unit().empty() ? "" : " " + of_->unit();
  const auto violation = [&](std::size_t at, double value, const std::string& what) {
    const std::string above = ", above the limit of " + fixed(maximum_) + unit;
    return std::vector<Violation>{{"", at, value, maximum_, what + above, "", of_->unit()}};
  };
  // What is taken until a waypoint: with stops, which take time, that of the route that ends there.
  const bool stops = !request.vehicle.wing && request.vehicle.acceleration.takes_time();
  double legs = 0;
  for (std::size_t i = 0; i < route.size(); ++i) {
    const bool is_end = i + 1 == route.size();
    const double left = left_at(route[i], request);
    if (!std::isfinite(left)) {
      return violation(i, left, "there is no way home from " + place(route[i]));
    }
    if (left > 0 || is_end) {  // elsewhere the end, which takes no less, decides
      const double total = is_end  ? of_->cost(route, request)
                           : stops ? of_->cost(route.part(0, i), request)
                                   : legs;
      if (is_end && costs_more(total, maximum_)) {
        return violation(0, total, "the route adds up to " + fixed(total) + unit);
      }
      if (costs_more(total + left, maximum_)) {
        return violation(i, total + left,
                         "the route adds up to " + fixed(total) + unit + " at " + place(route[i]) +
                             ", and the way home from there to " + fixed(total + left) + unit);
      }
    }
    legs += is_end || stops ? 0 : of_->cost(route.leg(i), 0, request);
  }
  return {};
}

std::vector<Violation> TotalLimit::do_violations(const Polyline& route,
                                                 const Request& request) const {
  Request flown = request;
  flown.vehicle.acceleration = {};
  return violations_of(Route(route), flown);
}
}  // namespace altiplan
