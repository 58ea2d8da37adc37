// SPDX-License-Identifier: Apache-2.0
#include "host/run/along_task.hpp"

#include "altiplan/check.hpp"
#include "altiplan/flown_route.hpp"

namespace altiplan::host {

TaskSections::Ends TaskSections::ends_of(const Vec3& from, const Vec3& to) {
  return {from.x(), from.y(), from.z(), to.x(), to.y(), to.z()};
}

TaskSections::TaskSections(TaskOrder order, const TaskEnds& ends) : order_(std::move(order)) {
  points_.push_back(order_.first(ends));
  begins_pass_.push_back(false);
  for (const Pass& pass : order_.passes) {
    add(pass.points[0], false, pass.join);
    for (std::size_t i = 1; i < pass.points.size(); ++i) {
      add(pass.points[i], true, {});
    }
  }
  add(order_.last(ends), false, order_.last_join);
}

/// Sections without length are left out.
void TaskSections::add(const Vec3& to, bool is_pass, const Polyline& join) {
  const Vec3 from = points_.back();
  if (from == to && join.empty()) {
    return;
  }
  Section& section = sections_[ends_of(from, to)];
  section.is_pass = section.is_pass || is_pass;
  section.join = join;
  begins_pass_.back() = begins_pass_.back() || is_pass;
  points_.push_back(to);
  begins_pass_.push_back(false);
}

std::vector<Goal> TaskSections::via(const Request& request) const {
  std::vector<Goal> all;
  for (std::size_t i = 1; i + 1 < points_.size(); ++i) {
    Goal& goal = all.emplace_back();
    goal.position = points_[i];
    if (request.vehicle.wing && begins_pass_[i]) {
      goal.heading = request.heading_on(points_[i + 1] - points_[i], points_[i].z());
    }
  }
  return all;
}

std::vector<double> TaskSections::flights(const Request& request) const {
  std::vector<double> seconds;
  Polyline flown{points_.front()};
  const auto land = [&] {
    seconds.push_back(flown_time(Route(without_repeats(flown)), request));
    flown = {flown.back()};
  };
  for (std::size_t i = 0; i < order_.passes.size(); ++i) {
    const Pass& pass = order_.passes[i];
    if (pass.takes_off && i > 0) {
      land();
    }
    flown.insert(flown.end(), pass.join.begin(), pass.join.end());
    flown.insert(flown.end(), pass.points.begin(), pass.points.end());
  }
  flown.insert(flown.end(), order_.last_join.begin(), order_.last_join.end());
  flown.push_back(points_.back());
  land();
  return seconds;
}

PlanPart TaskSections::part(PlanPart plan_part) const {
  return [this, plan_part = std::move(plan_part)](const Request& request) {
    const auto found = sections_.find(ends_of(request.start.position, request.goal.position));
    if (found == sections_.end()) {
      return plan_part(request);
    }
    Polyline flown{request.start.position};
    flown.insert(flown.end(), found->second.join.begin(), found->second.join.end());
    flown.push_back(request.goal.position);
    PlanResult result;
    result.status = PlanStatus::solved;
    result.route = Route(std::move(flown));
    // A pass is flown whatever is in its way: the judge names that.
    return found->second.is_pass || check(result.route, request).ok() ? result : plan_part(request);
  };
}

std::optional<Violation> TaskSections::violation(const Route& route) const {
  std::size_t at = 0;
  for (std::size_t k = 0; k < order_.passes.size(); ++k) {
    const Polyline& pass = order_.passes[k].points;
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
      return Violation{"task", 0, double(k), double(order_.passes.size()),
                       "the route does not fly pass " + std::to_string(k) + " of the task"};
    }
    at += pass.size() - 1;
  }
  return std::nullopt;
}
}  // namespace altiplan::host
