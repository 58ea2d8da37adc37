// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <utility>

#include "planner_bench.hpp"

namespace altiplan::conformance {

Cases planner_cases_on(const PlannerBench& bench, Bodies<PlannerBench> bodies) {
  Cases cases;
  for (const auto& [name, body] : bodies) {
    cases.push_back(make_case(name, kPlannerStatus, [bench, body = body](Report& report) {
      try {
        body(bench, report);
      } catch (const PluginError& error) {
        if (error.reason() != Reason::contract_of_ends) {
          throw;
        }
        report.add(kPlannerEnds, error.what());
      }
    }));
  }
  return cases;
}

bool judge(Report& report, const PlanResult& result, const Scene& scene) {
  const auto report_text = [&](const std::string& what) {
    return [&, what] {
      return scene.name + ": the planner " + what + "; it returned " + text(result);
    };
  };
  if (result.status != PlanStatus::solved) {
    const bool known =
        result.status == PlanStatus::no_route || result.status == PlanStatus::timed_out ||
        result.status == PlanStatus::cancelled || result.status == PlanStatus::invalid_problem;
    report.expect(known, kPlannerStatus, report_text("returns an undefined status"));
    report.expect(result.route.empty(), kPlannerStatus,
                  report_text("returns a route, but not the status solved"));
    report.expect(result.status != PlanStatus::no_route || !result.message.empty(), kPlannerStatus,
                  report_text("gives no reason for finding no route"));
    return false;
  }
  const std::string fault = unsound(result.route, scene);
  const bool ends = fault.find("begins at") == 0 || fault.find("ends at") == 0;
  report.expect(fault.empty(), ends ? kPlannerEnds : kPlannerLegs, [&] {
    return scene.name + ": the planner's route " + fault + ": " + text(result.route);
  });
  report.expect(counter(result.counters, "expanded") >= 0, kPlannerBudget,
                report_text("does not count what it `expanded`"));
  return true;
}

namespace {

// Tops of walls, in units: one to fly over, one to fly around.
constexpr double kLow = 2.2;
constexpr double kHigh = 7;

void seeded_worlds(const PlannerBench& bench, Report& report) {
  int solved = 0;
  for (const Flight flight : bench.flights()) {
    for (int n = 0; n < bench.options.rounds; ++n) {
      for (const Scene& scene :
           {bench.world(std::uint64_t(n), flight), bench.cells(std::uint64_t(n), flight)}) {
        solved += judge(report, bench.make()->plan(scene.request), scene);
      }
    }
    for (const Scene& scene :
         {open_scene(bench.options.unit_m, flight), wall_scene(bench.options.unit_m, kLow, flight),
          wall_scene(bench.options.unit_m, kHigh, flight)}) {
      const Scene budgeted = bench.budgeted(scene);
      solved += judge(report, bench.make()->plan(budgeted.request), budgeted);
    }
  }
  report.expect(solved > 0, kNothingToJudge, [&] {
    return "the planner solved none of the worlds: set unit_m (now " + text(bench.options.unit_m) +
           " m) to what it resolves well, or more iterations";
  });
}

void large_coordinates(const PlannerBench& bench, Report& report) {
  const Flight flight = bench.flight();
  for (const Vec3& by : {Vec3(500'000, 4'649'776, 3000), Vec3(-166'021.443, -9'997'964.5, -400)}) {
    for (int n = 0; n < bench.options.rounds / 2; ++n) {
      const Scene scene = moved_scene(bench.world(std::uint64_t(n), flight), by);
      judge(report, bench.make()->plan(scene.request), scene);
    }
  }
}

void million_obstacles(const PlannerBench& bench, Report& report) {
  for (const Flight flight : bench.flights()) {
    Scene scene = bench.budgeted(crowded_scene(bench.options.unit_m, flight));
    judge(report, bench.make()->plan(scene.request), scene);
  }
}

/// A third-party constraint that depends on two legs at a time.
class NoSharpTurns final : public Constraint {
 private:
  bool do_admits(const Motion& leg) const override {
    return !leg.before ||
           turn_angle_in_space(leg.from - *leg.before, leg.to - leg.from) <= radians(40);
  }
};

/// Each limit in turn, on the same worlds.
void limits_honoured(const PlannerBench& bench, Report& report) {
  const double unit = bench.options.unit_m;
  const std::vector<std::pair<const char*, std::function<void(Request&)>>> limits{
      {"climb 35 degrees", [](Request& r) { r.limits.max_climb = radians(35); }},
      {"turn 40 degrees", [](Request& r) { r.limits.max_turn_horizontal = radians(40); }},
      {"turn in space 40 degrees", [](Request& r) { r.limits.max_turn_space = radians(40); }},
      {"turn radius 1 unit", [&](Request& r) { r.limits.min_turn_radius = unit; }},
      {"clearance half a unit", [&](Request& r) { r.limits.min_clearance = unit / 2; }},
      {"vehicle's radius half a unit", [&](Request& r) { r.vehicle.radius_m = unit / 2; }},
      {"the body of a flat wing",
       [&](Request& r) {
         r.vehicle.body = flat_wing(unit);
         r.vehicle.radius_m = r.limits.min_clearance = r.vehicle.body->inner_m();
       }},
      {"longest leg 4 units", [&](Request& r) { r.limits.max_leg = 4 * unit; }},
      {"shortest leg half a unit", [&](Request& r) { r.limits.min_leg = unit / 2; }},
      {"altitude",
       [&](Request& r) {
         const double highest = std::max(r.start.position.z(), r.goal.position.z());
         r.limits.altitude.push_back({AltitudeBand::Datum::sea, unit, highest + unit / 2});
       }},
      {"route length 1.1 of the straight path",
       [&](Request& r) {
         r.limits.max_route_length = 1.1 * (r.goal.position - r.start.position).norm();
       }},
      {"heading away from the goal, turn 100 degrees",
       [](Request& r) {
         r.start.velocity = {-1, 0, 0};
         r.limits.max_turn_horizontal = radians(100);
       }},
      {"a custom constraint: no turn in 3-D above 40 degrees", [](Request& r) {
         r.constraints.push_back({"no_sharp_turns", std::make_shared<NoSharpTurns>()});
       }}};
  for (const auto& [name, set] : limits) {
    for (int n = 0; n < 2 + bench.options.rounds / 2; ++n) {
      const double top = n == 0 ? kLow : kHigh;
      Scene scene = n < 2 ? bench.budgeted(wall_scene(unit, top, bench.flight()))
                          : bench.world(std::uint64_t(n), bench.flight());
      scene.name += std::string(", with a limit: ") + name;
      set(scene.request);
      judge(report, bench.make()->plan(scene.request), scene);
    }
  }
  if (bench.make()->traits().spatial) {
    const Scene ridge = bench.budgeted(ridge_scene(bench.options.unit_m));
    judge(report, bench.make()->plan(ridge.request), ridge);
  }
}

void impossible_ends(const PlannerBench& bench, Report& report) {
  const Flight flight = bench.flight();
  const Scene plain = bench.world(0, flight);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Vec3 inside = [&] {
    const Box box = bounds(plain.solids[0]);
    Vec3 p = (box.min + box.max) / 2;
    p.z() = plain.request.level_m.value_or(p.z());
    return p;
  }();
  const Vec3 outside = plain.request.volume.max + Vec3(1, 1, 0);
  std::vector<Vec3> places{outside, {nan, 0, 0}, {0, 0, kInfinity}, {-1e300, 1e300, 0}};
  if (own_clearance(plain, inside) < 0 && plain.request.volume.contains(inside)) {
    places.push_back(inside);
  }
  for (const Vec3& place : places) {
    for (const bool at_start : {true, false}) {
      Request request = plain.request;
      (at_start ? request.start.position : request.goal.position) = place;
      const PlanResult result = bench.make()->plan(request);
      report.expect(result.status == PlanStatus::invalid_problem && result.route.empty(),
                    kPlannerStatus, [&] {
                      return plain.name + ", " + (at_start ? "start" : "goal") + " at " +
                             text(place) + ": expected invalid_problem, the planner returned " +
                             text(result);
                    });
    }
  }
}

void possible_ends(const PlannerBench& bench, Report& report) {
  const double unit = bench.options.unit_m;
  for (const Flight flight : bench.flights()) {
    Scene same = bench.world(1, flight);
    same.name += ", start = goal";
    same.request.goal.position = same.request.start.position;
    report.expect(judge(report, bench.make()->plan(same.request), same), kPlannerStatus,
                  [&] { return same.name + ": the planner does not solve it"; });
    Scene near = bench.world(1, flight);
    near.name += ", the goal's tolerance covers half of the distance";
    near.request.goal.tolerance_m =
        (near.request.goal.position - near.request.start.position).norm() / 2;
    judge(report, bench.make()->plan(near.request), near);
    // Ends on the boundary of the volume, in a corner of it, and touching a solid.
    Scene edge = bench.budgeted(open_scene(unit, flight));
    edge.name += ", from a corner of the volume to a point of its boundary";
    edge.request.start.position.head<2>() = edge.request.volume.min.head<2>();
    edge.request.goal.position.x() = edge.request.volume.max.x();
    judge(report, bench.make()->plan(edge.request), edge);
    Scene touching = bench.budgeted(open_scene(unit, flight));
    touching.name += " but for a ball that touches the start";
    std::vector<Change> changes;
    const double off = 2 * unit + touching.request.vehicle.radius_m;
    with_solid(touching, Sphere{touching.request.start.position + Vec3(off, 0, 0), 2 * unit},
               "ball", changes);
    judge(report, bench.make()->plan(touching.request), touching);
    // A volume without margin: flat in level flight, else a cell thick.
    Scene thin = bench.budgeted(open_scene(unit, flight));
    thin.name += " without height";
    thin.request.volume.min.z() = thin.request.volume.max.z() = thin.request.goal.position.z() =
        thin.request.start.position.z();
    judge(report, bench.make()->plan(thin.request), thin);
  }
}

void answers_again(const PlannerBench& bench, Report& report) {
  const auto planner = bench.make();
  const Scene a = bench.cells(0, bench.flight());
  const Scene b = bench.world(0, bench.flight());
  const PlanResult first_a = planner->plan(a.request);
  const PlanResult first_b = planner->plan(b.request);
  const auto same = [&](const PlanResult& first, const PlanResult& again, const Scene& scene,
                        const std::string& which) {
    return report.expect(equal(first, again), kPlannerPure, [&] {
      return scene.name + ": " + which + " of the planner differs: first " + text(first) +
             ", then " + text(again);
    });
  };
  for (int call = 2; call <= bench.options.calls; ++call) {
    const std::string which = "answer " + std::to_string(call);
    if (!same(first_a, planner->plan(a.request), a, which) ||
        (call % 10 == 0 && !same(first_b, planner->plan(b.request), b, which))) {
      return;
    }
  }
  const auto fresh = bench.make();
  same(first_a, fresh->plan(a.request), a, "the answer of another object");
  for (int n = 0; n < 3; ++n) {
    PlanResult beside_a;
    PlanResult beside_b;
    in_two_threads([&] { beside_a = planner->plan(a.request); },
                   [&] { beside_b = planner->plan(b.request); });
    same(first_a, beside_a, a, "an answer with a second thread running");
    same(first_b, beside_b, b, "an answer with a second thread running");
  }
  Scene watched = a;
  SearchProgress progress;
  watched.request.budget.progress = &progress;
  same(first_a, planner->plan(watched.request), watched, "the answer with its progress watched");
  report.expect(progress.expanded <= std::uint64_t(counter(first_a.counters, "expanded")),
                kPlannerPure, [&] {
                  return watched.name + ": the progress shows " +
                         std::to_string(progress.expanded) + " expanded, of " + text(first_a);
                });
  Scene many = b;
  many.name += ", with 4 threads";
  many.request.threads = 4;
  same(first_b, planner->plan(many.request), many, "the answer");
}

void inputs_unchanged(const PlannerBench& bench, Report& report) {
  const Scene scene = bench.world(2, bench.flight());
  Request request = scene.request;
  (void)bench.make()->plan(request);
  RandomStream before = scene.request.random;
  RandomStream after = request.random;
  const bool kept = request.world == scene.request.world &&
                    request.world->revision() == scene.request.world->revision() &&
                    request.start.position == scene.request.start.position &&
                    request.goal.position == scene.request.goal.position &&
                    request.limits.min_clearance == scene.request.limits.min_clearance &&
                    request.volume.min == scene.request.volume.min &&
                    request.volume.max == scene.request.volume.max &&
                    request.budget.max_iterations == scene.request.budget.max_iterations &&
                    before() == after();
  report.expect(kept, kPlannerPure,
                [&] { return scene.name + ": the planner modified its request"; });
}
}  // namespace

Cases planner_law_cases(const PlannerBench& bench) {
  return planner_cases_on(bench, {{"routes_are_sound_in_seeded_worlds", seeded_worlds},
                                  {"large_coordinates", large_coordinates},
                                  {"a_million_obstacles", million_obstacles},
                                  {"limits_are_honoured", limits_honoured},
                                  {"impossible_start_or_goal_is_a_status", impossible_ends},
                                  {"possible_starts_and_goals", possible_ends},
                                  {"answers_do_not_depend_on_history_or_threads", answers_again},
                                  {"inputs_stay_as_they_are", inputs_unchanged}});
}

Cases planner_cases(const Factory<Planner>& make, const Options& options) {
  const PlannerBench bench{make, options};
  Cases all = planner_law_cases(bench);
  for (const auto& more :
       {planner_budget_cases(bench), planner_trait_cases(bench), session_cases(bench)}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}
}  // namespace altiplan::conformance
