// SPDX-License-Identifier: Apache-2.0
#include "host/run/along_task.hpp"

#include "altiplan/check.hpp"
#include "altiplan/environment.hpp"
#include "altiplan/flown_route.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {

TaskSections::Ends TaskSections::ends_of(const Vec3& from, const Vec3& to) {
  return {from.x(), from.y(), from.z(), to.x(), to.y(), to.z()};
}

TaskSections::TaskSections(TaskOrder order, const TaskEnds& ends, const Request& request)
    : order_(std::move(order)) {
  points_.push_back(order_.first(ends));
  begins_pass_.push_back(false);
  for (const Pass& pass : order_.passes) {
    add(pass.points[0], {false, pass.join});
    for (std::size_t i = 1; i < pass.points.size(); ++i) {
      add(pass.points[i], {true, {}});
    }
    stops_s_.push_back(pass.stop.seconds(pass.points.back(), request));
    add(pass.points.back(), {false, {}, stops_s_.back()});
  }
  add(order_.last(ends), {false, order_.last_join});
}

/// Sections without length or a stop are left out.
void TaskSections::add(const Vec3& to, const Section& section) {
  const Vec3 from = points_.back();
  if (from == to && section.join.empty() && section.stop_s == 0) {
    return;
  }
  Section& added = sections_[ends_of(from, to)];
  const bool is_pass = added.is_pass || section.is_pass;
  added = section;
  added.is_pass = is_pass;
  begins_pass_.back() = begins_pass_.back() || section.is_pass;
  points_.push_back(to);
  begins_pass_.push_back(false);
}

std::vector<Goal> TaskSections::via(const Request& request) const {
  std::vector<Goal> all;
  for (std::size_t i = 1; i + 1 < points_.size(); ++i) {
    Goal& goal = all.emplace_back();
    goal.position = points_[i];
    if (request.vehicle.wing && begins_pass_[i]) {
      goal.heading = request.heading_on(points_[i + 1] - points_[i], points_[i]);
    }
  }
  return all;
}

std::vector<double> TaskSections::flights(const Request& request) const {
  std::vector<double> seconds;
  TaskOrder flight;
  Vec3 from = points_.front();
  const auto land = [&](const Vec3& at) {
    seconds.push_back(flown_time(flight.route({from, at}, request), request));
    flight.passes.clear();
    from = at;
  };
  for (std::size_t i = 0; i < order_.passes.size(); ++i) {
    Pass pass = order_.passes[i];
    if (pass.takes_off && i > 0) {  // the way there ends the flight before
      flight.last_join = std::move(pass.join);
      pass.join.clear();
      land(pass.points.front());
    }
    flight.passes.push_back(std::move(pass));
  }
  flight.last_join = order_.last_join;
  land(points_.back());
  return seconds;
}

PlanPart TaskSections::part(PlanPart plan_part) const {
  return [this, plan_part = std::move(plan_part)](const Request& request) {
    const auto found = sections_.find(ends_of(request.start.position, request.goal.position));
    if (found == sections_.end()) {
      return plan_part(request);
    }
    const Section& section = found->second;
    PlanResult result;
    result.status = PlanStatus::solved;
    if (section.stop_s > 0) {
      result.route = Route{request.start.position};
      result.route.push_back(Leg::hold(request.start.position, section.stop_s));
      return result;
    }
    Polyline flown{request.start.position};
    flown.insert(flown.end(), section.join.begin(), section.join.end());
    flown.push_back(request.goal.position);
    result.route = Route(std::move(flown));
    // A pass is flown whatever is in its way: the judge names that.
    return section.is_pass || check(result.route, request).ok() ? result : plan_part(request);
  };
}

namespace {
/// Why a vehicle cannot land below a place; "" if it can.
std::string landing_problem(const Vec3& at, const Request& request) {
  const std::optional<double> ground = request.world->ground(at.x(), at.y());
  if (!ground) {
    return "no ground is known below it";
  }
  if (avoids_moving(request)) {
    return "what moves beside its way down is not judged";
  }
  for (const Layer& layer : request.world->layers()) {
    if (layer.environment->ground() == nullptr &&
        layer.environment->blocked({at.x(), at.y(), *ground}, at, request.vehicle.reach_m())) {
      return "its way down passes too close to '" + layer.id + "'";
    }
  }
  return "";
}
}  // namespace

std::optional<Violation> TaskSections::violation(const Route& route, const Request& request) const {
  std::size_t at = 0;
  for (std::size_t k = 0; k < order_.passes.size(); ++k) {
    const Pass& flown = order_.passes[k];
    const Polyline& pass = flown.points;
    const auto broken = [&](const std::string& what) {
      return Violation{"task", at, double(k), double(order_.passes.size()), what};
    };
    const auto flies_from = [&](std::size_t i) {
      for (std::size_t j = 0; j < pass.size(); ++j) {
        if ((route[i + j] - pass[j]).norm() > kLengthTolerance ||
            (j > 0 && route.leg(i + j - 1).turns())) {
          return false;
        }
      }
      return true;
    };
    while (at + pass.size() <= route.size() && !flies_from(at)) {
      ++at;
    }
    if (at + pass.size() > route.size()) {
      at = 0;
      return broken("the route does not fly pass " + std::to_string(k) + " of the task");
    }
    at += pass.size() - 1;
    double waited_s = 0;
    while (at < route.leg_count() && (route[at + 1] - pass.back()).norm() <= kLengthTolerance) {
      waited_s += route.leg(at++).hold_s;
    }
    if (waited_s < stops_s_[k] * (1 - 1e-9)) {
      return broken("the route does not stop after pass " + std::to_string(k) +
                    " of the task for " + with_decimals(stops_s_[k], 1) + " s");
    }
    if (flown.stop.lands) {
      if (const std::string problem = landing_problem(pass.back(), request); !problem.empty()) {
        return broken("the landing after pass " + std::to_string(k) + " of the task: " + problem);
      }
    }
  }
  return std::nullopt;
}
}  // namespace altiplan::host
