// SPDX-License-Identifier: Apache-2.0
#include "host/mission/mission.hpp"

#include "files.hpp"
#include "host/judge/judge.hpp"

namespace altiplan::host::mission_test {
namespace {

class MissionTest : public testing::Files {
 protected:
  Mission mission(const std::string& constraints = "") const {
    return build_mission(load_config(pipeline("steps: [{plan: told}]\n" + constraints), overrides_),
                         1);
  }
  std::string refused(const std::string& more, const std::string& ends,
                      const std::string& volume = kVolume) const {
    scenario(more, ends, volume);
    return refusal("steps: [{plan: told}]\n");
  }
  static constexpr const char* kVolume = "volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 1000]}\n";
  static constexpr const char* kEnds =
      "start: {at_m: [100, 500, 500]}\ngoal: {at_m: [900, 500, 500]}\n";
};

TEST_F(MissionTest, PointsThatCannotBeResolved) {
  EXPECT_EQ(refused("", "start: {at_lonlat: [10, 20, 5]}\ngoal: {at_m: [9, 5, 5]}\n").substr(0, 19),
            "s.yaml:3:1: start: ");
  EXPECT_HAS(refused("", "start: {at_m: [1, 2], above_ground_m: 5}\ngoal: {at_m: [9, 5, 5]}\n"),
             "s.yaml:3:1: start: above_ground_m needs a layer with ground (terrain)");
  EXPECT_HAS(refused("", "start: {at_m: [1, 2, 3]}\ngoal: {at_cell: [1, 2, 3]}\n"),
             "s.yaml:4:1: goal: at_cell needs a layer with its own cells");
  EXPECT_HAS(refused("via: [{at_m: [1, 2, 3]}, {at_cell: [1, 2, 3]}]\n", kEnds),
             "s.yaml:5:26: via.1: at_cell needs");
}

TEST_F(MissionTest, TheVolumeMustBeBoundedAndNotEmpty) {
  EXPECT_EQ(
      refused("", kEnds, ""),
      "s.yaml:1:1: volume.min_m: no layer bounds the volume from below on x, y, z: give "
      "volume.min_m\ns.yaml:1:1: volume.max_m: no layer bounds the volume from above on x, y, "
      "z: give volume.max_m");
  EXPECT_HAS(refused("", kEnds, "volume: {min_m: [0, 0, 0]}\n"),
             "s.yaml:2:1: volume.max_m: no layer bounds the volume from above on x, y, z");
  EXPECT_HAS(refused("", kEnds, "volume: {min_m: [0, 9, 0], max_m: [1, 8, 1]}\n"),
             "s.yaml:2:9: volume: expected min_m below max_m on each axis");
  EXPECT_HAS(refused("environment: [{cells: {}}]\n", kEnds, "volume: {min_m: [2000, 0, 0]}\n"),
             "s.yaml:2:1: volume: the volume is empty on the x axis");
  scenario("environment: [{cells: {}}]\n", kEnds, "");
  EXPECT_EQ(mission().request.volume.max, Vec3(1000, 1000, 1000)) << "that of the layers";
}

TEST_F(MissionTest, ResolvesPoints) {
  scenario("environment: [{cells: {}}]\nvia: [{at_m: [5, 6, 7], tolerance_m: 2}]\n",
           "start: {at_cell: [0, 1, 2]}\ngoal: {at_m: [900, 500, 500], tolerance_m: 3}\n");
  const Mission cells = mission();
  EXPECT_EQ(cells.request.start.position, Vec3(50, 150, 250));
  EXPECT_EQ(cells.request.goal.tolerance_m, 3);
  ASSERT_EQ(cells.via.size(), 1U);
  EXPECT_EQ(cells.via[0].position, Vec3(5, 6, 7));
  EXPECT_EQ(cells.via[0].tolerance_m, 2);
}

TEST_F(MissionTest, LevelFlightTakesTwoCoordinates) {
  scenario("level_flight_at_m: 300\nvia: [{at_m: [500, 600]}]\n",
           "start: {at_m: [100, 500]}\ngoal: {at_m: [900, 500]}\n");
  const Mission level = mission();
  EXPECT_EQ(level.request.start.position, Vec3(100, 500, 300));
  EXPECT_EQ(level.request.goal.position, Vec3(900, 500, 300));
  EXPECT_EQ(level.via[0].position, Vec3(500, 600, 300));
  EXPECT_EQ(level.request.volume.min.z(), 300);
  EXPECT_EQ(level.request.volume.max.z(), 300);
  EXPECT_EQ(run("steps: [{plan: told}]\n").status, RunStatus::solved);
  const RunResult off = run("steps: [{plan: told, with: {does: past, past_m: [500, 600, 301]}}]\n");
  EXPECT_EQ(off.status, RunStatus::rejected);
  scenario("level_flight_at_m: 300\n",
           "start: {at_m: [100, 500, 310]}\ngoal: {at_m: [900, 500]}\n");
  EXPECT_EQ(run("steps: [{plan: told}]\n").status, RunStatus::invalid_problem);
}

TEST_F(MissionTest, WhatIsNotKnownIsInTheTruthAlone) {
  scenario(
      "environment:\n  - box: {min_m: [400, 0, 0], max_m: [500, 1000, 1000]}\n    known: false\n"
      "  - cylinder: {at_m: [50, 50], radius_m: 5}\n"
      "moving:\n  - sphere: {at_m: [1, 2, 3], radius_m: 1, velocity_mps: [1, 0, 0]}\n"
      "  - box: {min_m: [0, 0, 0], max_m: [1, 1, 1], velocity_mps: [0, 1, 0]}\n    known: false\n");
  const Mission made = mission();
  EXPECT_EQ(made.truth.layers().size(), 2U);
  ASSERT_EQ(made.known.layers().size(), 1U);
  EXPECT_EQ(made.known.layers()[0].id, "cylinder");
  EXPECT_EQ(made.truth.moving().size(), 2U);
  ASSERT_EQ(made.known.moving().size(), 1U);
  EXPECT_EQ(made.known.moving()[0].id, "sphere_1");
  EXPECT_EQ(made.known.moving()[0].velocity, Vec3(1, 0, 0));
  EXPECT_EQ(made.request.world->layers().size(), 1U);
}

TEST_F(MissionTest, RandomMovingObstaclesFollowTheSeed) {
  const auto drawn = [&](std::int64_t seed, const std::string& own = "") {
    scenario("moving: [{random: {count: 20, radius_m: 4, speed_mps: 7" + own + "}, id: bird}]\n");
    overrides_.seed = seed;
    return mission().truth.moving();
  };
  const auto first = drawn(1);
  ASSERT_EQ(first.size(), 20U);
  EXPECT_EQ(first[0].id, "bird_1");
  for (const MovingObstacle& bird : first) {
    const auto& sphere = std::get<Sphere>(bird.shape);
    EXPECT_EQ(sphere.radius, 4);
    EXPECT_NEAR(bird.velocity.norm(), 7, 1e-9);
    EXPECT_TRUE((Box{{0, 0, 0}, {1000, 1000, 1000}}.contains(sphere.centre)));
  }
  EXPECT_EQ(drawn(1)[7].velocity, first[7].velocity);
  EXPECT_NE(drawn(2)[7].velocity, first[7].velocity);
  EXPECT_EQ(drawn(3, ", seed: 5")[7].velocity, drawn(4, ", seed: 5")[7].velocity);
}

TEST_F(MissionTest, ConstraintsOfBothFilesGoWhereTheyApply) {
  scenario(
      "constraints: [{climb_angle: {max_deg: 20}}, {turn_angle: {max_deg: 90}}]\n"
      "vehicle: {radius_m: 2}\n");
  const Mission made = mission(
      "constraints: [{climb_angle: {max_deg: 10}}, {climb_angle: {max_deg: 15}}, {not_north: "
      "{holds_for: track}}, {clearance: {min_m: 5}}]\n");
  EXPECT_NEAR(made.request.limits.max_climb, radians(10), 1e-12) << "the strictest";
  EXPECT_NEAR(made.request.limits.max_turn_horizontal, radians(90), 1e-12);
  EXPECT_GT(made.track_request.limits.max_turn_horizontal, 3) << "turns: of routes alone";
  EXPECT_EQ(made.request.limits.min_clearance, 5);
  EXPECT_EQ(made.request.constraints.size(), 5U);
  EXPECT_EQ(made.track_request.constraints.size(), 5U);
  EXPECT_EQ(made.track_request.constraints[3].name, "not_north");
}

TEST_F(MissionTest, JudgesViaPointsInOrder) {
  scenario("via: [{at_m: [300, 500, 500]}, {at_m: [500, 500, 500]}]\n");
  const Mission made = mission();
  const Vec3 start(100, 500, 500);
  const Vec3 goal(900, 500, 500);
  const Vec3 one(300, 500, 500);
  const Vec3 two(500, 500, 500);
  EXPECT_TRUE(judge({start, one, two, goal}, made.request, made.via).ok());
  EXPECT_EQ(via_indices({start, two, one, two, goal}, made.via), (std::vector<std::size_t>{2, 3}));
  const CheckResult wrong = judge({start, two, one, goal}, made.request, made.via);
  ASSERT_EQ(wrong.violations.size(), 1U);
  EXPECT_EQ(
      wrong.violations[0].message,
      "the route does not pass via point 1: its nearest waypoint is 200 m away, tolerance_m 0");
  EXPECT_EQ(violated_layer(wrong), nullptr);
  EXPECT_FALSE(judge({start, goal}, made.request, made.via).ok()) << "a via point is a waypoint";
  EXPECT_FALSE(judge({}, made.request, {}).ok());
}
}  // namespace
}  // namespace altiplan::host::mission_test
