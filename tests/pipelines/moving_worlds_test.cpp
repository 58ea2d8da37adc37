// SPDX-License-Identifier: Apache-2.0
// Flights among moving obstacles that are met in flight: none ends in a collision that what was
// known would have let it avoid.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <numeric>

#include "reference/escape_cause.hpp"
#include "reference/moving_worlds.hpp"

namespace altiplan::reference::moving_worlds_test {
namespace {

struct Tally {
  int flights = 0;
  int met = 0;  ///< flights in which the pilot had to take over
  int arrived = 0;
  int rejected = 0;  ///< at the goal, a rule broken on the way
  int collided = 0;
  int not_reached = 0;
  // Of the last two:
  int avoidable = 0;
  int given_up = 0;
  int all_knowing = 0;
  int unsolvable = 0;
  int undecided = 0;
};

std::ostream& operator<<(std::ostream& out, const Tally& tally) {
  return out << tally.flights << " flights, the pilot in command in " << tally.met << ": "
             << tally.arrived << " arrived, " << tally.rejected << " arrived with a rule broken, "
             << tally.collided << " collided, " << tally.not_reached << " given up; of those "
             << tally.avoidable << " avoidable, " << tally.given_up
             << " with a way out at the end, " << tally.all_knowing
             << " that only an all-knowing search solves, " << tally.unsolvable
             << " without any way, " << tally.undecided << " undecided\n";
}

/// The way out must hold under the host's own judge, among all that was known at its step; and so
/// must its end, for good, unless that is the goal.
void expect_sound(const Cause& cause, const host::FlightSetup& setup,
                  const host::FlightResult& result) {
  for (const Look& look : CauseSearch(setup, result).looks_of_flight()) {
    if (look.step != cause.last_step) {
      continue;
    }
    const auto& legs = cause.way_out.legs;
    for (std::size_t i = 0; i + 1 < legs.size(); ++i) {
      const auto& [t0, a] = legs[i];
      const auto& [t1, b] = legs[i + 1];
      EXPECT_LE((b - a).norm(), setup.request.vehicle.speed_mps * (t1 - t0) * (1 + 1e-9));
      EXPECT_FALSE(look.known->world.blocked(a, b, setup.request.vehicle.radius_m));
      for (const MovingObstacle& moving : setup.truth.moving()) {
        EXPECT_FALSE(look.ids->contains(moving.id) &&
                     hits(moving, a, t0, b, t1, setup.request.vehicle.radius_m))
            << moving.id << " at " << t0;
      }
    }
    const auto& [t1, end] = legs.back();
    for (const MovingObstacle& moving : setup.truth.moving()) {
      EXPECT_FALSE(look.ids->contains(moving.id) && end != setup.request.goal.position &&
                   hits(moving, end, t1, end, t1 + 10'000, setup.request.vehicle.radius_m))
          << moving.id << " after the end";
    }
  }
}

void judge_end(std::uint64_t seed, const MovingWorld& world, const host::FlightResult& result,
               Tally& tally, bool tell) {
  const Cause cause = CauseSearch(world.setup, result).judge();
  const auto count = [&](Cause::Verdict verdict, int& of, const char* words) {
    of += cause.verdict == verdict;
    if (cause.verdict == verdict && tell) {
      std::cout << "seed " << seed << ' ' << words << ": " << result.message << " at "
                << result.track.back().first << " s (step " << result.track.size() - 1
                << "); last way out at step "
                << (cause.last_step ? std::to_string(*cause.last_step) : "-") << ", "
                << cause.last_s << " s; " << world.tells << '\n';
    }
  };
  count(Cause::Verdict::avoidable, tally.avoidable, "avoidable");
  count(Cause::Verdict::given_up, tally.given_up, "a way out");
  count(Cause::Verdict::all_knowing, tally.all_knowing, "all-knowing");
  count(Cause::Verdict::unsolvable, tally.unsolvable, "no way");
  count(Cause::Verdict::undecided, tally.undecided, "undecided");
  expect_sound(cause, world.setup, result);
}

/// Flies the world with its pilot, or the route alone.
void fly_one(std::uint64_t seed, bool alone, Tally& tally) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  MovingWorld world = moving_world(seed);
  if (alone) {
    world.setup.pilot = nullptr;
    world.setup.pilot_name = "route";
  }
  const host::FlightResult result = host::fly(world.setup);
  ++tally.flights;
  tally.met += !result.handovers.empty();
  tally.arrived += result.status == host::RunStatus::solved;
  tally.rejected += result.status == host::RunStatus::rejected;
  tally.collided += result.status == host::RunStatus::collided;
  tally.not_reached += result.status == host::RunStatus::not_reached;
  if (result.status == host::RunStatus::collided || result.status == host::RunStatus::not_reached) {
    judge_end(seed, world, result, tally, !alone);
  } else {
    EXPECT_TRUE(result.reached) << result.message;
  }
}

std::vector<std::uint64_t> seeds(std::uint64_t from, std::uint64_t to) {
  std::vector<std::uint64_t> all(to - from);
  std::iota(all.begin(), all.end(), from);
  return all;
}

/// `ALTIPLAN_SEED=N` flies that world alone.
Tally fly_worlds(std::vector<std::uint64_t> worlds) {
  if (const char* one = std::getenv("ALTIPLAN_SEED")) {
    worlds = {std::stoull(one)};
  }
  Tally tally;
  for (const std::uint64_t seed : worlds) {
    fly_one(seed, false, tally);
  }
  std::cout << tally;
  return tally;
}

void hold(const Tally& tally) {
  EXPECT_EQ(tally.avoidable, 0);
  EXPECT_EQ(tally.undecided, 0);
  EXPECT_EQ(tally.given_up, 0);
  EXPECT_EQ(tally.rejected, 0);
  EXPECT_EQ(tally.flights, tally.arrived + tally.avoidable + tally.given_up + tally.all_knowing +
                               tally.unsolvable + tally.undecided);
}

TEST(MovingWorlds, NoCollisionThatCouldBeAvoided) {
  std::vector<std::uint64_t> sample = seeds(1, 15);
  // Rings of which a pilot that looks only some seconds ahead does not get out.
  sample.insert(sample.end(), {825, 867});
  hold(fly_worlds(sample));
}
TEST(NightlyMovingWorlds, NoCollisionThatCouldBeAvoided) { hold(fly_worlds(seeds(1, 1001))); }

/// What the worlds ask of a pilot, and the judgement of whom nobody flies.
TEST(MovingWorlds, TheRouteAloneCollidesWhereThePilotNeedNot) {
  Tally tally;
  for (const std::uint64_t seed : seeds(1, 41)) {
    fly_one(seed, true, tally);
  }
  EXPECT_GE(tally.collided, 30);
  EXPECT_GE(tally.avoidable, 25);
  EXPECT_EQ(tally.collided, tally.avoidable + tally.all_knowing + tally.unsolvable);
}

TEST(MovingWorlds, AreAsTheyAreSaidToBe) {
  std::size_t level = 0;
  std::size_t most = 0;
  std::size_t least = 100;
  for (const std::uint64_t seed : seeds(1, 201)) {
    SCOPED_TRACE(seed);
    const MovingWorld world = moving_world(seed);
    const Request& request = world.setup.request;
    const auto& movers = world.setup.truth.moving();
    level += request.level_m.has_value();
    most = std::max(most, movers.size());
    least = std::min(least, movers.size());
    EXPECT_TRUE(request.world->moving().empty());
    for (const MovingObstacle& mover : movers) {
      const auto& sphere = std::get<Sphere>(mover.shape);
      EXPECT_FALSE(mover.known);
      EXPECT_LE(mover.velocity.norm(), request.vehicle.speed_mps * (1 + 1e-9));
      EXPECT_GE(mover.velocity.norm(), 0.2 * request.vehicle.speed_mps);
      EXPECT_GE(sphere.radius, 50);
      EXPECT_LE(sphere.radius, 400);
      EXPECT_GT((sphere.centre - request.start.position).norm() - sphere.radius,
                10 * request.vehicle.speed_mps);
    }
    EXPECT_FALSE(request.world->blocked(request.start.position, request.goal.position,
                                        request.vehicle.radius_m));
  }
  EXPECT_EQ(level, 100U);
  EXPECT_EQ(most, 20U);
  EXPECT_EQ(least, 1U);
}
}  // namespace
}  // namespace altiplan::reference::moving_worlds_test
