// SPDX-License-Identifier: Apache-2.0
#include <sstream>

#include "maker.hpp"
#include "objective_bench.hpp"
#include "pilot_bench.hpp"
#include "planner_bench.hpp"
#include "probe.hpp"
#include "task_bench.hpp"

namespace altiplan::conformance {
namespace {

std::string line(const PlanResult& result) {
  return text(result) + " " + text(result.route) + "\n";
}

std::string of_planner(const Factory<Planner>& make, const Options& options) {
  const PlannerBench bench{make, options};
  std::string all;
  const auto planner = make();
  for (const Flight flight : bench.flights()) {
    for (const Scene& scene :
         {bench.budgeted(open_scene(options.unit_m, flight)), bench.world(0, flight),
          bench.world(1, flight), bench.cells(0, flight)}) {
      all += line(planner->plan(scene.request));
    }
    Scene scene = bench.world(0, flight);
    const auto session = planner->begin(scene.request);
    all += line(session->result());
    std::vector<Change> changes;
    const Vec3 middle = (scene.request.start.position + scene.request.goal.position) / 2;
    const auto world = with_solid(scene, Sphere{middle, options.unit_m}, "new", changes);
    all += line(session->update(scene.request.start, scene.request.goal, world, changes,
                                scene.request.budget));
  }
  return all;
}

std::string of_pilot(const Factory<LocalPlanner>& make, const Options& options) {
  const pilots::Bench bench{make, options};
  const double reach = bench.reach();
  const Request open = bench.flight(nullptr, reach);
  const Request request =
      bench.flight(pilots::balls(pilots::drawn(options.seed, open, reach)), reach);
  const auto pilot = make()->begin(request);
  Observation seen = pilots::first_observation(request);
  std::string all;
  for (int step = 0; step < 300; ++step) {
    const PilotStep next = pilot->step(seen);
    all += pilots::text(seen) + "\n";
    if (next.outcome != PilotStep::Outcome::flying) {
      return all + std::string(next.why) + "\n";
    }
    seen.state = next.next;
  }
  return all;
}

std::string of_smoother(const Factory<Smoother>& make, const Options& options) {
  std::string all;
  const auto smoother = make();
  for (std::uint64_t n = 0; n < 4; ++n) {
    Scene scene = random_scene(options.unit_m, options.seed * 1000 + n, Flight::spatial);
    scene.request.budget.max_iterations = options.iterations;
    RandomStream random = RandomStream(options.seed).sub("answers", n);
    scene.request.random = random;
    Polyline route{scene.request.start.position};
    for (int i = 0; i < 8; ++i) {
      route.push_back(random.in(scene.request.volume));
    }
    route.push_back(scene.request.goal.position);
    all += line(smoother->smooth(route, scene.request));
  }
  return all;
}

std::string of_constraint(const Factory<Constraint>& make, const Options& options) {
  std::ostringstream all;
  const auto constraint = make();
  Scene scene = random_scene(100, options.seed, Flight::spatial);
  scene.request.limits.max_leg = 1e4;
  Limits& limits = scene.request.limits;
  constraint->tighten(limits, scene.request);
  for (const double figure :
       {limits.min_clearance, limits.min_ground_clearance.value_or(-1), limits.min_leg,
        limits.max_leg, limits.max_turn_horizontal, limits.max_turn_space, limits.min_turn_radius,
        limits.max_climb, limits.max_descent(), limits.max_route_length}) {
    all << text(figure) << ' ';
  }
  for (const AltitudeBand& band : limits.altitude) {
    all << text(band.min) << " to " << text(band.max) << ' ';
  }
  RandomStream random = RandomStream(options.seed).sub("answers");
  for (int n = 0; n < 50; ++n) {
    Polyline route(5);
    for (Vec3& p : route) {
      p = random.in(scene.request.volume);
    }
    all << constraint->admits({route[0], route[1], route[2], scene.request.world.get()}) << '\n';
    for (const Violation& violation : constraint->violations(route, scene.request)) {
      all << violation.at << ' ' << text(violation.value) << ' ' << text(violation.limit) << ' '
          << violation.message << '\n';
    }
  }
  return all.str();
}

std::string of_environment(const EnvironmentFactory& make, const Setup& setup) {
  const EnvironmentBench bench{make, setup.options, setup.before};
  Probe probe(bench, "answers");
  const Environment& layer = probe.layer();
  std::ostringstream all;
  for (int n = 0; n < 200; ++n) {
    const Probe::AskedLeg leg = probe.leg();
    all << text(layer.clearance(leg.a)) << ' ' << layer.blocked(leg.a, leg.b, leg.r);
    if (const Ground* ground = layer.ground()) {
      all << ' ' << text(ground->height(leg.a.x(), leg.a.y()).value_or(-1e99)) << ' '
          << text(ground->gap(leg.a, leg.b));
    }
    all << '\n';
    layer.near(leg.a, leg.r, [&](const Nearby& nearby) {
      all << nearby.id << ' ' << text(nearby.point) << '\n';
    });
  }
  for (const std::string& note : layer.info().notes) {
    all << note << '\n';
  }
  return all.str();
}

std::string of_tuner(const Factory<Tuner>& make, const Options& options) {
  const auto search =
      make()->begin({{"a", -3, 7, -1}, {"u", 0, 1, 0}, {"v", 0, 1, 0}, {"w", 0, 1, 0}},
                    RandomStream(options.seed).sub("answers"));
  std::string all;
  for (int n = 0; n < 50; ++n) {
    const auto batch = search->ask();
    if (batch.empty()) {
      break;
    }
    std::vector<double> scores;
    for (const std::vector<double>& point : batch) {
      scores.push_back(0);
      for (const double x : point) {
        all += text(x) + " ";
        scores.back() += (x - 0.3) * (x - 0.3);
      }
      all += "\n";
    }
    search->tell(scores);
  }
  return all;
}
}  // namespace

std::string answers_of(const PluginEntry& entry, const Setup& setup) {
  const Options& options = setup.options;
  return with_factory(
      entry, setup.with,
      Overloaded{[&](const EnvironmentFactory& make) { return of_environment(make, setup); },
                 [&](const ConstraintFactory& make) {
                   return of_constraint(on_site(make, options, setup.before), options);
                 },
                 [&](const Factory<Planner>& make) { return of_planner(make, options); },
                 [&](const Factory<LocalPlanner>& make) { return of_pilot(make, options); },
                 [&](const Factory<Smoother>& make) { return of_smoother(make, options); },
                 [&](const Factory<Tuner>& make) { return of_tuner(make, options); },
                 [&](const ObjectiveFactory& make) {
                   const ObjectiveBench bench(make, options, setup.before);
                   return bench.answers(*bench.made());
                 },
                 [&](const TaskFactory& make) {
                   const TaskBench bench(make, options, setup.before);
                   return bench.answers(*bench.made());
                 }});
}
}  // namespace altiplan::conformance
