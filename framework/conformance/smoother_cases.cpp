// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "worlds.hpp"

namespace altiplan::conformance {
namespace {

constexpr const char* kEnds = "Smoother contract 1: first and last points stay";
constexpr const char* kExcess =
    "Smoother contract 2: for every constraint the worst excess does not grow; a valid route stays "
    "valid";
constexpr const char* kShort =
    "Smoother contract 3: routes of one or two points are returned unchanged";
constexpr const char* kSmootherPure =
    "Smoother: const and shareable; equal requests give equal routes, on any threads, in any order";
constexpr const char* kStatus = "Smoother: a failure is a status, never an exception";

struct SmootherBench {
  Factory<Smoother> make;
  Options options;

  Scene world(int n) const {
    Scene scene =
        random_scene(options.unit_m, options.seed * 1000 + std::uint64_t(n), Flight::spatial);
    scene.request.budget.max_iterations = options.iterations;
    scene.request.random = RandomStream(options.seed).sub("smooth");
    return scene;
  }
};

/// Worst excess over each constraint; constraints without figures count as 1.
std::map<std::string, double> excesses(const Route& route, const Scene& scene) {
  std::map<std::string, double> worst;
  for (const Violation& violation : check(route, scene.request).violations) {
    const bool too_small = violation.value < violation.limit;
    const double by =
        violation.value == violation.limit ? 1 : std::abs(violation.value - violation.limit);
    double& max_excess =
        worst[violation.constraint + (too_small ? " below " : " above ") + text(violation.limit)];
    max_excess = std::max(max_excess, by);
  }
  return worst;
}

/// The scene with the ends of the route.
Scene ending_as(Scene scene, const Route& route) {
  scene.request.start.position = route.front();
  scene.request.goal.position = route.back();
  return scene;
}

/// Smooths and checks the result against contracts 1 and 2; returns the route, or the input if
/// there is none.
Route judged(Report& report, const Smoother& smoother, const Route& route, const Scene& scene) {
  const Route given = route;
  const auto input = [&] { return scene.name + ", smoothing " + text(route); };
  PlanResult result;
  try {
    result = smoother.smooth(given, scene.request);
    report.expect(given == route, kStatus,
                  [&] { return input() + ": the smoother changed its input"; });
  } catch (const PluginError& error) {  // Smoother::smooth has already checked the ends
    report.add(error.reason() == Reason::contract_of_ends ? kEnds : kStatus,
               input() + ": the smoother failed: " + error.what());
  }
  if (result.status != PlanStatus::solved) {
    return route;
  }
  if (!report.expect(!result.route.empty() && result.route.front() == route.front() &&
                         result.route.back() == route.back(),
                     kEnds,
                     [&] { return input() + ": the smoother's route is " + text(result.route); })) {
    return route;
  }
  // The tolerance of a clearance, which the judge finds by bisection, is the widest of all.
  constexpr double kWidest = 1e-5;
  const std::map<std::string, double> was = excesses(route, scene);
  for (const auto& [rule, excess] : excesses(result.route, scene)) {
    const auto old = was.find(rule);
    const double allowed = old == was.end() ? 0 : old->second;
    report.expect(excess <= allowed + kWidest, kExcess, [&, rule = rule, excess = excess] {
      return input() + ": the worst excess of '" + rule + "' was " + text(allowed) + " and is " +
             text(excess) + " in " + text(result.route);
    });
  }
  if (unsound(route, scene).empty()) {
    report.expect(unsound(result.route, scene).empty(), kExcess, [&] {
      return input() + ": the input was valid, the smoothed route " + unsound(result.route, scene) +
             ": " + text(result.route);
    });
  }
  return result.route;
}

/// A walk through the world whose legs all satisfy the request's constraints.
Polyline sound_walk(const Scene& scene, RandomStream random) {
  Polyline route{scene.request.start.position};
  std::optional<Approach> before = scene.request.before_start();
  for (int tries = 0; tries < 4000 && route.size() < 12; ++tries) {
    const Vec3 reach = scene.unit * random.uniform(0.5, 6) *
                       Vec3(random.normal(), random.normal(), 0.3 * random.normal());
    const Vec3 next = route.back() + reach;
    if (leg_ok(before, route.back(), next, scene.request)) {
      before = onward(before, route.back());
      route.push_back(next);
    }
  }
  return route;
}

Polyline any_walk(const Scene& scene, RandomStream random) {
  Polyline route{scene.request.start.position};
  for (int i = 0; i < 8; ++i) {
    route.push_back(random.in(scene.request.volume));
  }
  route.push_back(scene.request.goal.position);
  return route;
}

/// The constraints under which routes are smoothed: none, each, and all together.
std::vector<std::pair<const char*, std::function<void(Request&)>>> rules(double unit) {
  std::vector<std::pair<const char*, std::function<void(Request&)>>> all{
      {"no limit", [](Request&) {}},
      {"climb", [](Request& r) { r.limits.max_climb = radians(20); }},
      {"turn", [](Request& r) { r.limits.max_turn_horizontal = radians(80); }},
      {"turn in space", [](Request& r) { r.limits.max_turn_space = radians(100); }},
      {"turn radius", [unit](Request& r) { r.limits.min_turn_radius = unit; }},
      {"clearance", [unit](Request& r) { r.limits.min_clearance = unit / 2; }},
      {"leg length",
       [unit](Request& r) { r.limits.min_leg = unit / 2, r.limits.max_leg = 9 * unit; }},
      {"altitude",
       [unit](Request& r) {
         r.limits.altitude.push_back({AltitudeBand::Datum::sea, unit, 4 * unit});
       }},
      {"the body of a flat wing", [unit](Request& r) {
         r.vehicle.body = flat_wing(unit);
         r.vehicle.radius_m = r.vehicle.body->inner_m();
         r.limits.min_clearance = std::max(r.limits.min_clearance, r.vehicle.radius_m);
       }}};
  all.emplace_back("all of them", [some = all](Request& request) {
    for (const auto& [name, set] : some) {
      set(request);
    }
    Limits& limits = request.limits;
    limits.max_turn_horizontal = limits.max_turn_space = radians(120);
    limits.max_climb = radians(40);
  });
  return all;
}

void laws_under_every_limit(const SmootherBench& bench, Report& report) {
  const auto smoother = bench.make();
  for (const auto& [name, set] : rules(bench.options.unit_m)) {
    for (int n = 0; n < bench.options.rounds; ++n) {
      Scene scene = bench.world(n);
      scene.name += std::string(", limits: ") + name;
      set(scene.request);
      const RandomStream random = RandomStream(bench.options.seed).sub(name, std::uint64_t(n));
      for (const Polyline& route : {sound_walk(scene, random), any_walk(scene, random)}) {
        if (route.size() < 3) {
          continue;
        }
        const Scene ends = ending_as(scene, route);
        const Route once = judged(report, *smoother, route, ends);
        judged(report, *smoother, once, ends);
      }
    }
  }
}

void over_ground_and_with_a_heading(const SmootherBench& bench, Report& report) {
  const auto smoother = bench.make();
  Scene ridge = ridge_scene(bench.options.unit_m);
  for (int n = 0; n < 4 * bench.options.rounds; ++n) {
    const RandomStream random = RandomStream(bench.options.seed).sub("ridge", std::uint64_t(n));
    if (n % 2 == 1) {
      ridge.request.start.velocity = {1, 1, 0};
      ridge.request.limits.max_turn_horizontal = radians(75);
    }
    const Polyline walk = sound_walk(ridge, random);
    if (walk.size() > 2) {
      judged(report, *smoother, walk, ending_as(ridge, walk));
    }
    judged(report, *smoother, any_walk(ridge, random), ridge);
  }
}

void short_routes(const SmootherBench& bench, Report& report) {
  const auto smoother = bench.make();
  const Scene scene = bench.world(0);
  const Vec3 start = scene.request.start.position;
  for (const Polyline& route :
       {Polyline{start}, Polyline{start, scene.request.goal.position}, Polyline{start, start}}) {
    const PlanResult result = smoother->smooth(route, ending_as(scene, route).request);
    report.expect(result.status == PlanStatus::solved && result.route == route, kShort, [&] {
      return text(route) + " came back as " + text(result.route) + ", " + text(result);
    });
  }
}

void odd_routes(const SmootherBench& bench, Report& report) {
  const auto smoother = bench.make();
  for (int n = 0; n < bench.options.rounds; ++n) {
    const Scene scene = bench.world(n);
    const RandomStream random = RandomStream(bench.options.seed).sub("odd", std::uint64_t(n));
    const Polyline walk = sound_walk(scene, random);
    Polyline repeated;
    for (const Vec3& p : walk) {
      repeated.insert(repeated.end(), repeated.size() % 3 + 1, p);
    }
    Polyline collinear{walk.front()};
    for (std::size_t i = 0; i + 1 < walk.size(); ++i) {
      for (int k = 1; k <= 4; ++k) {
        collinear.push_back(k == 4 ? walk[i + 1] : Vec3(walk[i] + (walk[i + 1] - walk[i]) * k / 4));
      }
    }
    Polyline there_and_back = walk;
    there_and_back.insert(there_and_back.end(), walk.rbegin() + 1, walk.rend());
    const Polyline still(5, walk.front());
    for (const Polyline& route : {repeated, collinear, there_and_back, still}) {
      judged(report, *smoother, route, ending_as(scene, route));
    }
    Scene far = moved_scene(scene, {500'000, 4'649'776, 3000});
    judged(report, *smoother, any_walk(far, random), far);
    const Polyline far_walk = sound_walk(far, random);
    judged(report, *smoother, far_walk, ending_as(far, far_walk));
  }
}

void budgets(const SmootherBench& bench, Report& report) {
  const auto smoother = bench.make();
  Scene scene = bench.world(1);
  const Polyline walk = sound_walk(scene, RandomStream(bench.options.seed).sub("budget"));
  scene = ending_as(scene, walk);
  for (const std::uint64_t max_iterations : {0, 1, 10}) {
    scene.request.budget.max_iterations = max_iterations;
    scene.name = "a budget of " + std::to_string(max_iterations) + " iterations";
    judged(report, *smoother, walk, scene);
  }
  std::stop_source source;
  source.request_stop();
  scene.request.budget.stop = source.get_token();
  scene.name = "stopped before it begins";
  judged(report, *smoother, walk, scene);
}

void answers_again(const SmootherBench& bench, Report& report) {
  const auto smoother = bench.make();
  const Scene scene = bench.world(2);
  const Route a = sound_walk(scene, RandomStream(bench.options.seed).sub("again"));
  const Route b = any_walk(scene, RandomStream(bench.options.seed).sub("again"));
  const Request to_a = ending_as(scene, a.waypoints()).request;
  const PlanResult first_a = smoother->smooth(a, to_a);
  const PlanResult first_b = smoother->smooth(b, scene.request);
  const auto same = [&](const PlanResult& first, const PlanResult& again, const char* which) {
    report.expect(equal(first, again), kSmootherPure, [&] {
      return scene.name + ", " + which + ": first " + text(first) + ", then " + text(again);
    });
  };
  for (int call = 0; call < bench.options.calls; ++call) {
    same(first_a, smoother->smooth(a, to_a), "called again");
  }
  same(first_b, smoother->smooth(b, scene.request), "called after others");
  same(first_b, bench.make()->smooth(b, scene.request), "by another object");
  PlanResult beside_a;
  PlanResult beside_b;
  in_two_threads([&] { beside_a = smoother->smooth(a, to_a); },
                 [&] { beside_b = smoother->smooth(b, scene.request); });
  same(first_a, beside_a, "with a second thread running");
  same(first_b, beside_b, "with a second thread running");
  Request threads = to_a;
  threads.threads = 4;
  same(first_a, smoother->smooth(a, threads), "with 4 threads");
}
}  // namespace

Cases smoother_cases(const Factory<Smoother>& make, const Options& options) {
  const SmootherBench bench{make, options};
  return cases_on(bench, kStatus,
                  {{"nothing_gets_worse_under_any_limit", laws_under_every_limit},
                   {"over_ground_and_with_a_heading", over_ground_and_with_a_heading},
                   {"short_routes_come_back", short_routes},
                   {"odd_routes", odd_routes},
                   {"budgets_and_stops", budgets},
                   {"answers_do_not_depend_on_history_or_threads", answers_again}});
}
}  // namespace altiplan::conformance
