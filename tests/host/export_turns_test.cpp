// SPDX-License-Identifier: Apache-2.0
// Routes with turns, written as points and as loiters, read back and compared along their length.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "altiplan/error.hpp"
#include "altiplan/kit/dubins/airplane.hpp"
#include "altiplan/kit/dubins/wind.hpp"
#include "host/import_export/export.hpp"
#include "host/import_export/imported_route.hpp"
#include "host/import_export/thinning.hpp"
#include "host/import_export/written_route.hpp"
#include "host/judge/judge.hpp"
#include "support/support.hpp"

namespace altiplan::host::export_turns_test {
namespace {

using Until = formats::MissionCircle::Until;

constexpr double kRadius = 80;
constexpr double kClimb = radians(8);

/// An aeroplane in an empty world, from the begin of a route to its end.
Mission mission_for(const Route& route, double goal_tolerance = 1) {
  Mission mission;
  mission.truth = mission.known = World().with_frame(Frame::geographic(-84.3, 36.5, 36.6));
  mission.request = altiplan::testing::request_in(mission.known, route.front(), route.back(),
                                                  {{-9e3, -9e3, 0}, {9e3, 9e3, 3e3}});
  const Leg first = route.leg(0);
  const Vec3 course(first.rate(0).x(), first.rate(0).y(), 0);
  mission.request.start.velocity = 20 * course.normalized();
  mission.request.vehicle.speed_mps = 20;
  mission.request.vehicle.wing = Wing{20, radians(30), kClimb, kClimb};
  mission.request.limits.min_turn_radius = kRadius;
  mission.request.limits.max_climb = kClimb;
  mission.request.goal.tolerance_m = goal_tolerance;
  mission.track_request = mission.request;
  return mission;
}

ExportOptions options_of(const char* format, bool loiters = false) {
  ExportOptions options;
  options.format = &format_named(format);
  options.loiters = loiters;
  return options;
}

Exported exported(const Mission& mission, const Route& route, const ExportOptions& options) {
  return export_route(mission, {"turns", route, {}, {}}, options);
}

Route read_back(const Mission& mission, const std::string& text, const char* format) {
  return read_imported_route(std::string("r") + format_named(format).extension, text, mission.truth,
                             mission.request)
      .route;
}

std::string all_of(const Exported& exported) {
  std::string all;
  for (const std::string& message : exported.messages) {
    all += message + "\n";
  }
  return all;
}

double distance_to(const Vec3& p, const Polyline& line) {
  double least = kInfinity;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    least = std::min(least, point_leg_distance(p, line[i], line[i + 1]));
  }
  return least;
}

/// Greatest distance of a point of one route from the other, to a millimetre or two.
double apart(const Route& a, const Route& b) {
  double most = 0;
  for (const auto& [from, to] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    const Polyline line = to->chords(1e-3);
    for (const Vec3& p : from->chords(1e-2)) {
      most = std::max(most, distance_to(p, line));
    }
  }
  return most;
}

/// Straight, a turn, straight again.
Route corner(double turn, double climb = 0, double radius = kRadius) {
  Route route{Vec3(-500, 0, 500)};
  route.push_back(Vec3(0, 0, 500));
  route.push_back(Leg::turning({{0, 0, 500}, 0}, turn, radius, climb));
  route.push_back(Vec3(route.back() + 600 * unit_heading(turn)));
  return route;
}

formats::MissionFile plan_of(const Exported& exported) {
  return formats::read_mission("r.plan", exported.text.value());
}

TEST(ExportTurns, EveryFormatTakesThemAsPointsWithinHalfAMetre) {
  const Route route = corner(radians(-130), -20);
  const Mission mission = mission_for(route);
  for (const char* format :
       {"qgc-plan", "waypoints", "kml", "kmz", "geojson", "gpx", "czml", "mcap", "csv"}) {
    const Exported result = exported(mission, route, options_of(format));
    ASSERT_TRUE(result.text) << all_of(result);
    EXPECT_NE(all_of(result).find("1 turn written as "), std::string::npos) << all_of(result);
    const Route read = read_back(mission, *result.text, format);
    EXPECT_TRUE(read.is_straight());
    EXPECT_LT(apart(route, read), kArcTolerance);
    EXPECT_LT(read.size(), 20U);
  }
}

// Beside an arc of the least radius, legs that touch it from outside have corners of that radius;
// chords would not.
TEST(ExportTurns, PointsKeepTheTurnRadiusAndTheHeadings) {
  const Route route = corner(radians(100));
  Mission mission = mission_for(route);
  mission.request.goal.heading = radians(100);
  const Exported result = exported(mission, route, options_of("qgc-plan"));
  ASSERT_TRUE(result.text);
  EXPECT_TRUE(judge(read_back(mission, *result.text, "qgc-plan"), mission.request, {}).ok())
      << all_of(result);
  EXPECT_EQ(all_of(result).find("judged along the turns"), std::string::npos) << all_of(result);
}

TEST(ExportTurns, OfARouteThatBeginsWithATurnWhatThePointsCannotKeepIsSaid) {
  Route route{Vec3(0, 0, 500)};
  route.push_back(Leg::turning({{0, 0, 500}, 0}, radians(90), kRadius, 0));
  route.push_back(Vec3(kRadius, 500, 500));
  const Mission mission = mission_for(route);
  const Exported result = exported(mission, route, options_of("qgc-plan"));
  ASSERT_TRUE(result.text) << all_of(result);
  EXPECT_NE(all_of(result).find("turn radius, climb and headings are judged along the turns"),
            std::string::npos)
      << all_of(result);
}

TEST(ExportTurns, ALoiterIsACircleThatIsLeftOnATangent) {
  for (const double turn : {radians(120), radians(-200)}) {
    const Route route = corner(turn, 0, 80.25);
    const Mission mission = mission_for(route);
    for (const char* format : {"qgc-plan", "waypoints"}) {
      const Exported result = exported(mission, route, options_of(format, true));
      ASSERT_TRUE(result.text) << all_of(result);
      EXPECT_NE(all_of(result).find("3 points and 1 loiter, "), std::string::npos);
      EXPECT_NE(all_of(result).find("valid with 7 decimals"), std::string::npos);
      EXPECT_NE(all_of(result).find("ArduPilot stores radii in whole metres: it flies circles up "
                                    "to 0.25 m tighter"),
                std::string::npos)
          << all_of(result);
      const Route read = read_back(mission, *result.text, format);
      ASSERT_EQ(read.leg_count(), 3U);
      EXPECT_NEAR(read.leg(1).turn, turn, 1e-4);
      EXPECT_EQ(read.leg(1).radius, 80.25);
      EXPECT_LT(apart(route, read), 0.03);
    }
    const nlohmann::json items =
        nlohmann::json::parse(*exported(mission, route, options_of("qgc-plan", true)).text)
            .at("mission")
            .at("items");
    EXPECT_EQ(items.at(2).at("command"), 31);
    const nlohmann::json& params = items.at(2).at("params");
    EXPECT_EQ(params.at(0), 1);  // leave for the next heading
    EXPECT_EQ(params.at(1), turn > 0 ? -80.25 : 80.25);
    EXPECT_EQ(params.at(3), 1);  // along the tangent
    EXPECT_EQ(params.at(6), 500);
  }
}

TEST(ExportTurns, AHelixIsALoiterToItsAltitudeAndFullCirclesAtOneHeightAreCounted) {
  const double turn = radians(90) + 4 * kPi;
  const double climb = kRadius * turn * std::tan(kClimb);
  const Route helix = corner(turn, climb * (1 - 1e-9));
  Mission mission = mission_for(helix);
  const Exported up = exported(mission, helix, options_of("qgc-plan", true));
  ASSERT_TRUE(up.text) << all_of(up);
  ASSERT_EQ(plan_of(up).items.size(), 4U);
  EXPECT_EQ(plan_of(up).items[2].circle->until, Until::altitude);
  EXPECT_LT(apart(helix, read_back(mission, *up.text, "qgc-plan")), 0.03);

  const Route level = corner(-turn);
  mission = mission_for(level);
  const Exported around = exported(mission, level, options_of("waypoints", true));
  ASSERT_TRUE(around.text) << all_of(around);
  const formats::MissionFile file = formats::read_mission("r.waypoints", *around.text);
  EXPECT_EQ(file.items[2].circle, (formats::MissionCircle{Until::turns, kRadius, -1, 2}));
  EXPECT_NE(all_of(around).find("PX4 does not accept the full circles"), std::string::npos);
  EXPECT_LT(apart(level, read_back(mission, *around.text, "waypoints")), 0.03);
}

// A helix with more circles than its climb needs would be left sooner.
TEST(ExportTurns, WhatAnAutopilotWouldFlyDifferentlyIsWrittenAsPoints) {
  Route twice = corner(radians(90));
  twice.push_back(Leg::turning({twice.back(), radians(90)}, radians(-90), kRadius, 0));
  Route s_turn{Vec3(-500, 0, 500)};
  s_turn.push_back(Vec3(0, 0, 500));
  s_turn.push_back(Leg::turning({{0, 0, 500}, 0}, radians(90), kRadius, 0));
  s_turn.push_back(Leg::turning({s_turn.back(), radians(90)}, radians(-90), kRadius, 0));
  s_turn.push_back(Vec3(s_turn.back() + Vec3(500, 0, 0)));
  const std::pair<Route, std::size_t> cases[] = {
      {corner(radians(90) + 2 * kPi, 5), 0},  // too many circles for 5 m
      {corner(radians(5)), 0},                // less than the tolerance of the exit
      {corner(radians(355)), 0},              // left at once
      {twice, 1},                             // the last turn leads nowhere
      {s_turn, 1}};                           // the first leads to another circle
  for (const auto& [route, loiters] : cases) {
    const Mission mission = mission_for(route);
    const Exported result = exported(mission, route, options_of("qgc-plan", true));
    ASSERT_TRUE(result.text) << all_of(result);
    const formats::MissionFile file = plan_of(result);
    EXPECT_EQ(std::size_t(std::count_if(file.items.begin(), file.items.end(),
                                        [](const auto& item) { return item.circle.has_value(); })),
              loiters);
    EXPECT_NE(all_of(result).find("1 turn written as "), std::string::npos) << all_of(result);
    EXPECT_LT(apart(route, read_back(mission, *result.text, "qgc-plan")), kArcTolerance);
  }
}

TEST(ExportTurns, InWindEveryTurnIsPoints) {
  const Vec3 wind(6, -3, 0);
  const Pose from{{0, 0, 500}, 0};
  const Pose to{{900, 700, 560}, radians(200)};
  const auto path = kit::wind_path(from, to, {kRadius, kClimb, kClimb}, {20, wind});
  ASSERT_TRUE(path);
  Route route{from.position};
  for (const Leg& leg : path->legs(from, to.position)) {
    route.push_back(leg);
  }
  Mission mission = mission_for(route);
  mission.request.wind.layers = {{-kInfinity, wind}};
  ASSERT_TRUE(judge(route, mission.request, {}).ok());
  const Exported result = exported(mission, route, options_of("qgc-plan", true));
  ASSERT_TRUE(result.text) << all_of(result);
  EXPECT_NE(all_of(result).find(" turns written as "), std::string::npos) << all_of(result);
  EXPECT_LT(apart(route, read_back(mission, *result.text, "qgc-plan")), kArcTolerance);
}

TEST(ExportTurns, LoitersOfStartAndGoalAreCirclesThatARouteLeavesAndJoins) {
  // From a circle to the left, past a corner, to a circle to the right.
  Route route{Vec3(0, -100, 500)};
  const Route turn = corner(radians(60));
  for (std::size_t i = 0; i < 3; ++i) {
    Leg leg = turn.leg(i);
    const Vec3 shift(500, -100, 0);
    leg.from += shift;
    leg.to += shift;
    route.push_back(leg);
  }
  Mission mission = mission_for(route);
  Request& request = mission.request;
  request.start = {};
  request.start.position = {0, 0, 500};
  request.start.loiter = Loiter{100, 1};
  request.goal = {route.back() + 120 * unit_heading(radians(60 - 90)), 0, {}, Loiter{120, -1}};
  ASSERT_TRUE(judge(route, request, {}).ok());
  for (const char* format : {"qgc-plan", "waypoints"}) {
    const Exported result = exported(mission, route, options_of(format, true));
    ASSERT_TRUE(result.text) << all_of(result);
    EXPECT_NE(all_of(result).find("valid with 7 decimals"), std::string::npos) << all_of(result);
    const formats::MissionFile file = formats::read_mission("r", *result.text);
    EXPECT_EQ(file.items.front().circle, (formats::MissionCircle{Until::altitude, 100, 1, 0}));
    EXPECT_EQ(file.items.back().circle, (formats::MissionCircle{Until::forever, 120, -1, 0}));
    EXPECT_LT(apart(route, read_back(mission, *result.text, format)), 0.05);
  }
  for (const char* format : {"kml", "csv"}) {
    const Exported points = exported(mission, route, options_of(format));
    ASSERT_TRUE(points.text) << all_of(points);
    EXPECT_LT(apart(route, read_back(mission, *points.text, format)), kArcTolerance);
  }
  ExportOptions takeoff = options_of("qgc-plan", true);
  takeoff.takeoff = true;
  takeoff.home_altitude_m = 0;
  EXPECT_THROW(exported(mission, route, takeoff), Error);
}

TEST(ExportTurns, FewerItemsDropNoTurn) {
  Route route{Vec3(-500, 0, 500)};
  for (int i = 4; i >= 0; --i) {
    route.push_back(Vec3(-100 * i, 0, 500));
  }
  route.append(Route(corner(radians(90)).part(1, 3)));
  const Mission mission = mission_for(route);
  EXPECT_EQ(thinned(route, 4, mission.request, {}), (std::vector<std::size_t>{0, 5, 6, 7}));
  EXPECT_EQ(thinned(route, 2, mission.request, {}).size(), 4U);
  ExportOptions options = options_of("qgc-plan", true);
  options.max_items = 4;
  const Exported four = exported(mission, route, options);
  ASSERT_TRUE(four.text) << all_of(four);
  EXPECT_EQ(plan_of(four).items.size(), 4U);
  EXPECT_LT(apart(route, read_back(mission, *four.text, "qgc-plan")), 0.03);
  options.max_items = 3;
  EXPECT_FALSE(exported(mission, route, options).text);
}

TEST(ExportTurns, CirclesNeedCommandsAndOneHeight) {
  EXPECT_EQ(options_of("waypoints", true).problem(), "");
  EXPECT_NE(options_of("kml", true).problem(), "");
  EXPECT_NE(options_of("csv", true).problem(), "");
  ExportOptions options = options_of("qgc-plan", true);
  options.altitude = formats::AltitudeFrame::ground;
  EXPECT_NE(options.problem(), "");
}

/// Dubins airplane paths from pose to pose, with a straight leg now and then.
Route random_route(std::mt19937& random) {
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  Pose here{{uniform(-2e3, 2e3), uniform(-2e3, 2e3), uniform(400, 900)}, uniform(0, 2 * kPi)};
  Route route{here.position};
  const int count = 1 + int(uniform(0, 3));
  for (int i = 0; i < count; ++i) {
    if (uniform(0, 1) < 0.5) {
      here.position += uniform(20, 600) * unit_heading(here.heading);
      route.push_back(here.position);
    }
    const Pose to{{uniform(-2e3, 2e3), uniform(-2e3, 2e3), uniform(400, 900)}, uniform(0, 2 * kPi)};
    const auto path = kit::airplane_path(here, to, {kRadius, kClimb, kClimb});
    for (const Leg& leg : path->legs(here, to.position)) {
      route.push_back(leg);
    }
    here = to;
  }
  here.position += 300 * unit_heading(here.heading);
  route.push_back(here.position);
  return route;
}

TEST(ExportTurns, RandomRoutesComeBackInBothForms) {
  std::mt19937 random(25);
  std::size_t loiters = 0;
  std::size_t turns = 0;
  for (int n = 0; n < 100; ++n) {
    const Route route = random_route(random);
    const Mission mission = mission_for(route);
    ASSERT_TRUE(judge(route, mission.request, {}).ok()) << n;
    for (const bool as_loiters : {false, true}) {
      const Exported result = exported(mission, route, options_of("qgc-plan", as_loiters));
      ASSERT_TRUE(result.text) << n << ": " << all_of(result);
      const Route read = read_back(mission, *result.text, "qgc-plan");
      EXPECT_LT(apart(route, read), kArcTolerance + 0.03) << n << as_loiters << all_of(result);
      for (std::size_t i = 0; i < read.leg_count(); ++i) {
        loiters += read.leg(i).turns() ? 1 : 0;
      }
      for (std::size_t i = 0; i < route.leg_count() && as_loiters; ++i) {
        turns += route.leg(i).turns() ? 1 : 0;
      }
    }
  }
  EXPECT_GT(loiters, turns / 2);  // most turns lead to straight legs
}

}  // namespace
}  // namespace altiplan::host::export_turns_test
