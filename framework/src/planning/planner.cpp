// SPDX-License-Identifier: Apache-2.0
#include "altiplan/planner.hpp"

#include <algorithm>
#include <exception>
#include <functional>
#include <string>
#include <utility>

#include "altiplan/check.hpp"
#include "altiplan/error.hpp"
#include "altiplan/leg_limits.hpp"
#include "altiplan/local_planner.hpp"
#include "altiplan/smoother.hpp"

namespace altiplan {

// Key functions of the interfaces: their type_info lives in this library.
Trace::~Trace() = default;
Constraint::~Constraint() = default;
Session::~Session() = default;
Planner::~Planner() = default;
Pilot::~Pilot() = default;
LocalPlanner::~LocalPlanner() = default;
Smoother::~Smoother() = default;

AppliesTo Constraint::do_applies_to() const { return AppliesTo::both; }
void Constraint::do_tighten(Limits&, const Request&) const {}

namespace {
thread_local bool is_inherited = false;  ///< set where do_admits is not overridden
}
bool Constraint::do_admits(const Motion&) const { return is_inherited = true; }
bool Constraint::admits_all() const {
  is_inherited = false;
  try {
    (void)admits({std::nullopt, Vec3::Zero(), Vec3::Zero()});
  } catch (...) {  // overridden; what it throws is told where a leg is judged
    return false;
  }
  return is_inherited;
}
std::vector<Violation> Constraint::do_violations(const Polyline&, const Request&) const {
  return {};
}

namespace {

/// Runs a plugin's code: exceptions become PluginError, except the framework's own misuse errors,
/// which the user has to correct, and the end of a budget, which is a result.
PlanResult guarded(const std::function<PlanResult()>& call) {
  try {
    return call();
  } catch (const ParameterError&) {
    throw;
  } catch (const PluginError&) {
    throw;
  } catch (const BudgetSpent& spent) {
    PlanResult result;
    result.status = spent.cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out;
    result.reason = spent.cancelled() ? Reason::none : Reason::deadline;
    result.budget_hit = true;
    result.message = (spent.cancelled() ? "cancelled: " : "the budget was used up: ") +
                     std::string(spent.what());
    result.counters = {{"expanded", 0}};
    return result;
  } catch (...) {
    attribute_to("");
  }
}

constexpr const char* kMalformedLeg =
    "returns a leg with a number that is not finite, or a turn without a radius above 0 or of more "
    "than a hundred circles";

bool same(const PlanResult& a, const PlanResult& b) {
  return a.status == b.status && a.message == b.message && a.route == b.route &&
         a.budget_hit == b.budget_hit && a.proved == b.proved &&
         std::equal(a.counters.begin(), a.counters.end(), b.counters.begin(), b.counters.end(),
                    [](const Counter& x, const Counter& y) {
                      return x.name == y.name && x.value == y.value;
                    });
}

/// The part of its budget that ended a plan, as far as that is visible from outside.
Reason spent_part(const PlanResult& result, const Budget& budget) {
  for (const Counter& counter : result.counters) {
    if (counter.name == "expanded" && std::uint64_t(counter.value) >= budget.max_iterations) {
      return Reason::iterations;
    }
  }
  return budget.deadline && Budget::Clock::now() >= *budget.deadline ? Reason::deadline
                                                                     : Reason::none;
}

bool legs_are_well_formed(const Route& route) {
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    if (!is_well_formed(route.leg(i))) {
      return false;
    }
  }
  return true;
}

/// Checks a result against the contract on a route's ends; `start` and `goal` are those requested.
PlanResult held_to_contract(PlanResult result, const State& start, const Goal& goal,
                            const Budget& budget) {
  if (result.status == PlanStatus::timed_out && result.reason == Reason::none) {
    result.reason = spent_part(result, budget);
  }
  const auto broken = [](Reason reason, const std::string& how) {
    return PluginError("the planner violated the contract of its interface: " + how, reason);
  };
  if (result.status == PlanStatus::no_route && result.message.empty()) {
    throw broken(Reason::contract, "returns no route and gives no reason");
  }
  if (result.status != PlanStatus::solved) {
    return result;
  }
  if (result.route.empty()) {
    throw broken(Reason::contract, "reports solved but returns no route");
  }
  if (!std::all_of(result.route.begin(), result.route.end(), is_finite)) {
    throw broken(Reason::contract, "returns a route with a coordinate that is not finite");
  }
  if (!legs_are_well_formed(result.route)) {
    throw broken(Reason::contract, kMalformedLeg);
  }
  if (!start.starts_at(result.route.front())) {
    throw broken(Reason::contract_of_ends, "returns a route that does not begin at the start");
  }
  if (!goal.reached_at(result.route.back())) {
    throw broken(Reason::contract_of_ends,
                 "returns a route that ends " +
                     std::to_string((result.route.back() - goal.position).norm()) +
                     " m from the goal, outside its tolerance");
  }
  return result;
}

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
  FreshSession(const Planner& planner, const Request& request)
      : planner_(planner), request_(request), result_(planner.plan(request)) {}

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

/// Session of an infeasible problem, for which no planner was called.
class HeldSession final : public Session {
 public:
  explicit HeldSession(PlanResult result) : result_(std::move(result)) {}

 private:
  const PlanResult& do_result() const override { return result_; }
  const PlanResult& do_update(const State&, const Goal&, std::shared_ptr<const World>,
                              std::span<const Change>, const Budget&) override {
    return result_;
  }
  PlanResult result_;
};
}  // namespace

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

PlanResult Session::update(const State& state, const Goal& goal, std::shared_ptr<const World> world,
                           std::span<const Change> changes, const Budget& budget) {
  PlanResult said = held_to_contract(
      guarded([&] { return do_update(state, goal, std::move(world), changes, budget); }), state,
      goal, budget);
  const PlanResult shown = guarded([&] { return do_result(); });
  if (!same(said, shown)) {
    throw PluginError(
        "the session violated the contract of its interface: result() is not what update returned",
        Reason::contract_of_results);
  }
  return said;
}

namespace {
/// Names the constraints that refuse a leg of no length at the start or the goal, for a message.
std::string refusing_ends(const Request& request) {
  std::string text;
  for (const auto& [end, p] :
       {std::pair("start", request.start.position), std::pair("goal", request.goal.position)}) {
    for (const NamedConstraint& named : request.constraints) {
      if (!named.admits_all && !named.admits({std::nullopt, p, p, request.world.get()})) {
        text += "; the constraint '" + named.name + "' refuses the " + end + " itself";
      }
    }
  }
  return text;
}
}  // namespace

PlanResult Planner::plan(const Request& request) const {
  if (auto result = settled(request, *this)) {
    return *std::move(result);
  }
  PlanResult result = held_to_contract(guarded([&] { return do_plan(request); }), request.start,
                                       request.goal, request.budget);
  if (result.status == PlanStatus::no_route || result.status == PlanStatus::timed_out) {
    result.message += refusing_ends(request);
  }
  return result;
}

std::unique_ptr<Session> Planner::begin(const Request& request) const {
  if (auto result = settled(request, *this);
      result && result->status == PlanStatus::invalid_problem) {
    return std::make_unique<HeldSession>(*std::move(result));
  }
  std::unique_ptr<Session> session;
  guarded([&] {
    session = do_begin(request);
    if (session == nullptr) {
      throw PluginError("begin returned no session", Reason::contract);
    }
    return held_to_contract(session->result(), request.start, request.goal, request.budget);
  });
  return session;
}

std::unique_ptr<Session> Planner::do_begin(const Request& request) const {
  return std::make_unique<FreshSession>(*this, request);
}

std::unique_ptr<Pilot> LocalPlanner::begin(const Request& request) const {
  std::unique_ptr<Pilot> pilot = do_begin(request);
  if (pilot == nullptr) {
    throw PluginError(
        "the local planner violated the contract of its interface: begin returned no pilot",
        Reason::contract);
  }
  return pilot;
}

Traits LocalPlanner::do_traits() const { return {}; }

double Pilot::reach_m() const {
  const double reach = do_reach_m();
  if (!(reach >= 0 && std::isfinite(reach))) {
    throw PluginError("the pilot violated the contract of its interface: its reach is " +
                          std::to_string(reach) + " m",
                      Reason::contract);
  }
  return reach;
}

PilotStep Pilot::step(const Observation& seen) {
  PilotStep step = do_step(seen);
  if (step.outcome != PilotStep::Outcome::stuck) {
    const double dt = step.next.time_s - seen.state.time_s;
    if (!is_finite(step.next.position) || !(dt > 0) || dt > seen.max_dt_s * (1 + 1e-9)) {
      throw PluginError(
          "the pilot violated the contract of its interface: a step must end at a finite place "
          "after more than 0 and at most max_dt seconds",
          Reason::contract);
    }
  }
  return step;
}

Counters Pilot::do_counters() const { return {}; }

PlanResult Smoother::do_smooth_turns(const Route& route, const Request&) const {
  PlanResult result;
  result.status = PlanStatus::solved;
  result.message =
      "left unchanged: this smoother takes straight legs only, and the route has turns";
  result.route = route;
  return result;
}

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
  return result;
}
}  // namespace altiplan
