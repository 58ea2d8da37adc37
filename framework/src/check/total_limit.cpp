// SPDX-License-Identifier: Apache-2.0
#include "altiplan/total_limit.hpp"

#include <utility>

#include "altiplan/objective.hpp"
#include "altiplan/request.hpp"
#include "words.hpp"

namespace altiplan {

TotalLimit::TotalLimit(std::shared_ptr<const Objective> of, double maximum)
    : of_(std::move(of)), maximum_(maximum) {}

std::vector<Violation> TotalLimit::violations_of(double total) const {
  if (!costs_more(total, maximum_)) {
    return {};
  }
  const std::string unit = of_->unit().empty() ? "" : " " + of_->unit();
  return {{"", 0, total, maximum_,
           "the route adds up to " + fixed(total) + unit + ", above the limit of " +
               fixed(maximum_) + unit,
           "", of_->unit()}};
}

std::vector<Violation> TotalLimit::violations_of(const Route& route, const Request& request) const {
  return violations_of(of_->cost(route, request));
}

std::vector<Violation> TotalLimit::do_violations(const Polyline& route,
                                                 const Request& request) const {
  return violations_of(Route(route), request);
}
}  // namespace altiplan
