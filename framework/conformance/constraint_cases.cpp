// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "worlds.hpp"

namespace altiplan::conformance {
namespace {

constexpr const char* kConstraintPure =
    "Constraint contract 1: pure and const, callable from any number of threads";
constexpr const char* kTightens = "Constraint contract 2: tighten only ever makes a limit stricter";
constexpr const char* kLegAlone =
    "Constraint contract 3: admits depends on the leg alone, and a stricter parameter admits less";
constexpr const char* kThrough =
    "Constraint contract 3: a leg through a part that is refused for its place is refused";
constexpr const char* kViolations =
    "Constraint contract 5: violations is empty if and only if the route satisfies the constraint";
constexpr const char* kNothing = "Suite: there must be something to judge";

struct ConstraintBench {
  Factory<Constraint> make;
  Factory<Constraint> tighter;
  Options options;
  std::shared_ptr<const World> before;  ///< world of the site; without layers: one of the suite
};

/// Limits as numbers, of which a smaller one is stricter.
constexpr std::array kLimitNames{"min_clearance",
                                 "min_ground_clearance",
                                 "min_leg",
                                 "min_turn_radius",
                                 "max_leg",
                                 "max_turn_horizontal",
                                 "max_turn_space",
                                 "max_climb",
                                 "max_sink",
                                 "max_route_length",
                                 "lowest above sea",
                                 "highest above sea",
                                 "lowest above ground",
                                 "highest above ground"};
using Figures = std::array<double, kLimitNames.size()>;

Figures figures(const Limits& limits) {
  Figures all{-limits.min_clearance,
              -limits.min_ground_clearance.value_or(-kInfinity),
              -limits.min_leg,
              -limits.min_turn_radius,
              limits.max_leg,
              limits.max_turn_horizontal,
              limits.max_turn_space,
              limits.max_climb,
              limits.max_descent(),
              limits.max_route_length,
              kInfinity,
              kInfinity,
              kInfinity,
              kInfinity};
  for (const AltitudeBand& band : limits.altitude) {
    const std::size_t at = band.datum == AltitudeBand::Datum::sea ? 10 : 12;
    all[at] = std::min(all[at], -band.min);
    all[at + 1] = std::min(all[at + 1], band.max);
  }
  return all;
}

/// The first limit that is not at least as strict in `now`; "" if all are.
std::string loosened(const Limits& before, const Limits& now) {
  const Figures was = figures(before);
  const Figures is = figures(now);
  for (std::size_t i = 0; i < was.size(); ++i) {
    if (!(is[i] <= was[i])) {
      return std::string(kLimitNames[i]) + " went from " + text(std::abs(was[i])) + " to " +
             text(std::abs(is[i]));
    }
  }
  return "";
}

/// From far stricter than any constraint to far looser, and the defaults in between.
Limits random_limits(RandomStream& random) {
  Limits limits;
  const auto some = [&] { return random.uniform() < 0.5; };
  const auto metres = [&] { return std::pow(10, random.uniform(-1, 5)); };
  limits.min_clearance = some() ? metres() : 0;
  if (some()) {
    limits.min_ground_clearance = metres();
  }
  if (some()) {
    const double low = metres() - metres();
    const auto datum = some() ? AltitudeBand::Datum::sea : AltitudeBand::Datum::ground;
    limits.altitude.push_back({datum, low, low + metres()});
  }
  limits.min_leg = some() ? metres() : 0;
  limits.max_leg = some() ? metres() : kInfinity;
  limits.max_turn_horizontal = random.uniform(0, kPi);
  limits.max_turn_space = random.uniform(0, kPi);
  limits.min_turn_radius = some() ? metres() : 0;
  limits.max_climb = random.uniform(0, kPi / 2);
  limits.max_route_length = some() ? metres() : kInfinity;
  return limits;
}

/// At the scale of typical constraints, hundreds of metres: over ground, among solids; or in the
/// world of the constraint's site, whose ground it may know.
Scene scene_of(const ConstraintBench& bench, std::uint64_t n) {
  Scene scene = random_scene(100, bench.options.seed * 100 + n, Flight::spatial);
  scene.ridge = std::make_shared<Ridge>(1000, 120, 0.2);
  scene.request.world = bench.before != nullptr && !bench.before->layers().empty()
                            ? bench.before
                            : std::make_shared<const World>(scene.request.world->with(
                                  {"ridge", "conformance", scene.ridge, true}));
  return scene;
}

Vec3 direction(RandomStream& random) {
  return Vec3(random.normal(), random.normal(), 0.3 * random.normal());
}

/// Begins in a volume that the user names, by default around the origin.
Motion random_leg(RandomStream& random, const Options& options, const Scene& scene) {
  static const Box kAround{{-3000, -3000, 0}, {3000, 3000, 3000}};
  Motion leg;
  leg.world = scene.request.world.get();
  const double scale = std::pow(10, random.uniform(-1, 4));
  leg.from = random.in(options.volume.value_or(kAround));
  leg.to = leg.from + scale * direction(random);
  if (random.uniform() < 0.6) {
    leg.before = leg.from + scale * direction(random);
  }
  if (random.uniform() < 0.05) {
    leg.to = leg.from;
  }
  return leg;
}

Polyline random_route(RandomStream& random, const Scene& scene) {
  Polyline route{scene.request.start.position};
  const auto count = random.integer(0, 8);
  for (std::int64_t i = 0; i < count; ++i) {
    route.push_back(random.uniform() < 0.1 ? route.back() : random.in(scene.request.volume));
  }
  route.push_back(scene.request.goal.position);
  return route;
}

std::string motion_text(const Motion& leg) {
  return "the leg " + text(leg.from) + " to " + text(leg.to) +
         (leg.before ? " after " + text(*leg.before) : "");
}

/// All answers of a constraint to a fixed set of queries.
struct ConstraintAnswers {
  std::vector<Figures> limits;
  std::vector<bool> admitted;
  std::vector<std::vector<Violation>> violations;
};

ConstraintAnswers ask(const Constraint& constraint, const ConstraintBench& bench,
                      bool backward = false) {
  ConstraintAnswers answers;
  for (int n = 0; n < bench.options.rounds; ++n) {
    const Scene scene = scene_of(bench, std::uint64_t(n));
    RandomStream random = RandomStream(bench.options.seed).sub("ask", std::uint64_t(n));
    Limits limits = random_limits(random);
    constraint.tighten(limits, scene.request);
    answers.limits.push_back(figures(limits));
    std::vector<Motion> legs(50);
    std::generate(legs.begin(), legs.end(),
                  [&] { return random_leg(random, bench.options, scene); });
    std::vector<bool> admitted(legs.size());
    for (std::size_t i = 0; i < legs.size(); ++i) {
      const std::size_t at = backward ? legs.size() - 1 - i : i;
      admitted[at] = constraint.admits(legs[at]);
    }
    answers.admitted.insert(answers.admitted.end(), admitted.begin(), admitted.end());
    for (int k = 0; k < 10; ++k) {
      answers.violations.push_back(
          constraint.violations(random_route(random, scene), scene.request));
    }
  }
  return answers;
}

void pure(const ConstraintBench& bench, Report& report) {
  const auto constraint = bench.make();
  const ConstraintAnswers first = ask(*constraint, bench);
  const auto same = [&](const ConstraintAnswers& again, const char* which) {
    report.expect(first.limits == again.limits && first.violations == again.violations,
                  kConstraintPure, [&] {
                    return std::string("the constraint's answers differ ") + which + ", seed " +
                           std::to_string(bench.options.seed);
                  });
    report.expect(first.admitted == again.admitted, kLegAlone, [&] {
      return std::string("what the constraint admits differs ") + which + ", seed " +
             std::to_string(bench.options.seed);
    });
  };
  same(ask(*constraint, bench), "at the second call");
  same(ask(*constraint, bench, true), "with the legs in reverse order");
  same(ask(*bench.make(), bench), "between two objects");
  ConstraintAnswers one;
  ConstraintAnswers other;
  in_two_threads([&] { one = ask(*constraint, bench); }, [&] { other = ask(*constraint, bench); });
  same(one, "with a second thread running");
  same(other, "with a second thread running");
}

void tightens(const ConstraintBench& bench, Report& report) {
  const auto constraint = bench.make();
  for (int n = 0; n < 50 * bench.options.rounds; ++n) {
    const Scene scene = scene_of(bench, std::uint64_t(n % 5));
    RandomStream random = RandomStream(bench.options.seed).sub("limits", std::uint64_t(n));
    const Limits before = random_limits(random);
    Limits once = before;
    constraint->tighten(once, scene.request);
    const std::string limits =
        "limits " + std::to_string(n) + " of seed " + std::to_string(bench.options.seed) + ": ";
    report.expect(loosened(before, once).empty(), kTightens,
                  [&] { return limits + "the constraint loosens one: " + loosened(before, once); });
    Limits twice = once;
    constraint->tighten(twice, scene.request);
    report.expect(figures(twice) == figures(once), kTightens, [&] {
      return limits + "tightening again changes them once more: " + loosened(twice, once);
    });
    if (bench.tighter) {
      Limits strict = before;
      bench.tighter()->tighten(strict, scene.request);
      report.expect(loosened(once, strict).empty(), kTightens, [&] {
        return limits + "with the stricter parameter a limit is looser: " + loosened(once, strict);
      });
    }
  }
}

void legs_and_routes(const ConstraintBench& bench, Report& report) {
  const auto constraint = bench.make();
  const auto stricter = bench.tighter ? bench.tighter() : nullptr;
  bool says_anything = false;
  for (int n = 0; n < 20 * bench.options.rounds; ++n) {
    RandomStream random = RandomStream(bench.options.seed).sub("legs", std::uint64_t(n));
    const Scene scene = scene_of(bench, std::uint64_t(n % 5));
    for (int k = 0; k < 20; ++k) {
      const Motion leg = random_leg(random, bench.options, scene);
      const bool admitted = constraint->admits(leg);
      says_anything |= !admitted;
      if (stricter != nullptr) {
        report.expect(admitted || !stricter->admits(leg), kLegAlone, [&] {
          return motion_text(leg) + " is refused, and admitted with the stricter parameter";
        });
      }
    }
    const Polyline route = random_route(random, scene);
    const auto found = constraint->violations(route, scene.request);
    says_anything |= !found.empty();
    for (const Violation& violation : found) {
      report.expect(violation.at < route.size(), kViolations, [&] {
        return "a violation at waypoint " + std::to_string(violation.at) + " of " + text(route);
      });
      report.expect(std::isfinite(violation.limit) && !std::isnan(violation.value) &&
                        (violation.value != violation.limit || violation.value == 0),
                    kViolations, [&] {
                      return "a violation whose value, " + text(violation.value) +
                             ", does not exceed its limit, " + text(violation.limit) + ", of " +
                             text(route);
                    });
      report.expect(!violation.message.empty(), kViolations,
                    [&] { return "a violation without a message, of " + text(route); });
    }
    if (stricter != nullptr) {
      report.expect(
          found.empty() || !stricter->violations(route, scene.request).empty(), kViolations, [&] {
            return text(route) +
                   " violates the constraint, but satisfies it with the stricter parameter";
          });
    }
    Limits limits;
    constraint->tighten(limits, scene.request);
    says_anything |= figures(limits) != figures(Limits{});
  }
  report.expect(says_anything, kNothing, [] {
    return "the constraint tightened nothing, refused no leg and found no violation: give the "
           "parameter set a `volume` in which it does";
  });
}

/// True if the same leg is admitted somewhere else.
bool depends_on_place(const Constraint& constraint, const Motion& leg, RandomStream& random) {
  for (int n = 0; n < 20; ++n) {
    const Vec3 by = 3000 * direction(random);
    if (constraint.admits({std::nullopt, leg.from + by, leg.to + by, leg.world})) {
      return true;
    }
  }
  return false;
}

/// Puts both ends at heights above the ground, if there is any: low over hills places differ.
void over_ground(Motion& leg, RandomStream& random) {
  for (Vec3* end : {&leg.from, &leg.to}) {
    if (const std::optional<double> ground = leg.world->ground(end->x(), end->y())) {
      end->z() = *ground + std::pow(10, random.uniform(0, 3));
    }
  }
}

/// Legs through refused ones: a constraint that looks at a leg's ends alone admits them. The
/// refused part is drawn first and lengthened, or cut out of a leg whose ends are admitted: beyond
/// the world or the range of a constraint nothing may be.
void legs_through_refused_ones(const ConstraintBench& bench, Report& report) {
  const auto constraint = bench.make();
  const Scene scene = scene_of(bench, 0);
  const auto through = [&](const Motion& part, const Motion& whole, RandomStream& random) {
    report.expect(!constraint->admits(whole) || !depends_on_place(*constraint, part, random),
                  kThrough, [&] {
                    return motion_text(whole) + " is admitted, and its part, " + motion_text(part) +
                           ", refused";
                  });
  };
  for (int n = 0; n < 1000 + 50 * bench.options.rounds; ++n) {
    RandomStream random = RandomStream(bench.options.seed).sub("through", std::uint64_t(n));
    Motion leg = random_leg(random, bench.options, scene);
    leg.before.reset();
    if (n % 2 == 1) {
      over_ground(leg, random);
    }
    const Vec3 along = leg.to - leg.from;
    if (along.isZero()) {
      continue;
    }
    if (!constraint->admits(leg)) {
      for (const double longer : {1.0, 10.0, 100.0}) {
        through(leg, {std::nullopt, leg.from - longer * along, leg.to + longer * along, leg.world},
                random);
      }
      continue;
    }
    for (int k = 0; k < 4; ++k) {
      const double from = random.uniform();
      const double to = from + (1 - from) * std::pow(10, random.uniform(-3, 0));
      const Motion part{std::nullopt, leg.from + from * along, leg.from + to * along, leg.world};
      if (!constraint->admits(part)) {
        through(part, leg, random);
      }
    }
  }
}

/// The judge's result with the constraint agrees with the constraint's own: a route within the
/// limits, whose legs are admitted, is violated exactly where violations reports it.
void agrees_with_the_judge(const ConstraintBench& bench, Report& report) {
  const std::shared_ptr<const Constraint> constraint = bench.make();
  for (int n = 0; n < 20 * bench.options.rounds; ++n) {
    Scene scene = scene_of(bench, std::uint64_t(n % 5));
    RandomStream random = RandomStream(bench.options.seed).sub("judge", std::uint64_t(n));
    const Polyline route = random_route(random, scene);
    Request& request = scene.request;
    request.world = std::make_shared<const World>();  // only the constraint reports
    request.vehicle.radius_m = 0;
    request.limits = Limits{};
    if (!check(route, request).ok()) {
      continue;
    }
    const bool tracks_only = constraint->applies_to() == AppliesTo::track;
    apply_constraints(request, {{"rule", constraint}},
                      tracks_only ? AppliesTo::track : AppliesTo::route);
    bool admitted = true;
    for (std::size_t i = 0; i + 1 < route.size(); ++i) {
      const auto before = i > 0 ? std::optional(route[i - 1]) : std::nullopt;
      admitted =
          admitted && constraint->admits({before, route[i], route[i + 1], request.world.get()});
    }
    Request limits_alone = request;
    limits_alone.constraints.clear();
    const bool kept = check(route, limits_alone).ok() && admitted;
    const bool path_kept = constraint->violations(route, request).empty();
    report.expect(check(route, request).ok() == (kept && path_kept), kViolations,
                  [&] { return text(route) + ": the judge and the constraint disagree"; });
  }
}

void odd_questions(const ConstraintBench& bench, Report&) {
  const auto constraint = bench.make();
  const Scene scene = scene_of(bench, 0);
  const Vec3 p = scene.request.start.position;
  for (const Polyline& route :
       {Polyline{}, Polyline{p}, Polyline{p, p}, Polyline{p, p, p},
        Polyline{p, p + Vec3(0, 0, 1e6)}, Polyline{p, p + Vec3(1e-9, 0, 0)}}) {
    (void)constraint->violations(route, scene.request);
    for (std::size_t i = 0; i + 1 < route.size(); ++i) {
      for (const World* world : {scene.request.world.get(), static_cast<const World*>(nullptr)}) {
        (void)constraint->admits({std::nullopt, route[i], route[i + 1], world});
        (void)constraint->admits({route[i], route[i], route[i + 1], world});
      }
    }
  }
  Request bare;
  bare.world = std::make_shared<const World>();
  Limits limits;
  constraint->tighten(limits, bare);
}
}  // namespace

Cases constraint_cases(const ConstraintFactory& make, const ConstraintFactory& tighter,
                       const Options& options, const std::shared_ptr<const World>& before) {
  const ConstraintBench bench{on_site(make, options, before), on_site(tighter, options, before),
                              options, before};
  return cases_on(bench, kConstraintPure,
                  {{"answers_do_not_depend_on_history_or_threads", pure},
                   {"tighten_never_loosens", tightens},
                   {"legs_and_routes", legs_and_routes},
                   {"legs_through_refused_ones", legs_through_refused_ones},
                   {"agrees_with_the_judge", agrees_with_the_judge},
                   {"odd_questions", odd_questions}});
}
}  // namespace altiplan::conformance
