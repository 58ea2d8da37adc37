// SPDX-License-Identifier: Apache-2.0
#include "altiplan/objective.hpp"

#include <algorithm>
#include <numeric>

#include "altiplan/attributed.hpp"
#include "altiplan/measures.hpp"

namespace altiplan {
namespace {

std::string text_of(const std::string& name) {
  return name.empty() ? "the objective" : "the objective " + name;
}

double at_least_zero(double value, const std::string& name, const char* what) {
  if (!(value >= 0)) {
    throw PluginError(text_of(name) + " violated the contract of its interface: " + what + " is " +
                          std::to_string(value) + ", expected a number of at least 0",
                      Reason::contract);
  }
  return value;
}
}  // namespace

Objective::~Objective() = default;
Objective::Traits Objective::do_traits() const { return {}; }

double Objective::cost(const Leg& leg, double time_s, const Request& request) const {
  return at_least_zero(
      attributed([&] { return text_of(name_); }, [&] { return do_cost(leg, time_s, request); }),
      name_, "the cost of a leg");
}

double Objective::bound(const Vec3& from, const Vec3& to, const Request& request) const {
  const double bound = at_least_zero(
      attributed([&] { return text_of(name_); }, [&] { return do_bound(from, to, request); }),
      name_, "the bound between two places");
  constexpr double kRounding = 1e-9;
  if (from == to && bound > kRounding) {
    throw PluginError(text_of(name_) +
                          " violated the contract of its interface: the bound from a " +
                          ("place to itself is " + std::to_string(bound)) + ", expected 0",
                      Reason::contract);
  }
  return bound;
}

std::vector<double> Objective::costs(const Route& route, const Request& request) const {
  std::vector<double> terms =
      attributed([&] { return text_of(name_); }, [&] { return do_costs(route, request); });
  for (const double term : terms) {
    at_least_zero(term, name_, "the cost of a route");
  }
  return terms;
}

double Objective::legs_cost(const Route& route, const Request& request) const {
  const bool in_time = traits().time || !request.wind.changes.empty();
  double sum = 0;
  double time_s = 0;
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Leg leg = route.leg(i);
    sum += cost(leg, time_s, request);
    time_s += in_time ? leg_duration(leg, request.start.time_s + time_s, request) : 0;
  }
  return sum;
}

std::vector<double> Objective::do_costs(const Route& route, const Request& request) const {
  return {legs_cost(route, request)};
}

double Objective::min_cost(const Request& request) const {
  return at_least_zero(
      attributed([&] { return text_of(name_); }, [&] { return do_min_cost(request); }), name_,
      "the bound of routes");
}

double Objective::do_min_cost(const Request& request) const {
  return bound(request.start.position, request.goal.position, request);
}

double Objective::cost(const Route& route, const Request& request) const {
  const std::vector<double> terms = costs(route, request);
  return std::accumulate(terms.begin(), terms.end(), 0.0);
}

double cost_of(const Leg& leg, const Request& request) {
  return request.objective ? request.objective->cost(leg, 0, request) : leg.length();
}

double cost_of(const Route& route, const Request& request) {
  return request.objective ? request.objective->cost(route, request) : length(route);
}

double min_cost(const Request& request) {
  const State& start = request.start;
  const Goal& goal = request.goal;
  if (request.objective) {
    const bool are_points = !start.loiter && !goal.loiter && goal.tolerance_m == 0;
    return are_points ? request.objective->min_cost(request) : 0;
  }
  const double radii =
      (start.loiter ? start.loiter->radius : 0) + (goal.loiter ? goal.loiter->radius : 0);
  return std::max(0.0, (goal.position - start.position).norm() - goal.tolerance_m - radii);
}
}  // namespace altiplan
