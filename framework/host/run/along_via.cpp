// SPDX-License-Identifier: Apache-2.0
#include "host/run/along_via.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "altiplan/check.hpp"
#include "altiplan/error.hpp"
#include "altiplan/measures.hpp"
#include "host/judge/judge.hpp"

namespace altiplan::host {
namespace {

/// Sums the counters of several calls.
void add_counters(Counters& sum, const Counters& more) {
  for (const Counter& counter : more) {
    const auto same = std::find_if(sum.begin(), sum.end(),
                                   [&](const Counter& c) { return c.name == counter.name; });
    if (same == sum.end()) {
      sum.push_back(counter);
    } else {
      same->value += counter.value;
    }
  }
}

/// Has the result of several sections be that of the last one, but for the route and the proof.
void take_section(PlanResult& whole, const PlanResult& part) {
  add_counters(whole.counters, part.counters);
  whole.budget_hit = whole.budget_hit || part.budget_hit;
  whole.status = part.status;
  whole.reason = part.reason;
  whole.message = part.message;
}

/// The iterations left of a budget after a call that counted `used`.
std::uint64_t left_of(std::uint64_t iterations, const Counters& used) {
  if (iterations == Budget{}.max_iterations) {
    return iterations;
  }
  for (const Counter& counter : used) {
    if (counter.name == "expanded") {
      return iterations -
             std::min(iterations, std::uint64_t(std::max<std::int64_t>(counter.value, 0)));
    }
  }
  return iterations;
}

/// One of so many equal parts of what is left of a budget.
Budget part_of(Budget budget, std::size_t parts) {
  if (budget.max_iterations != Budget{}.max_iterations) {
    budget.max_iterations /= parts;
  }
  if (budget.deadline) {
    const Budget::Clock::time_point now = Budget::Clock::now();
    budget.deadline = now + (*budget.deadline - now) / std::int64_t(parts);
  }
  return budget;
}

/// The vehicle's velocity at the end of a route. Where turns have a radius, it is as long as the
/// last straight leg: of that the next section's first corner is cut (fillet_radius).
Vec3 velocity_at_end(const Route& route, const Request& request) {
  for (std::size_t i = route.leg_count(); i-- > 0;) {
    const Leg leg = route.leg(i);
    const Vec3 way = leg.track(1);
    if (way.norm() >= kLengthTolerance) {
      const bool is_cut = request.limits.min_turn_radius > 0 && !leg.turns();
      return is_cut ? way : Vec3(way.normalized() * request.vehicle.speed_mps);
    }
  }
  return Vec3::Zero();
}

/// The part of a route that is flown before the wind changes, and the vehicle's state at its end.
struct FlownPart {
  Route route;
  State end;
  bool is_all = true;
};

FlownPart flown_until(double until_s, const Route& route, const Request& request,
                      const Request& then) {
  FlownPart flown{Route{route.front()}, request.start};
  State& end = flown.end;
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Leg leg = route.leg(i);
    const double seconds = leg_duration(leg, request);
    if (end.time_s + seconds <= until_s + kTimeTolerance) {
      flown.route.push_back(leg);
      end.time_s += seconds;
      continue;
    }
    double share = 0;
    for (double beyond = 1; (share + beyond) / 2 > share && (share + beyond) / 2 < beyond;) {
      const double middle = (share + beyond) / 2;
      const bool is_flown = end.time_s + leg_duration(leg.piece(0, middle), request) <= until_s;
      (is_flown ? share : beyond) = middle;
    }
    if (share > 0) {
      flown.route.push_back(leg.piece(0, share));
    }
    // A turn goes on with its heading through the air, a straight leg on its course.
    end = {until_s, flown.route.back(), velocity_at_end(flown.route, request)};
    if (leg.turns()) {
      end.velocity = then.ground_velocity({end.position, leg.heading + share * leg.turn});
    }
    flown.is_all = false;
    break;
  }
  return flown;
}

/// Index of the leg of the route that is nearest to p.
std::size_t nearest_leg(const Route& route, const Vec3& p) {
  std::size_t nearest = 0;
  double min_distance = kInfinity;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    const double distance = point_leg_distance(p, route[i], route[i + 1]);
    if (distance < min_distance) {
      min_distance = distance;
      nearest = i;
    }
  }
  return nearest;
}
}  // namespace

PlanResult plan_along(Request request, const std::vector<Goal>& via, bool anytime,
                      const PlanPart& plan_part) {
  PlanResult whole;
  std::vector<Goal> goals = via;
  goals.push_back(request.goal);
  for (std::size_t i = 0; i < goals.size(); ++i) {
    request.goal = goals[i];
    const std::string to = i + 1 == goals.size() ? "the goal" : "via point " + std::to_string(i);
    const auto on_the_way = [&](const std::string& message) {
      return goals.size() > 1 ? "on the way to " + to + ": " + message : message;
    };
    PlanResult part;
    try {
      Request section = request;
      section.budget = anytime ? part_of(request.budget, goals.size() - i) : request.budget;
      part = plan_part(section);
    } catch (const PluginError& error) {
      throw PluginError(on_the_way(error.what()), error.reason());
    }
    take_section(whole, part);
    whole.proved = part.proved;
    if (part.status != PlanStatus::solved) {
      // The planner calls the end of each section the goal; an invalid via point is reported as
      // such.
      whole.message = goals.size() > 1 && part.reason == Reason::goal
                          ? to + " " + goal_problem(request)
                          : on_the_way(part.message);
    }
    whole.route.append(part.route);
    if (part.status != PlanStatus::solved) {
      break;
    }
    if (avoids_moving(request) || !request.wind.changes.empty()) {
      for (std::size_t leg = 0; leg < part.route.leg_count(); ++leg) {
        request.start.time_s += leg_duration(part.route.leg(leg), request.start.time_s, request);
      }
    }
    request.budget.max_iterations = left_of(request.budget.max_iterations, part.counters);
    request.start.velocity = velocity_at_end(whole.route, request);
    request.start.position = whole.route.back();
    request.start.loiter.reset();
  }
  return whole;
}

namespace {
/// For a section in one wind: an equal part for each that may blow on the way.
Budget budget_in_one(const Wind& wind, const Request& request) {
  constexpr double kDetour = 2;  // of the straight way
  const double straight_s =
      (request.goal.position - request.start.position).norm() / request.air_speed();
  const double end_s = request.start.time_s + kDetour * straight_s;
  std::size_t winds = 1;
  for (double at_s = request.start.time_s; (at_s = wind.in_force_until(at_s)) < end_s;) {
    ++winds;
  }
  return part_of(request.budget, winds);
}
}  // namespace

PlanResult plan_in_winds(const Request& given, bool anytime, const PlanPart& plan_part) {
  if (given.wind.changes.empty()) {
    return plan_part(given);
  }
  PlanResult whole;
  Request request = given;
  for (bool goes_on = true; goes_on;) {
    const double until_s = given.wind.in_force_until(request.start.time_s);
    const State from = request.start;
    Request section = request;
    section.wind = given.wind.in_force(from.time_s);
    section.budget = anytime ? budget_in_one(given.wind, request) : request.budget;
    PlanResult part = plan_part(section);
    take_section(whole, part);
    goes_on = false;
    if (part.status == PlanStatus::solved) {
      Request then = request;
      then.wind = given.wind.in_force(until_s);
      FlownPart flown = flown_until(until_s, part.route, section, then);
      goes_on = !flown.is_all;
      whole.route.append(goes_on ? flown.route : part.route);
      request.start = flown.end;
      request.budget.max_iterations = left_of(request.budget.max_iterations, part.counters);
    }
    if (from.time_s > given.start.time_s) {
      whole.message += ", from " + request.place_text(from.position) +
                       " on, where the wind changes " + std::to_string(std::lround(from.time_s)) +
                       " s after the start";
    }
  }
  if (whole.status != PlanStatus::solved) {
    whole.route = {};
  }
  return whole;
}

FreshVia::FreshVia(Request request, std::vector<Goal> via, PlanPart plan_part, bool anytime)
    : request_(std::move(request)),
      via_(std::move(via)),
      plan_part_(std::move(plan_part)),
      anytime_(anytime) {
  take(plan_along(request_, via_, anytime_, plan_part_));
}

void FreshVia::take(PlanResult result) {
  result_ = std::move(result);
  if (result_.status == PlanStatus::solved) {
    flown_ = result_.route;
  }
}

const PlanResult& FreshVia::do_update(const State& state, const Goal& goal,
                                      std::shared_ptr<const World> world, std::span<const Change>,
                                      const Budget& budget) {
  const std::vector<std::size_t> at = via_indices(flown_, via_);
  const std::size_t leg = nearest_leg(flown_, state.position);
  const auto passed =
      std::count_if(at.begin(), at.end(), [&](std::size_t index) { return index <= leg; });
  via_.erase(via_.begin(), via_.begin() + passed);
  request_.start = state;
  request_.goal = goal;
  request_.world = std::move(world);
  request_.budget = budget;
  take(plan_along(request_, via_, anytime_, plan_part_));
  return result_;
}
}  // namespace altiplan::host
