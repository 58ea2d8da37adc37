// SPDX-License-Identifier: Apache-2.0
#include "host/flight/track_judge.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "support/support.hpp"

namespace altiplan::host::track_judge_test {
namespace {

Layer layer(const std::string& id, Shape shape, bool known = true) {
  return {id, "shape", std::make_shared<kit::ShapeLayer>(std::vector<Shape>{std::move(shape)}),
          known};
}

/// East along y = 0 from 0 to 3000 m at 30 m/s: 100 s.
FlightSetup setup() {
  FlightSetup all;
  all.request = altiplan::testing::request_in(World(), {0, 0, 100}, {3000, 0, 100},
                                              {{-100, -3000, 0}, {4000, 3000, 1000}});
  all.request.vehicle.radius_m = 2;
  all.request.vehicle.speed_mps = 30;
  all.request.vehicle.sensing_m = 0;
  all.request.limits.min_clearance = 2;
  all.route_request = all.request;
  all.route = {{0, 0, 100}, {3000, 0, 100}};
  return all;
}

Track straight(double seconds_a_point = 1) {
  Track track;
  for (double t = 0; t <= 100; t += seconds_a_point) {
    track.emplace_back(t, Vec3(30 * t, 0, 100));
  }
  return track;
}

std::vector<std::string> rules(const TrackVerdict& verdict) {
  std::vector<std::string> names;
  for (const Violation& violation : verdict.check.violations) {
    names.push_back(violation.constraint);
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}
using Names = std::vector<std::string>;

std::string layer_of_collision(const TrackVerdict& verdict) {
  for (const Violation& violation : verdict.check.violations) {
    if (violation.constraint == "collision") {
      return violation.layer;
    }
  }
  return "";
}

TEST(TrackJudge, AgreesWithTheFlight) {
  FlightSetup all = setup();
  const FlightResult flown = fly(all);
  ASSERT_TRUE(flown.reached);
  const TrackVerdict sound = judge_track(flown.track, all);
  EXPECT_TRUE(sound.check.ok());
  EXPECT_TRUE(sound.reached);
  EXPECT_EQ(sound.collisions, 0);

  all.truth = all.truth.with(layer("hidden", Cylinder{1500, 0, 50}, false));
  const FlightResult hit = fly(all);
  ASSERT_EQ(hit.status, RunStatus::collided);
  const TrackVerdict verdict = judge_track(hit.track, all);
  EXPECT_EQ(verdict.collisions, 1);
  EXPECT_FALSE(verdict.reached);
  EXPECT_EQ(rules(verdict), (Names{"clearance", "collision", "goal"}));
  EXPECT_EQ(layer_of_collision(verdict), "hidden");
  EXPECT_EQ(layer_of_collision({hit.check, 1, false, {}, {}}), "hidden");
}

TEST(TrackJudge, CountsEachTimeThatSomethingIsTouched) {
  FlightSetup all = setup();
  all.truth = all.truth.with(layer("first", Cylinder{1000, 0, 100}))
                  .with(layer("second", Cylinder{2000, 101.9, 100}))
                  .with(layer("beside", Cylinder{2500, 102, 100}));
  EXPECT_EQ(judge_track(straight(), all).collisions, 2) << "touching at the radius is free";
}

TEST(TrackJudge, AThinWallBetweenTwoPointsIsSeen) {
  FlightSetup all = setup();
  all.truth = all.truth.with(layer("wall", BoxShape{{{1500, -50, 0}, {1500.01, 50, 500}}}));
  const TrackVerdict verdict = judge_track(straight(100), all);
  EXPECT_EQ(verdict.collisions, 1);
  EXPECT_EQ(rules(verdict), (Names{"clearance", "collision"}));
}

TEST(TrackJudge, MovingObstaclesByTheirTimes) {
  FlightSetup all = setup();
  // Crosses y = 0 at x = 1500 at 50 s, when the vehicle is there, or 10 s later.
  for (const double at_s : {50.0, 60.0}) {
    const Vec3 velocity(0, 20, 0);
    all.truth = World().with_moving(
        {{"mover", Sphere{Vec3(1500, 0, 100) - velocity * at_s, 50}, velocity, 0, false}});
    const TrackVerdict verdict = judge_track(straight(), all);
    EXPECT_EQ(verdict.collisions, at_s == 50 ? 1 : 0);
    EXPECT_EQ(rules(verdict), at_s == 50 ? Names{"collision"} : Names{});
    EXPECT_EQ(layer_of_collision(verdict), "") << "what moves is no layer";
  }
}

TEST(TrackJudge, EventsChangeTheWorldAtTheirTimes) {
  FlightEvent add;
  add.kind = FlightEvent::Kind::add;
  add.id = "pop_up";
  add.layer = layer("pop_up", Cylinder{1500, 0, 50});
  FlightEvent remove;
  remove.kind = FlightEvent::Kind::remove;
  remove.id = "pop_up";
  FlightSetup all = setup();
  const auto collisions = [&](double added, double removed) {
    add.at_s = added;
    remove.at_s = removed;
    all.events = {add, remove};
    return judge_track(straight(), all).collisions;
  };
  EXPECT_EQ(collisions(20, 80), 1);
  EXPECT_EQ(collisions(20, 40), 0) << "gone before the vehicle comes";
  EXPECT_EQ(collisions(60, 80), 0) << "there after it has passed";

  add.at_s.reset();
  add.when_near = {{1000, 0, 100}, 10};
  all.events = {add};
  EXPECT_EQ(judge_track(straight(), all).collisions, 1);
  add.when_near = {{1000, 500, 100}, 10};
  all.events = {add};
  EXPECT_EQ(judge_track(straight(), all).collisions, 0) << "the vehicle never is near";
}

TEST(TrackJudge, TheGoalWhereItHasMovedTo) {
  FlightSetup all = setup();
  FlightEvent move;
  move.kind = FlightEvent::Kind::move_goal;
  move.at_s = 50;
  move.vector = {3000, 1000, 100};
  all.events = {move};
  const TrackVerdict verdict = judge_track(straight(), all);
  EXPECT_FALSE(verdict.reached);
  EXPECT_EQ(rules(verdict), Names{"goal"});
}

TEST(TrackJudge, ForgedTracks) {
  FlightSetup all = setup();
  Track fast = straight();
  fast[50].first -= 0.5;
  EXPECT_EQ(rules(judge_track(fast, all)), Names{"speed"});
  Track back = straight();
  std::swap(back[50].first, back[51].first);
  EXPECT_EQ(rules(judge_track(back, all)), Names{"speed"});
  Track elsewhere = straight();
  elsewhere.front().second.y() = 1;
  EXPECT_EQ(rules(judge_track(elsewhere, all)), Names{"start"});
  Track low = straight();
  low[50].second.z() = -1;
  const Names found = rules(judge_track(low, all));
  EXPECT_NE(std::find(found.begin(), found.end(), "volume"), found.end());
  EXPECT_EQ(rules(judge_track({}, all)), Names{"start"});
  Track cut = straight();
  cut.resize(50);
  EXPECT_EQ(rules(judge_track(cut, all)), Names{"goal"});
}

TEST(TrackJudge, TheLengthOfTheWhole) {
  FlightSetup all = setup();
  all.request.limits.max_route_length = 2999;
  EXPECT_EQ(rules(judge_track(straight(), all)), Names{"route_length"});
}
}  // namespace
}  // namespace altiplan::host::track_judge_test
