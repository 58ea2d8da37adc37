// SPDX-License-Identifier: Apache-2.0
// The search for ways out, and the cause of collisions: cases whose answer is known, and
// invariants.
#include <gtest/gtest.h>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "reference/escape_cause.hpp"
#include "support/support.hpp"

namespace altiplan::reference::escape_search_test {
namespace {

constexpr double kSpeed = 30;
constexpr double kRadius = 2;

/// At 30 m/s from the origin's height above it, 5 km to the goal in the east.
Request problem(bool level) {
  Request request = testing::request_in(World(), {0, 0, 1000}, {5000, 0, 1000},
                                        {{-4000, -4000, 0}, {9000, 4000, 2000}});
  request.vehicle.radius_m = kRadius;
  request.vehicle.speed_mps = kSpeed;
  request.vehicle.sensing_m = 1000;
  request.limits.max_climb = radians(30);
  if (level) {
    request.level_m = 1000;
  }
  return request;
}

KnownScene scene_with(std::vector<Mover> movers, bool level = true) {
  KnownScene scene(World(), problem(level));
  scene.movers = std::move(movers);
  return scene;
}

/// Around the start, closing on it; `gap` of them left out.
std::vector<Mover> ring(int count, double distance, double radius, double speed, int gap = 0) {
  std::vector<Mover> movers;
  for (int i = gap; i < count; ++i) {
    const double angle = 2 * kPi * i / count;
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    movers.push_back({Vec3(0, 0, 1000) + out * distance, -out * speed, radius});
  }
  return movers;
}

/// Nothing comes to the end of the way any more, unless that is the goal.
void expect_safe_end(const Way& way, const KnownScene& scene) {
  const auto& [time, at] = way.legs.back();
  for (const Mover& mover : scene.movers) {
    const MovingObstacle obstacle{"m", Sphere{mover.at_0, mover.radius}, mover.velocity, 0, true};
    EXPECT_TRUE(at == problem(true).goal.position ||
                !hits(obstacle, at, time, at, time + 10'000, scene.radius));
  }
}

/// Under the framework's own functions, and at no more than the vehicle's speeds.
void expect_flyable(const Way& way, const KnownScene& scene) {
  ASSERT_GE(way.legs.size(), 2U);
  for (std::size_t i = 0; i + 1 < way.legs.size(); ++i) {
    const auto& [t0, a] = way.legs[i];
    const auto& [t1, b] = way.legs[i + 1];
    EXPECT_LE((b - a).norm(), scene.speed * (t1 - t0) * (1 + 1e-9));
    EXPECT_LE(std::abs(b.z() - a.z()), scene.climb_speed * (t1 - t0) * (1 + 1e-9) + 1e-9);
    EXPECT_FALSE(scene.world.blocked(a, b, scene.radius));
    for (const Mover& mover : scene.movers) {
      const MovingObstacle obstacle{"m", Sphere{mover.at_0, mover.radius}, mover.velocity, 0, true};
      EXPECT_FALSE(hits(obstacle, a, t0, b, t1, scene.radius));
    }
  }
}

Way escape(const KnownScene& scene, const Lattice& lattice = {}, double until_s = 60) {
  const EscapeSearch search(scene, problem(true).goal, lattice);
  Way way = search.escape(0, {0, 0, 1000}, until_s);
  if (way.found()) {
    expect_flyable(way, scene);
    expect_safe_end(way, scene);
  }
  return way;
}

TEST(EscapeSearch, FindsTheWayPastWhatComesHeadOn) {
  const Mover ahead{{800, 0, 1000}, {-kSpeed, 0, 0}, 200};
  EXPECT_TRUE(escape(scene_with({ahead})).found());
  EXPECT_TRUE(escape(scene_with({ahead}, false)).found());
}

TEST(EscapeSearch, FindsTheWayFromWhatComesFromTheSideAtTheSameSpeed) {
  EXPECT_TRUE(escape(scene_with({{{0, 300, 1000}, {0, -kSpeed, 0}, 250}})).found());
}

/// Seen from a disc of radius R that comes at w > v, the vehicle flies within asin(v / w) of
/// straight ahead: it passes where its distance is at least R w / v.
TEST(EscapeSearch, IsExactAgainstWhatIsFaster) {
  for (const double times : {1.2, 3.0}) {
    for (const double radius : {50.0, 150.0}) {
      const double limit = (radius + kRadius) * times;
      for (const bool level : {true, false}) {
        const auto from = [&](double distance) {
          return scene_with({{{distance, 0, 1000}, {-kSpeed * times, 0, 0}, radius}}, level);
        };
        EXPECT_TRUE(escape(from(limit * (level ? 1.0005 : 1.01))).found())
            << times << ' ' << radius;
        EXPECT_EQ(escape(from(limit * 0.9999)).outcome, Way::Outcome::none) << times;
      }
    }
  }
}

TEST(EscapeSearch, FindsNoWayOutOfAClosedRing) {
  const auto closed = ring(12, 500, 140, kSpeed / 2);
  EXPECT_EQ(escape(scene_with(closed)).outcome, Way::Outcome::none);
  EXPECT_TRUE(escape(scene_with(closed, false)).found()) << "over it";
  EXPECT_TRUE(escape(scene_with(ring(12, 500, 140, kSpeed / 2, 1))).found()) << "by the gap";
}

/// The ring is open still, and closes before its gaps are reached; or just after.
TEST(EscapeSearch, KnowsWhenARingCloses) {
  // 12 of radius 100 touch at a distance of 386 m from the middle.
  EXPECT_EQ(escape(scene_with(ring(12, 600, 100, kSpeed))).outcome, Way::Outcome::none);
  EXPECT_TRUE(escape(scene_with(ring(12, 600, 100, kSpeed / 5))).found());
}

/// 60 s later the wall is still far from the edge to which it pushes: to be alive then is no
/// escape.
TEST(EscapeSearch, DoesNotFleeBeforeAWallToTheEdgeOfTheVolume) {
  std::vector<Mover> wall;
  for (int i = -3; i <= 3; ++i) {
    wall.push_back({{500, 180.0 * i, 1000}, {-kSpeed / 6, 0, 0}, 100});
  }
  const auto outcome = [&](bool level) {
    KnownScene scene = scene_with(wall, level);
    scene.volume = {{-300, -600, 0}, {5000, 600, 2000}};
    return escape(scene, {4, 2, 24}).outcome;
  };
  EXPECT_EQ(outcome(true), Way::Outcome::none);
  EXPECT_EQ(outcome(false), Way::Outcome::found) << "over it";
  EXPECT_TRUE(escape(scene_with(wall)).found()) << "around it";
  wall.erase(wall.begin() + 2);
  EXPECT_EQ(outcome(true), Way::Outcome::found) << "by the gap";
}

/// Of what flies along as fast, the vehicle is clear aside of its way and not before it.
TEST(EscapeSearch, IsClearWhereNothingComesAnyMore) {
  const KnownScene scene = scene_with({{{-300, 0, 1000}, {kSpeed, 0, 0}, 98}});
  const auto clear_after = [&](const Vec3& velocity) {
    return scene.clear_after({0, 0, 1000}, 0, velocity);
  };
  EXPECT_EQ(clear_after({kSpeed, 0, 0}), kInfinity);
  EXPECT_NEAR(clear_after({0, kSpeed, 0}), (98 + kRadius) / kSpeed, 1e-9);
  EXPECT_NEAR(clear_after({0, 0, 0}), 300 / kSpeed, 1e-9) << "it has flown by";
  EXPECT_EQ(scene.clear_after({-300, 101, 1000}, 0, {kSpeed, 0, 0}), 0);
  EXPECT_EQ(scene.clear_after({-500, 0, 1000}, 0, {0, 0, 0}), 0) << "behind it";
}

/// A lane between two walls, open to the east: what fills it comes in there.
KnownScene dead_end(double plug_radius) {
  World world = testing::world_of({Shape{BoxShape{{{-100, -130, 0}, {2000, -50, 2000}}}},
                                   Shape{BoxShape{{{-100, 50, 0}, {2000, 130, 2000}}}},
                                   Shape{BoxShape{{{-180, -130, 0}, {-100, 130, 2000}}}}});
  KnownScene scene(std::move(world), problem(true));
  scene.movers = {{{800, 0, 1000}, {-kSpeed / 2, 0, 0}, plug_radius}};
  return scene;
}

TEST(EscapeSearch, SeesWhatStandsStill) {
  EXPECT_EQ(escape(dead_end(49)).outcome, Way::Outcome::none);
  KnownScene empty = dead_end(49);
  empty.movers.clear();
  EXPECT_TRUE(escape(empty).found()) << "it may wait";
  // By the side of what is half as wide as the lane.
  KnownScene narrow = dead_end(20);
  narrow.movers[0].at_0.y() = 25;
  EXPECT_TRUE(escape(narrow, Lattice{1, 6}).found());
}

TEST(EscapeSearch, KeepsToTheVolumeTheLevelAndTheClimb) {
  KnownScene scene = scene_with({{{400, 0, 1000}, {-kSpeed, 0, 0}, 300}}, false);
  const Way way = escape(scene);
  ASSERT_TRUE(way.found());
  scene.volume = {{-50, -50, 0}, {400, 50, 2000}};
  scene.climb_speed = 1;
  EXPECT_EQ(escape(scene).outcome, Way::Outcome::none);
}

TEST(EscapeSearch, SaysWhenItGivesUp) {
  Lattice small;
  small.max_places = 10;
  EXPECT_EQ(escape(scene_with(ring(12, 500, 140, kSpeed / 2)), small).outcome,
            Way::Outcome::undecided);
}

TEST(EscapeSearch, ReachesTheGoalThroughTheGapOfAWall) {
  std::vector<Mover> wall;
  for (int i = -8; i <= 8; ++i) {
    wall.push_back({{2000, 160.0 * i, 1000}, {-10, 0, 0}, 100});
  }
  const auto to_goal = [&] {
    KnownScene scene = scene_with(wall);
    scene.volume = {{-500, -1000, 0}, {5500, 1000, 2000}};
    const EscapeSearch search(scene, problem(true).goal, Lattice{4, 2});
    const Way way = search.to_goal(0, {0, 0, 1000}, 220);
    if (way.found()) {
      expect_flyable(way, scene);
      EXPECT_EQ(way.legs.back().second, problem(true).goal.position);
    }
    return way.outcome;
  };
  EXPECT_EQ(to_goal(), Way::Outcome::none);
  wall.erase(wall.begin() + 12);
  EXPECT_EQ(to_goal(), Way::Outcome::found);
}

/// Rings with a gap or none, in disorder: about half can be left.
KnownScene disordered(std::uint64_t seed) {
  RandomStream random = RandomStream(seed).sub("ring");
  // One statement a draw: compilers differ in the order in which they evaluate arguments.
  const int count = int(random.integer(7, 10));
  const double distance = random.uniform(250, 400);
  const double radius = random.uniform(80, 130);
  const double speed = kSpeed * random.uniform(0.3, 1);
  std::vector<Mover> movers = ring(count, distance, radius, speed, int(random.integer(0, 1)));
  for (Mover& mover : movers) {
    mover.at_0 += Vec3{random.uniform(-60, 60), random.uniform(-60, 60), 0};
    mover.velocity *= random.uniform(0.5, 1.2);
  }
  return scene_with(movers);
}

TEST(EscapeSearch, AFinerLatticeFindsNoLess) {
  int none = 0;
  int found = 0;
  int more = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const KnownScene scene = disordered(seed);
    const Lattice coarse{4, 3, 16, 1};
    const bool coarsely = escape(scene, coarse, 30).found();
    const bool finely = escape(scene, coarse.halved(), 30).found();
    EXPECT_LE(coarsely, finely) << seed;
    none += !finely;
    found += coarsely;
    more += finely && !coarsely;
  }
  EXPECT_GT(none, 10);
  EXPECT_GT(found, 10);
  EXPECT_GT(more, 0);
}

TEST(EscapeSearch, OneMoverMoreLeavesNoMoreWays) {
  int lost = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    KnownScene scene = disordered(seed);
    bool before = escape(scene, {}, 30).found();
    while (!scene.movers.empty()) {
      scene.movers.pop_back();
      const bool fewer = escape(scene, {}, 30).found();
      EXPECT_LE(before, fewer) << seed;
      lost += fewer && !before;
      before = fewer;
    }
    EXPECT_TRUE(before);
  }
  EXPECT_GT(lost, 10);
}

// ---- the cause: flights made by hand -----------------------------------------------------

struct Flight {
  host::FlightSetup setup;
  host::FlightResult result;

  explicit Flight(double sensing_m) {
    setup.request = problem(true);
    setup.request.vehicle.sensing_m = sensing_m;
    result.status = host::RunStatus::collided;
  }
  void add(std::string id, const Vec3& at, const Vec3& velocity, double radius) {
    auto moving = setup.truth.moving();
    moving.push_back({std::move(id), Sphere{at, radius}, velocity, 0, false});
    setup.truth = setup.truth.with_moving(std::move(moving));
  }
  /// East, a step a second, into the mover of that name.
  Cause collide_east(int seconds, const std::string& id) {
    result.message = "collided with '" + id + "' near there";
    for (int t = 0; t <= seconds; ++t) {
      result.track.emplace_back(t, Vec3(kSpeed * t, 0, 1000));
    }
    return CauseSearch(setup, result).judge();
  }
};

/// Twice as fast as the vehicle, so it must be left at R w / v = 404 m. It comes at 90 m/s: from
/// 1,200 m off it is 480 m off at 8 s, and 390 m at 9 s.
TEST(Cause, IsThePilotsWhoFliesOnTowardWhatItSees) {
  Flight flight(1000);
  flight.add("fast", {1200, 0, 1000}, {-2 * kSpeed, 0, 0}, 200);
  const Cause cause = flight.collide_east(12, "fast");
  EXPECT_EQ(cause.verdict, Cause::Verdict::avoidable);
  EXPECT_EQ(cause.last_step, 8U);
  EXPECT_TRUE(cause.was_known);
}

/// The same, seen from 100 m before its edge: 390 m off it is not seen, 300 m off it is too late.
TEST(Cause, IsNobodysWhereTheSensorShowsItTooLate) {
  Flight flight(100);
  flight.add("fast", {1200, 0, 1000}, {-2 * kSpeed, 0, 0}, 200);
  const Cause cause = flight.collide_east(12, "fast");
  EXPECT_EQ(cause.verdict, Cause::Verdict::all_knowing);
  EXPECT_EQ(cause.last_step, 9U);
  EXPECT_FALSE(cause.was_known);
}

/// In a lane that is as wide as what comes: from ahead, seen from 400 m before its edge, which is
/// at 13 s, and from behind, as fast as the vehicle.
Cause between_two(double behind) {
  Flight flight(400);
  const Layer walls{"walls", "shape",
                    std::make_shared<kit::ShapeLayer>(
                        std::vector<Shape>{BoxShape{{{200, -130, 0}, {3000, -50, 2000}}},
                                           BoxShape{{{200, 50, 0}, {3000, 130, 2000}}}}),
                    true};
  flight.setup.truth = World().with(walls);
  flight.setup.request.world = std::make_shared<const World>(World().with(walls));
  flight.add("ahead", {1000, 0, 1000}, {-kSpeed / 2, 0, 0}, 49);
  flight.add("behind", {behind, 0, 1000}, {kSpeed, 0, 0}, 49);
  return flight.collide_east(21, "ahead");
}

TEST(Cause, IsNobodysWhereNewsCloseTheWay) {
  const Cause seen_late = between_two(-300);
  EXPECT_EQ(seen_late.verdict, Cause::Verdict::all_knowing);
  EXPECT_EQ(seen_late.last_step, 12U);
  EXPECT_FALSE(seen_late.was_known);
}

/// What it never saw is no excuse: by what it knew, it could have gone back.
TEST(Cause, IsThePilotsByWhatItKnew) {
  const Cause cause = between_two(-3000);
  EXPECT_EQ(cause.verdict, Cause::Verdict::avoidable);
  EXPECT_GT(cause.last_step, 12U);
  EXPECT_TRUE(cause.was_known);
}

TEST(Cause, IsNobodysWhereNotEvenTheAllKnowingArrives) {
  Flight flight(1000);
  flight.add("goal", flight.setup.request.goal.position, {0, 0, 0}, 300);
  for (const Mover& mover : ring(12, 600, 200, kSpeed)) {
    flight.add("ring" + std::to_string(flight.setup.truth.moving().size()), mover.at_0,
               mover.velocity, mover.radius);
  }
  const Cause cause = flight.collide_east(7, "ring1");
  EXPECT_EQ(cause.verdict, Cause::Verdict::unsolvable);
  EXPECT_EQ(cause.last_step, std::nullopt);
}

TEST(Cause, TellsWhoGivesUpWithAWayOut) {
  Flight flight(1000);
  flight.result.status = host::RunStatus::not_reached;
  flight.add("slow", {1000, 0, 1000}, {-1, 0, 0}, 100);
  const Cause cause = flight.collide_east(20, "none");
  EXPECT_EQ(cause.verdict, Cause::Verdict::given_up);
  EXPECT_EQ(cause.last_step, 20U);
}

/// On the route it looks around each `step_s`, whatever corners lie between; under the pilot each
/// leg.
TEST(Cause, LooksAroundWhereTheHostSenses) {
  Flight flight(1000);
  for (const double t : {0.0, 0.4, 1.0, 2.0, 2.3, 2.6, 3.0, 4.0}) {
    flight.result.track.emplace_back(t, Vec3(kSpeed * t, 0, 1000));
  }
  flight.result.handovers = {{2.0, "apf", ""}, {2.6, "route", ""}};
  std::vector<std::size_t> steps;
  for (const Look& look : CauseSearch(flight.setup, flight.result).looks_of_flight()) {
    steps.push_back(look.step);
  }
  EXPECT_EQ(steps, (std::vector<std::size_t>{0, 2, 3, 4, 5}));
}
}  // namespace
}  // namespace altiplan::reference::escape_search_test
