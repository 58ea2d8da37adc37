// SPDX-License-Identifier: Apache-2.0
// Worlds drawn with the route that astar must take: '*' marks the cells of the way from S to G.
#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan::drawn_worlds_test {
namespace {

using Levels = std::vector<std::string>;

Levels without_way(Levels levels) {
  for (std::string& level : levels) {
    std::replace(level.begin(), level.end(), '*', '.');
  }
  return levels;
}

/// The rows of the drawing with the route's cells marked, as the picture is written.
Levels drawing_of(const Levels& picture, const Route& route, const GridSpec& spec) {
  Levels marked = without_way(picture);
  for (const Vec3& p : route) {
    const Cell c = spec.cell_of(p);
    std::string& level = marked[std::size_t(c[2])];
    const std::size_t row = std::size_t(spec.counts[1] - 1 - c[1]);
    char& at = level[row * std::size_t(spec.counts[0] + 1) + std::size_t(c[0])];
    at = at == '.' ? '*' : at;
  }
  return marked;
}

/// Rows joined as draw() reads them.
std::string rows(std::initializer_list<const char*> lines) {
  std::string text;
  for (const char* line : lines) {
    text += (text.empty() ? "" : "\n") + std::string(line);
  }
  return text;
}

struct Asked {
  std::string with = "{}";
  double radius = 0;
  double max_climb = kPi / 2;
  double tolerance = 0;
  bool level = false;
};

PlanResult plan(const Levels& picture, const Asked& asked, GridSpec& spec) {
  testing::Drawn drawn = testing::draw(without_way(picture));
  Request& request = drawn.request;
  request.vehicle.radius_m = asked.radius;
  request.limits.max_climb = asked.max_climb;
  request.goal.tolerance_m = asked.tolerance;
  if (asked.level) {
    request.level_m = request.start.position.z();
  }
  spec = *drawn.world->native_grid();
  PlanResult result = testing::make_planner("astar", asked.with)->plan(request);
  EXPECT_TRUE(result.status != PlanStatus::solved || check(result.route, request).ok());
  return result;
}

void expect_way(const Levels& picture, const Asked& asked = {}) {
  GridSpec spec;
  const PlanResult result = plan(picture, asked, spec);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  const Levels drawn = drawing_of(picture, result.route, spec);
  for (std::size_t k = 0; k < picture.size(); ++k) {
    EXPECT_EQ(drawn[k], picture[k]) << "level " << k << " is\n" << drawn[k];
  }
}

void expect_no_way(const Levels& picture, const Asked& asked = {}) {
  GridSpec spec;
  const PlanResult result = plan(picture, asked, spec);
  EXPECT_EQ(result.status, PlanStatus::no_route) << result.message;
  EXPECT_TRUE(result.proved) << result.message;
}

TEST(DrawnWorlds, ACornerIsCutOnlyWhereTheRuleLets) {
  expect_way({rows({".G",  //
                    "S#"})});
  expect_way({rows({"*G",  //
                    "S#"})},
             {"{corner: free_box}"});
}

TEST(DrawnWorlds, BetweenTwoCornersThatTouch) {
  const Levels squeeze = {rows({"#G",  //
                                "S#"})};
  expect_way(squeeze);
  expect_way(squeeze, {"{moves: exact}"});  // touching is free for a point
  expect_no_way(squeeze, {"{corner: free_box}"});
  expect_no_way(squeeze, {"{moves: exact}", 0.1});
  expect_no_way(squeeze, {"{neighbours: 6}"});
}

TEST(DrawnWorlds, AWindingCorridorOfOneCell) {
  expect_way({rows({"#***###",  //
                    "#*#*###",  //
                    "S*#**G#"})},
             {"{corner: free_box}"});
  expect_way({rows({"#***###",  //
                    "#*#*###",  //
                    "S*#**G#"})},
             {"{neighbours: 6}"});
  expect_way({rows({"#.*.###",  //
                    "#*#*###",  //
                    "S.#.*G#"})});
}

TEST(DrawnWorlds, AVehicleAsWideAsTheCorridorTouchesBothWalls) {
  const Levels corridor = {rows({"#######",  //
                                 "S*****G",  //
                                 "#######"})};
  expect_way(corridor, {"{}", 0.5});
  expect_no_way({rows({"#####",  //
                       "S...G",  //
                       ".#.#."})},
                {"{moves: cells}", 0.2});  // whole cells near a wall are closed
  GridSpec spec;
  EXPECT_EQ(plan(corridor, {"{}", 0.51}, spec).status, PlanStatus::invalid_problem);
}

TEST(DrawnWorlds, OutOfADeadEnd) {
  expect_way({rows({"..######.",  //
                    "..#....#.",  //
                    "..#.S..#G",  //
                    "..#*####*",  //
                    "....****."})});
}

TEST(DrawnWorlds, AroundATrapThatOpensTowardTheStart) {
  expect_way({rows({".******..",  //
                    "*######*.",  //
                    "*.....#*.",  //
                    "S.....#G.",  //
                    "......#..",  //
                    "......#..",  //
                    ".######..",  //
                    "........."})});
}

TEST(DrawnWorlds, ASealedGoal) {
  const Levels sealed = {rows({"..###",  //
                               "..#G#",  //
                               "S.###"})};
  expect_no_way(sealed);
  expect_no_way(sealed, {"{moves: exact}"});
  expect_way({rows({"..###",  //
                    ".*#G#",  //
                    "S.###"})},
             {"{}", 0, kPi / 2, 2});  // as near as its tolerance asks
}

TEST(DrawnWorlds, ASealedStart) {
  expect_no_way({rows({"##..",  //
                       "S#..",  //
                       "##.G"})},
                {"{corner: free_box}"});
}

TEST(DrawnWorlds, AlongTheEdgeOfTheVolume) {
  expect_way({rows({"S###.",  //
                    "*###.",  //
                    "*###.",  //
                    ".***G"})});
}

TEST(DrawnWorlds, OverAWall) {
  expect_way({"S#G", "*#*", ".*."});
  expect_no_way({"S#G", ".#."});
  expect_way({"S.#.G", ".*#*.", "..*.."}, {"{corner: any}", 0, radians(45)});
  expect_no_way({"S#G", ".#.", "..."}, {"{}", 0, radians(60)});  // no room to climb in
}

TEST(DrawnWorlds, ThroughAWindowOnTheSecondLevel) {
  expect_way({rows({"..#..",  //
                    "S.#.G",  //
                    "..#.."}),
              rows({"..#..",  //
                    ".***.",  //
                    "..#.."})},
             {"{corner: free_box}"});
}

TEST(DrawnWorlds, LevelFlightStaysOnItsLevel) {
  const Levels wall = {rows({"..*..",  //
                             ".*#*.",  //
                             "S.#.G"}),
                       rows({".....",  //
                             ".....",  //
                             "....."})};
  expect_way(wall, {"{}", 0, kPi / 2, 0, true});
  expect_way({rows({".....",  //
                    "..#..",  //
                    "S.#.G"}),
              rows({".....",  //
                    ".....",  //
                    ".***."})},
             {"{corner: free_box}"});
}

TEST(DrawnWorlds, AShaftIsNoWayForWhatCannotClimb) {
  const Levels shaft = {"S#", "*#", "*#", "*G"};
  expect_way(shaft, {"{corner: free_box}"});
  expect_no_way(shaft, {"{corner: free_box}", 0, radians(80)});
}

TEST(DrawnWorlds, AKnightsMoveGoesStraightThenAslant) {
  expect_way({rows({"#.G",  //
                    "#*#",  //
                    "S##"})});
}
}  // namespace
}  // namespace altiplan::drawn_worlds_test
