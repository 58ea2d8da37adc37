// SPDX-License-Identifier: Apache-2.0
#include "host/judge/judge.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"
#include "altiplan/kit/layers/hours.hpp"
#include "altiplan/measures.hpp"
#include "host/base/shapes.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {
namespace {

constexpr const char* kLayerRule = "layer";

bool is_built_in(const Layer& layer) {
  const auto kinds = built_in_environments();
  return std::any_of(kinds.begin(), kinds.end(),
                     [&](const PluginEntry& kind) { return layer.plugin == kind.name; });
}

/// Samples of the route at which a layer contradicts itself; contract 3 of Environment. The
/// program's own solids are not sampled: there may be thousands.
void check_consistency(const Layer& layer, const Route& route, std::vector<Violation>& found) {
  constexpr int kSamples = 8;  // per leg; this checks layers, not the route
  const Environment& environment = *layer.environment;
  const double slack = environment.over_approximation();
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Leg leg = route.leg(i);
    for (int k = 0; k < kSamples; ++k) {
      const Vec3 p = leg.at(double(k) / kSamples);
      const double clearance = environment.clearance(p);
      const bool inside = environment.blocked(p, p, 0);
      const bool solid = clearance < -slack - 1e-3;
      const bool open = clearance > slack + 1e-3;
      if (std::isnan(clearance) || (inside && open) || (!inside && solid)) {
        found.push_back({kLayerRule, i, clearance, 0,
                         "the layer '" + layer.id + "' (" + layer.plugin +
                             ") contradicts itself: its clearance is " + std::to_string(clearance) +
                             " m where its blocked says " + (inside ? "inside" : "free"),
                         layer.id, "m"});
        return;
      }
    }
  }
}
}  // namespace

std::vector<std::size_t> via_indices(const Route& route, const std::vector<Goal>& via) {
  std::vector<std::size_t> indices;
  std::size_t from = 0;
  for (const Goal& point : via) {
    while (from < route.size() && !point.reached_at(route[from])) {
      ++from;
    }
    if (from == route.size()) {
      break;
    }
    indices.push_back(from);
  }
  return indices;
}

namespace {
/// The course at a via point with a heading or a loiter circle, at any of the waypoints in a row
/// that reach it.
void check_via_course(const Route& route, const Request& request, const Goal& via,
                      std::size_t first, std::vector<Violation>& found) {
  Request to = request;
  to.goal = via;
  double min_angle = kInfinity;
  Arrival reached{request.before_start(route.front()), request.start.time_s};
  for (std::size_t i = 1; i < route.size() && (i <= first || via.reached_at(route[i])); ++i) {
    reached = reached.onward(route.leg(i - 1), request);
    if (i >= first) {
      to.wind = request.wind.in_force(reached.time_s);
      const std::optional<Approach>& before = reached.before;
      const Vec3 arrival = before ? before->heading_at(route[i]) : Vec3::Zero();
      const auto course = to.arrival_course(route[i]);
      const double off = course ? turn_angle_horizontal(arrival, *course) : 0;
      min_angle =
          std::min(min_angle, off * std::max(1.0, arrival.norm()) > kLengthTolerance ? off : 0);
    }
  }
  if (std::isfinite(min_angle) && min_angle > kAngleTolerance) {
    found.push_back({"via_heading", first, degrees(min_angle), 0,
                     "the angle between the course at the via point and the one asked for is " +
                         std::to_string(degrees(min_angle)) + " degrees",
                     "", "deg"});
  }
}
}  // namespace

namespace {
/// The same as check, in a world of which parts are closed at times: each leg by what is closed
/// while it is flown.
CheckResult check_in_time(const Route& route, const Request& request) {
  // Speeds that depend on what is near would depend on what is closed.
  if (route.empty() || !kit::has_hours(*request.world) || !request.vehicle.speed_near.empty()) {
    return check(route, request);
  }
  const auto between = [&](double from, double until) {
    Request then = request;
    then.world = std::make_shared<const World>(kit::between(*request.world, from, until));
    return then;
  };
  CheckResult result = check(route, between(kInfinity, -kInfinity));
  std::vector<Violation>& found = result.violations;
  Arrival arrival{request.before_start(route.front()), request.start.time_s};
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Leg leg = route.leg(i);
    const Arrival next = arrival.onward(leg, request);
    const Request during = std::isfinite(next.time_s) ? between(arrival.time_s - kTimeTolerance,
                                                                next.time_s + kTimeTolerance)
                                                      : between(-kInfinity, kInfinity);
    for (Violation& violation : leg_violations(arrival, leg, during, i)) {
      if (std::find(found.begin(), found.end(), violation) == found.end()) {
        found.push_back(std::move(violation));
      }
    }
    arrival = next;
  }
  return result;
}
}  // namespace

CheckResult judge(const Route& route, const Request& request, const std::vector<Goal>& via,
                  const Runways& runways) {
  CheckResult result = check_in_time(route, runways.has_any() ? above_no_ground(request) : request);
  if (runways.has_any()) {
    for (Violation& violation : ground_violations(route, request, runways)) {
      if (std::find(result.violations.begin(), result.violations.end(), violation) ==
          result.violations.end()) {
        result.violations.push_back(std::move(violation));
      }
    }
  }
  const std::vector<std::size_t> indices = via_indices(route, via);
  const std::size_t passed = indices.size();
  for (std::size_t i = 0; i < passed; ++i) {
    check_via_course(route, request, via[i], indices[i], result.violations);
  }
  if (passed < via.size()) {
    double min_distance = kInfinity;
    for (std::size_t i = passed > 0 ? indices.back() : 0; i < route.size(); ++i) {
      min_distance = std::min(min_distance, (route[i] - via[passed].position).norm());
    }
    const std::string nearest = std::isfinite(min_distance)
                                    ? ": its nearest waypoint is " + with_digits(min_distance, 3) +
                                          " m away, tolerance_m " +
                                          with_digits(via[passed].tolerance_m, 6)
                                    : "";
    result.violations.push_back(
        {"via", 0, double(passed), double(via.size()),
         "the route does not pass via point " + std::to_string(passed) + nearest});
  }
  for (const Layer& layer : request.world->layers()) {
    if (is_built_in(layer)) {
      continue;
    }
    try {
      check_consistency(layer, route, result.violations);
    } catch (const std::exception& error) {
      throw PluginError("the layer '" + layer.id + "' (" + layer.plugin +
                        ") threw: " + error.what());
    }
  }
  return result;
}

Cost price(const Route& route, const Request& request, const std::vector<Goal>& via) {
  Cost cost{cost_of(route, request), 0};
  std::vector<Goal> goals = via;
  goals.push_back(request.goal);
  Request section = request;
  double tolerance = 0;  // of the section's start
  for (const Goal& goal : goals) {
    section.goal = goal;
    if (tolerance == 0 || !request.objective) {
      cost.bound += std::max(0.0, min_cost(section) - tolerance);
    }
    section.start.position = goal.position;
    section.start.loiter = goal.loiter;
    tolerance = goal.tolerance_m;
  }
  constexpr double kRounding = 1 + 1e-6;
  const bool is_between_ends = via.empty() && !route.empty() &&
                               route.front() == request.start.position &&
                               route.back() == request.goal.position;
  if (request.objective && is_between_ends && cost.bound > cost.cost * kRounding) {
    throw PluginError("the objective " + request.objective->name() +
                          (request.objective->name().empty() ? "" : " ") +
                          "violated the contract of its interface: no route costs less than " +
                          with_digits(cost.bound, 9) + " by its bounds, and this one costs " +
                          with_digits(cost.cost, 9),
                      Reason::contract);
  }
  return cost;
}

std::string verdict_sentence(const CheckResult& result, const Violation& shown) {
  const std::size_t count = result.violations.size();
  return "the judge found " + std::to_string(count) + " violation" +
         (count == 1 ? "" : "s; the first") + ", at waypoint " + std::to_string(shown.at) + " (" +
         shown.constraint + "): " + shown.message;
}

const Violation* violated_layer(const CheckResult& result) {
  const auto found = std::find_if(result.violations.begin(), result.violations.end(),
                                  [](const Violation& v) { return v.constraint == kLayerRule; });
  return found == result.violations.end() ? nullptr : &*found;
}
}  // namespace altiplan::host
