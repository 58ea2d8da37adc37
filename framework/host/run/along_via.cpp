// SPDX-License-Identifier: Apache-2.0
#include "host/run/along_via.hpp"

#include <algorithm>
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

/// The vehicle's velocity at the end of a route.
Vec3 velocity_at_end(const Route& route, double speed) {
  for (std::size_t i = route.leg_count(); i-- > 0;) {
    const Vec3 way = route.leg(i).track(1);
    if (way.norm() >= kLengthTolerance) {
      return way.normalized() * speed;
    }
  }
  return Vec3::Zero();
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
    add_counters(whole.counters, part.counters);
    whole.budget_hit = whole.budget_hit || part.budget_hit;
    whole.proved = part.proved;
    whole.status = part.status;
    whole.reason = part.reason;
    whole.message = part.message;
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
    if (avoids_moving(request)) {
      for (std::size_t leg = 0; leg < part.route.leg_count(); ++leg) {
        request.start.time_s += leg_duration(part.route.leg(leg), request);
      }
    }
    request.budget.max_iterations = left_of(request.budget.max_iterations, part.counters);
    request.start.velocity = velocity_at_end(whole.route, request.vehicle.speed_mps);
    request.start.position = whole.route.back();
    request.start.loiter.reset();
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
