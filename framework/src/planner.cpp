// SPDX-License-Identifier: Apache-2.0
#include "altiplan/planner.hpp"

#include <algorithm>
#include <exception>
#include <functional>
#include <string>
#include <utility>

#include "altiplan/check.hpp"
#include "altiplan/error.hpp"
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
bool Constraint::do_admits(const Leg&) const { return true; }
std::vector<Violation> Constraint::do_violations(const Route&, const Request&) const { return {}; }

namespace {

PlanResult failed(std::string message) {
  PlanResult result;
  result.status = Status::failed;
  result.message = std::move(message);
  return result;
}

/// Runs a plugin's code: what it throws becomes the result, except the framework's own wrong-use
/// errors, which are the user's to mend.
PlanResult guarded(const std::function<PlanResult()>& call) {
  try {
    return call();
  } catch (const ParameterError&) {
    throw;
  } catch (const BudgetSpent& spent) {
    PlanResult result;
    result.status = spent.cancelled() ? Status::cancelled : Status::timed_out;
    result.budget_hit = true;
    result.message = (spent.cancelled() ? "cancelled: " : "the budget was used up: ") +
                     std::string(spent.what());
    result.counters = {{"expanded", 0}};
    return result;
  } catch (const std::exception& error) {
    return failed(std::string("threw: ") + error.what());
  } catch (...) {
    return failed("threw something that is not a std::exception");
  }
}

bool same(const PlanResult& a, const PlanResult& b) {
  return a.status == b.status && a.message == b.message && a.route == b.route &&
         a.budget_hit == b.budget_hit && a.proved == b.proved &&
         std::equal(a.counters.begin(), a.counters.end(), b.counters.begin(), b.counters.end(),
                    [](const Counter& x, const Counter& y) {
                      return x.name == y.name && x.value == y.value;
                    });
}

/// Holds a returned route to the law on its ends; `start` and `goal` are those asked for.
PlanResult held_to_law(PlanResult result, const Vec3& start, const Goal& goal) {
  if (result.status != Status::solved) {
    return result;
  }
  std::string broken;
  if (result.route.empty()) {
    broken = "says solved but returns no route";
  } else if (!std::all_of(result.route.begin(), result.route.end(), is_finite)) {
    broken = "returns a route with a coordinate that is not finite";
  } else if (result.route.front() != start) {
    broken = "returns a route that does not begin at the start";
  } else if (!goal.reached_at(result.route.back())) {
    broken = "returns a route that ends " +
             std::to_string((result.route.back() - goal.position).norm()) +
             " m from the goal, outside its tolerance";
  }
  if (!broken.empty()) {
    result.status = Status::failed;
    result.message = "the planner broke a law of its interface: " + broken;
  }
  return result;
}

/// What needs no planner: impossible end points, and a start that is the goal.
std::optional<PlanResult> settled(const Request& request) {
  for (const auto& [what, p] :
       {std::pair("start", request.start.position), std::pair("goal", request.goal.position)}) {
    const std::string problem = point_problem(p, request);
    if (!problem.empty()) {
      PlanResult result;
      result.status = Status::invalid_problem;
      result.message = std::string("the ") + what + " " + problem;
      return result;
    }
  }
  if (request.goal.reached_at(request.start.position)) {
    PlanResult result;
    result.status = Status::solved;
    result.message = "the start is at the goal";
    result.route = {request.start.position};
    result.counters = {{"expanded", 0}};
    return result;
  }
  return std::nullopt;
}

/// Plans afresh at every update.
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

/// A session whose planner was not asked, or whose update failed, still has a result to show.
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

const PlanResult& Session::update(const State& state, const Goal& goal,
                                  std::shared_ptr<const World> world,
                                  std::span<const Change> changes, const Budget& budget) {
  bool answered = false;
  const PlanResult said = guarded([&] {
    PlanResult result = do_update(state, goal, std::move(world), changes, budget);
    answered = true;
    return result;
  });
  const PlanResult shown = guarded([&] { return do_result(); });
  PlanResult held = held_to_law(said, state.position, goal);
  if (answered && held.status != Status::failed && !same(said, shown)) {
    held = failed("the session broke a law of its interface: result() is not what update returned");
  }
  broken_.reset();
  if (!answered || held.status == Status::failed) {
    broken_ = std::move(held);
  }
  return result();
}

PlanResult Planner::plan(const Request& request) const {
  if (auto result = settled(request)) {
    return *std::move(result);
  }
  return held_to_law(guarded([&] { return do_plan(request); }), request.start.position,
                     request.goal);
}

std::unique_ptr<Session> Planner::begin(const Request& request) const {
  if (auto result = settled(request); result && result->status == Status::invalid_problem) {
    return std::make_unique<HeldSession>(*std::move(result));
  }
  std::unique_ptr<Session> session;
  PlanResult failure = guarded([&] {
    session = do_begin(request);
    return session == nullptr ? failed("begin returned no session") : PlanResult{};
  });
  if (session == nullptr) {
    return std::make_unique<HeldSession>(std::move(failure));
  }
  PlanResult first =
      held_to_law(guarded([&] { return session->result(); }), request.start.position, request.goal);
  return first.status == Status::failed ? std::make_unique<HeldSession>(std::move(first))
                                        : std::move(session);
}

std::unique_ptr<Session> Planner::do_begin(const Request& request) const {
  return std::make_unique<FreshSession>(*this, request);
}

std::unique_ptr<Pilot> LocalPlanner::begin(const Request& request) const {
  std::unique_ptr<Pilot> pilot = do_begin(request);
  if (pilot == nullptr) {
    throw PluginError("the local planner broke a law of its interface: begin returned no pilot");
  }
  return pilot;
}

Traits LocalPlanner::do_traits() const { return {}; }

double Pilot::reach_m() const {
  const double reach = do_reach_m();
  if (!(reach >= 0 && std::isfinite(reach))) {
    throw PluginError("the pilot broke a law of its interface: its reach is " +
                      std::to_string(reach) + " m");
  }
  return reach;
}

PilotStep Pilot::step(const Observation& seen) {
  PilotStep step = do_step(seen);
  if (step.outcome != PilotStep::Outcome::stuck) {
    const double dt = step.next.time_s - seen.state.time_s;
    if (!is_finite(step.next.position) || !(dt > 0) || dt > seen.max_dt_s * (1 + 1e-9)) {
      throw PluginError(
          "the pilot broke a law of its interface: a step must end at a finite place "
          "after more than 0 and at most max_dt seconds");
    }
  }
  return step;
}

Counters Pilot::do_counters() const { return {}; }

PlanResult Smoother::smooth(const Route& route, const Request& request) const {
  if (route.size() <= 2) {
    PlanResult result;
    result.status = Status::solved;
    result.message = "nothing to smooth";
    result.route = route;
    return result;
  }
  PlanResult result = guarded([&] { return do_smooth(route, request); });
  if (result.status == Status::solved &&
      (result.route.empty() || result.route.front() != route.front() ||
       result.route.back() != route.back() ||
       !std::all_of(result.route.begin(), result.route.end(), is_finite))) {
    result.status = Status::failed;
    result.message =
        "the smoother broke a law of its interface: first and last points must stay, all finite";
  }
  return result;
}
}  // namespace altiplan
