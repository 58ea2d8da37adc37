// SPDX-License-Identifier: Apache-2.0
// Laws of whole flights with apf, hand-overs and ends included: turns, and mirrored worlds.
#include <gtest/gtest.h>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "reference/moving_worlds.hpp"
#include "support/instrumented.hpp"

namespace altiplan::reference::flight_laws_test {
namespace {

constexpr double kMaxTurnDeg = 30;

std::int64_t counter(const host::FlightResult& result, std::string_view name) {
  for (const Counter& counter : result.counters) {
    if (counter.name == name) {
      return counter.value;
    }
  }
  ADD_FAILURE() << "no counter " << name;
  return -1;
}

std::int64_t turns_above_limit(const host::FlightResult& result) {
  std::int64_t sharp = 0;
  const auto& track = result.track;
  for (std::size_t i = 1; i + 1 < track.size(); ++i) {
    const Vec3 before = track[i].second - track[i - 1].second;
    const Vec3 after = track[i + 1].second - track[i].second;
    sharp += degrees(turn_angle_in_space(before, after)) > kMaxTurnDeg + 1e-6;
  }
  return sharp;
}

/// In how many flights the limit yields. The routes of these worlds are straight, so every turn is
/// the pilot's or a hand-over's.
int hold_turns(std::uint64_t from, std::uint64_t to) {
  int commanded = 0;
  int yielded = 0;
  for (std::uint64_t seed = from; seed < to; ++seed) {
    const MovingWorld world = moving_world(seed);
    const host::FlightResult result = host::fly(world.setup);
    if (result.handovers.empty()) {
      continue;
    }
    ++commanded;
    const std::int64_t counted = counter(result, "clamp_yielded");
    yielded += counted > 0;
    EXPECT_EQ(turns_above_limit(result), counted) << "seed " << seed << ", " << world.tells;
  }
  EXPECT_GT(commanded, int(to - from) * 3 / 4);
  return yielded;
}
TEST(FlightLaws, EveryTurnAboveTheLimitIsCounted) { hold_turns(1, 11); }
// Among them worlds so hard that the limit yields; the pilot looks long for a way out of them.
TEST(NightlyFlightLaws, EveryTurnAboveTheLimitIsCounted) { EXPECT_GT(hold_turns(1, 1001), 0); }

struct Post {
  Cylinder shape;
  bool known = false;
};

/// A world and its image in the plane y = 0.
struct Mirrored {
  host::FlightSetup setup;

  Mirrored(const host::FlightSetup& original, const std::vector<Post>& posts, double sign)
      : setup(original) {
    World known;
    World truth;
    for (const Post& post : posts) {
      Cylinder shape = post.shape;
      shape.y *= sign;
      const Layer layer{"post" + std::to_string(truth.layers().size()), "shape",
                        std::make_shared<kit::ShapeLayer>(std::vector<Shape>{shape}), post.known};
      truth = truth.with(layer);
      known = post.known ? known.with(layer) : known;
    }
    const auto image = [sign](const Vec3& p) { return Vec3(p.x(), sign * p.y(), p.z()); };
    std::vector<MovingObstacle> movers = original.truth.moving();
    for (MovingObstacle& mover : movers) {
      auto& sphere = std::get<Sphere>(mover.shape);
      sphere.centre = image(sphere.centre);
      mover.velocity = image(mover.velocity);
    }
    setup.truth = truth.with_moving(std::move(movers));
    setup.request.world = std::make_shared<const World>(known);
    setup.route_request = setup.request;
  }
};

void expect_mirrored_flights(const host::FlightSetup& setup, const std::vector<Post>& posts) {
  const host::FlightResult left = host::fly(Mirrored(setup, posts, 1).setup);
  const host::FlightResult right = host::fly(Mirrored(setup, posts, -1).setup);
  EXPECT_EQ(left.status, right.status);
  ASSERT_EQ(left.track.size(), right.track.size());
  for (std::size_t i = 0; i < left.track.size(); ++i) {
    const auto& [t, p] = left.track[i];
    const auto& [u, q] = right.track[i];
    ASSERT_NEAR(t, u, 1e-6) << i;
    ASSERT_LT((p - Vec3(q.x(), -q.y(), q.z())).norm(), 1e-6) << i;
  }
  ASSERT_EQ(left.handovers.size(), right.handovers.size());
  EXPECT_FALSE(left.handovers.empty());
  for (std::size_t i = 0; i < left.handovers.size(); ++i) {
    EXPECT_EQ(left.handovers[i].to, right.handovers[i].to);
    EXPECT_EQ(left.handovers[i].why, right.handovers[i].why);
  }
}

/// The vehicle and the way of a drawn world, which lie in the plane y = 0, in a world of others.
MovingWorld bare_world(std::uint64_t seed) {
  MovingWorld world = moving_world(seed);
  world.setup.request.limits.min_ground_clearance.reset();
  return world;
}

TEST(FlightLaws, MirroredHiddenPostsGiveMirroredFlights) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    MovingWorld world = bare_world(seed);
    world.setup.truth = World();
    const double length = world.setup.request.goal.position.x();
    RandomStream random = RandomStream(seed).sub("posts");
    std::vector<Post> posts;
    posts.push_back({{random.uniform(0.35, 0.6) * length, random.uniform(-100, 100), 150}, false});
    posts.push_back({{random.uniform(0.3, 0.8) * length, random.uniform(400, 600), 150}, true});
    expect_mirrored_flights(world.setup, posts);
  }
}

TEST(FlightLaws, MirroredMoversGiveMirroredFlights) {
  if (altiplan::testing::kInstrumented) {
    GTEST_SKIP() << "a sanitizer takes minutes over it";
  }
  int flown = 0;
  for (std::uint64_t seed = 200; seed < 240; ++seed) {
    SCOPED_TRACE(seed);
    const MovingWorld world = bare_world(seed);
    if (!host::fly(Mirrored(world.setup, {}, 1).setup).handovers.empty()) {
      expect_mirrored_flights(world.setup, {});
      ++flown;
    }
  }
  EXPECT_GT(flown, 25);
}
}  // namespace
}  // namespace altiplan::reference::flight_laws_test
