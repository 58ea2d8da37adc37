// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "planner_bench.hpp"

namespace altiplan::conformance {
namespace {

constexpr const char* kContinues =
    "Session contract 1: update continues from the given state, where its route begins";
constexpr const char* kKeepsResult =
    "Session contract 2: after an update, result() is what it returned";
constexpr const char* kIncremental =
    "Planner trait `incremental`: the session keeps what it searched";

/// A session and the current problem; every result is judged.
class Flown {
 public:
  Flown(const PlannerBench& bench, Scene scene, Report& report)
      : planner_(bench.make()), scene_(std::move(scene)), report_(report) {
    session_ = planner_->begin(scene_.request);
    judge(report_, session_->result(), scene_);
  }

  Scene& scene() { return scene_; }
  const PlanResult& result() const { return session_->result(); }
  Traits traits() const { return planner_->traits(); }

  PlanResult update(const std::string& what, const std::vector<Change>& changes = {}) {
    const Request& request = scene_.request;
    Scene scene = scene_;
    scene.name += ", " + what;
    PlanResult result;
    try {
      result =
          session_->update(request.start, request.goal, request.world, changes, request.budget);
    } catch (const PluginError& error) {  // Session::update checks both clauses of the contract
      const bool contract_of_results = error.reason() == Reason::contract_of_results;
      if (!contract_of_results && error.reason() != Reason::contract_of_ends) {
        throw;
      }
      report_.add(
          contract_of_results ? kKeepsResult : kContinues,
          scene.name + ", the state at " + text(request.start.position) + ": " + error.what());
      return result;
    }
    report_.expect(equal(result, session_->result()), kKeepsResult, [&] {
      return scene.name + ": update returned " + text(result) + ", result() is " +
             text(session_->result());
    });
    judge(report_, result, scene);
    return result;
  }

 private:
  std::unique_ptr<Planner> planner_;
  Scene scene_;
  Report& report_;
  std::unique_ptr<Session> session_;
};

void goes_on(const PlannerBench& bench, Report& report) {
  for (int n = 0; n < bench.options.rounds; ++n) {
    Flown flown(bench, bench.world(std::uint64_t(n), bench.flight()), report);
    if (flown.result().status != PlanStatus::solved) {
      continue;
    }
    flown.update("an update with no change");
    const Route route = flown.result().route;
    if (route.empty()) {
      continue;
    }
    State& state = flown.scene().request.start;
    for (std::size_t i = 0; i + 1 < route.size() && i < 3; ++i) {
      state.position = route[i] + 0.37 * (route[i + 1] - route[i]);
      if (flown.scene().request.level_m) {
        state.position.z() = *flown.scene().request.level_m;
      }
      state.time_s += 5;
      flown.update("an update from leg " + std::to_string(i));
    }
    flown.scene().request.goal.position = route.front();
    flown.update("an update with the goal where the start was");
  }
}

/// Possible position of a ball: on the route, clear of its ends; none where the route is too short.
std::optional<Sphere> in_the_way(const Scene& scene, const Route& route) {
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    const Sphere ball{(route[i] + route[i + 1]) / 2, 0.8 * scene.unit};
    const double room = ball.radius + 2 * scene.request.vehicle.radius_m;
    if ((ball.centre - scene.request.start.position).norm() > room &&
        (ball.centre - scene.request.goal.position).norm() > room) {
      return ball;
    }
  }
  return std::nullopt;
}

void changes_taken(const PlannerBench& bench, Report& report) {
  for (int n = 0; n < bench.options.rounds; ++n) {
    Flown flown(bench, bench.world(std::uint64_t(n), bench.flight()), report);
    const Scene first = flown.scene();
    std::vector<Change> changes;
    for (int k = 0; k < 3 && flown.result().status == PlanStatus::solved; ++k) {
      const auto ball = in_the_way(flown.scene(), flown.result().route);
      if (!ball) {
        break;
      }
      with_solid(flown.scene(), *ball, "ball" + std::to_string(k), changes);
      flown.update("an update with a ball on the route", changes);
    }
    std::vector<Change> removed;
    for (const Layer& layer : flown.scene().request.world->layers()) {
      if (layer.id.starts_with("ball")) {
        removed.push_back({Change::Kind::remove, layer.id, layer.environment->bounds()});
      }
    }
    flown.scene().solids = first.solids;
    World back = *flown.scene().request.world;
    for (const Change& change : removed) {
      back = back.without(change.layer);
    }
    flown.scene().request.world = std::make_shared<const World>(std::move(back));
    flown.update("an update with the balls gone", removed);
  }
}

void hopeless_updates(const PlannerBench& bench, Report& report) {
  for (int n = 0; n < bench.options.rounds; ++n) {
    Flown flown(bench, bench.world(std::uint64_t(n), bench.flight()), report);
    const Scene first = flown.scene();
    std::vector<Change> changes;
    for (const bool at_start : {true, false}) {
      const Vec3 at = at_start ? first.request.start.position : first.request.goal.position;
      with_solid(flown.scene(), Sphere{at, bench.options.unit_m / 2}, "over", changes);
      const PlanResult result = flown.update(
          std::string("an update with a ball over the ") + (at_start ? "state" : "goal"), changes);
      report.expect(result.status != PlanStatus::solved, kPlannerStatus, [&] {
        return first.name + ": solved, with a ball over the " + (at_start ? "state" : "goal");
      });
      changes[0].kind = Change::Kind::remove;
      flown.scene().solids = first.solids;
      flown.scene().request.world =
          std::make_shared<const World>(flown.scene().request.world->without("over"));
      flown.update("an update with the ball gone", changes);
    }
    flown.scene().request.budget.max_iterations = 0;
    const PlanResult result = flown.update("an update with a budget of 0 iterations");
    report.expect(counter(result.counters, "expanded") <= 0, kPlannerBudget, [&] {
      return first.name + ": an update with a budget of 0 iterations used " +
             std::to_string(counter(result.counters, "expanded"));
    });
  }
}

void equal_sessions(const PlannerBench& bench, Report& report) {
  const Scene scene = bench.world(0, bench.flight());
  std::vector<PlanResult> both[2];
  for (auto& results : both) {
    Flown flown(bench, scene, report);
    results.push_back(flown.result());
    std::vector<Change> changes;
    if (const auto ball = in_the_way(scene, flown.result().route)) {
      with_solid(flown.scene(), *ball, "ball", changes);
    }
    results.push_back(flown.update("an update", changes));
    results.push_back(flown.update("another update"));
  }
  report.expect(std::equal(both[0].begin(), both[0].end(), both[1].begin(), equal), kPlannerPure,
                [&] { return scene.name + ": two sessions with equal updates differ"; });
}

void incremental(const PlannerBench& bench, Report& report) {
  for (int n = 0; n < bench.options.rounds; ++n) {
    Flown flown(bench, bench.world(std::uint64_t(n), bench.flight()), report);
    if (!flown.traits().incremental || flown.result().status != PlanStatus::solved) {
      continue;
    }
    const std::int64_t first = counter(flown.result().counters, "expanded");
    const std::int64_t again =
        counter(flown.update("an update with no change").counters, "expanded");
    report.expect(again < first || first <= 1, kIncremental, [&] {
      return flown.scene().name + ": the plan expanded " + std::to_string(first) +
             ", an update with no change " + std::to_string(again);
    });
  }
}
}  // namespace

Cases session_cases(const PlannerBench& bench) {
  return planner_cases_on(bench, {{"session_goes_on_along_its_route", goes_on},
                                  {"session_takes_changes", changes_taken},
                                  {"session_survives_hopeless_updates", hopeless_updates},
                                  {"session_equal_updates_give_equal_results", equal_sessions},
                                  {"trait_incremental", incremental}});
}
}  // namespace altiplan::conformance
