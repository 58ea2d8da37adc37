// SPDX-License-Identifier: Apache-2.0
#include "altiplan/planner.hpp"

#include <string>
#include <utility>

#include "altiplan/check.hpp"
#include "altiplan/error.hpp"
#include "contract.hpp"

namespace altiplan {

// Key functions: the type_info of the interfaces lives in this library.
Planner::~Planner() = default;
Trace::~Trace() = default;

namespace {

/// True if the start lies within the goal's tolerance, on its course if both have one, or if both
/// are one loiter circle.
bool is_at_goal(const Request& request) {
  const State& start = request.start;
  const Goal& goal = request.goal;
  if (start.loiter) {
    return start.loiter == goal.loiter && start.position == goal.position;
  }
  const std::optional<Vec3> course = request.arrival_course(start.position);
  const bool is_on_course = !course || !has_heading(start.velocity) ||
                            turn_angle_horizontal(start.velocity, *course) <= kAngleTolerance;
  return goal.reached_at(start.position) && is_on_course;
}

/// Results that need no planner: infeasible ends, ends that the planner does not know, and a start
/// at the goal.
std::optional<PlanResult> settled(const Request& request, const Planner& planner) {
  std::optional<PlanResult> result = impossible_ends(request);
  if (!result && (request.start.loiter || request.goal.loiter) && !planner.traits().loiters) {
    result.emplace();
    result->status = PlanStatus::invalid_problem;
    result->reason = request.start.loiter ? Reason::start : Reason::goal;
    result->message = std::string("the ") + name(result->reason) +
                      " is a loiter circle, which this planner does not support: use one with the "
                      "trait `loiters`, such as hybrid_astar";
  }
  if (!result && request.objective) {
    if (const std::string why = objective_problem(*request.objective, planner.traits());
        !why.empty()) {
      result.emplace();
      result->status = PlanStatus::invalid_problem;
      result->message = "this planner " + why;
    }
  }
  if (!result && is_at_goal(request)) {
    const State& start = request.start;
    result.emplace();
    result->status = PlanStatus::solved;
    result->message = "the start is at the goal";
    result->route = {start.loiter ? start.loiter->circle(start.position).from : start.position};
    result->counters = {{"expanded", 0}};
  }
  return result;
}

/// Replans from scratch at every update.
class FreshSession final : public Session {
 public:
  FreshSession(const Planner& planner, const Request& request, PlanResult first)
      : planner_(planner), request_(request), result_(std::move(first)) {}

 private:
  const PlanResult& do_result() const override { return result_; }
  const PlanResult& do_update(const State& state, const Goal& goal,
                              std::shared_ptr<const World> world, std::span<const Change>,
                              const Budget& budget) override {
    request_.start = state;
    request_.goal = goal;
    request_.world = std::move(world);
    request_.budget = budget;
    result_ = planner_.plan(request_);
    return result_;
  }

  const Planner& planner_;
  Request request_;
  PlanResult result_;
};
}  // namespace

std::string objective_problem(const Objective& objective, const Traits& traits) {
  if (traits.whole_routes) {
    return "";
  }
  if (!traits.objectives) {
    return "minimises length alone, not an objective: use one with the trait `objectives`, such as "
           "astar";
  }
  const Objective::Traits its = objective.traits();
  return its.waypoints ? "minimises costs of legs, added up, not one of the whole route's "
                         "waypoints: use one with the trait `whole_routes`, such as pso"
         : its.time    ? "minimises no objective that depends on the time: use one with the "
                         "trait `whole_routes`, such as pso"
                       : "";
}

std::optional<PlanResult> impossible_ends(const Request& request) {
  for (const auto& [end, problem] : {std::pair(Reason::start, start_problem(request)),
                                     std::pair(Reason::goal, goal_problem(request))}) {
    if (!problem.empty()) {
      PlanResult result;
      result.status = PlanStatus::invalid_problem;
      result.reason = end;
      result.message = std::string("the ") + name(end) + " " + problem;
      return result;
    }
  }
  return std::nullopt;
}

PlanResult Planner::plan(const Request& request) const {
  if (auto result = settled(request, *this)) {
    return *std::move(result);
  }
  return held_to_contract(guarded([&] { return do_plan(request); }), request.start, request.goal,
                          request.budget);
}

std::unique_ptr<Session> Planner::begin(const Request& request) const {
  std::unique_ptr<Session> session;
  std::optional<PlanResult> first = settled(request, *this);
  if (!first || first->status != PlanStatus::invalid_problem) {
    first = guarded([&] {
      std::unique_ptr<Session> begun = do_begin(request);
      if (begun == nullptr) {
        throw PluginError("begin returned no session", Reason::contract);
      }
      PlanResult result =
          held_to_contract(begun->result(), request.start, request.goal, request.budget);
      session = std::move(begun);
      return result;
    });
  }
  if (session == nullptr) {  // the planner was not called, or had no time to begin one
    session = std::make_unique<FreshSession>(*this, request, *std::move(first));
  }
  return session;
}

std::unique_ptr<Session> Planner::do_begin(const Request& request) const {
  return std::make_unique<FreshSession>(*this, request, plan(request));
}
}  // namespace altiplan
