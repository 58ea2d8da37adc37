// SPDX-License-Identifier: Apache-2.0
// What is exported, read back by our own reader and judged again; what cannot be said is.
#include "host/import_export/export.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "altiplan/error.hpp"
#include "host/import_export/imported_route.hpp"
#include "host/import_export/thinning.hpp"
#include "host/judge/judge.hpp"
#include "support/files.hpp"
#include "support/folders.hpp"
#include "support/support.hpp"

namespace altiplan::host::export_test {
namespace {

using formats::AltitudeFrame;
using formats::MissionItem;
using formats::Zone;

/// Level ground at 120 m.
class Plain final : public Environment, public Ground {
  Box do_bounds() const override { return {}; }
  double do_clearance(const Vec3& p) const override { return p.z() - 120; }
  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double, double) const override { return 120; }
  double do_gap(const Vec3& a, const Vec3& b, double) const override {
    return std::min(a.z(), b.z()) - 120;
  }
  double do_gap_max(const Vec3& a, const Vec3& b) const override {
    return std::max(a.z(), b.z()) - 120;
  }
  double do_slope(const Box&) const override { return 0; }
};

/// A circle with a ceiling, a square with a hole, a keep-in square around all.
constexpr const char* kZones =
    "{list: [{id: site, cylinder: {at_m: [500, 500], radius_m: 100}, ceiling_m: 400},"
    " {id: yard, polygon: {outline_m: [[700, 100], [900, 100], [900, 300], [700, 300]],"
    "   holes_m: [[[750, 150], [850, 150], [850, 250], [750, 250]]]}},"
    " {id: county, kind: keep_in, polygon: {outline_m: [[-9, -9], [1009, -9], [1009, 1009],"
    "   [-9, 1009]]}}]}";

const Polyline kAround{
    {50, 50, 300}, {350, 600, 310.12345}, {500, 650, 320}, {700, 700, 320.5}, {950, 950, 300}};

struct Scene {
  Mission mission;
  explicit Scene(const Polyline& route = kAround, bool positioned = true,
                 const char* zones = kZones) {
    World world;
    if (positioned) {
      world = world.with_frame(Frame::geographic(-84.3, 36.5, 36.6));
    }
    mission.truth = world.with({"ground", "plain", std::make_shared<Plain>(), true});
    if (zones != nullptr) {
      Site site;
      site.frame = world.frame();
      site.before = &mission.truth;
      mission.truth = mission.truth.with(
          {"zones", "zones", altiplan::testing::make_environment("zones", zones, site), true});
    }
    mission.known = mission.truth;
    mission.request = altiplan::testing::request_in(mission.known, route.front(), route.back(),
                                                    {{-9, -9, 0}, {1009, 1009, 1000}});
    mission.request.goal.tolerance_m = 1;
    mission.track_request = mission.request;
  }
};

ExportOptions options_of(const char* format, AltitudeFrame altitude = AltitudeFrame::sea) {
  ExportOptions options;
  options.format = &format_named(format);
  options.altitude = altitude;
  return options;
}

Exported exported(const Scene& scene, const ExportOptions& options,
                  const Polyline& route = kAround) {
  return export_route(scene.mission, {"a <name> & more", route, {}, {}}, options);
}

bool says(const Exported& exported, const std::string& words) {
  return std::any_of(exported.messages.begin(), exported.messages.end(),
                     [&](const std::string& m) { return m.find(words) != std::string::npos; });
}

/// Metres between what was written and what it stands for.
double farthest(const Polyline& a, const Polyline& b) {
  EXPECT_EQ(a.size(), b.size());
  double most = 0;
  for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n) {
    most = std::max(most, (a[n] - b[n]).norm());
  }
  return most;
}

TEST(Export, WhatIsReadBackIsTheRouteInEveryFormatAndFrame) {
  const Scene scene;
  int written = 0;
  for (const RouteFormat& format : route_formats()) {
    const std::string file = std::string("r") + format.extension;
    for (const auto frame : {AltitudeFrame::sea, AltitudeFrame::ground, AltitudeFrame::home}) {
      const ExportOptions options = options_of(format.name, frame);
      if (!options.problem().empty()) {
        continue;
      }
      SCOPED_TRACE(std::string(format.name) + " " + name(frame));
      const Exported result = exported(scene, options);
      ASSERT_TRUE(result.text.has_value());
      EXPECT_TRUE(says(result, "read back and judged: valid with 7 decimals"));
      EXPECT_TRUE(says(result, frame == AltitudeFrame::sea ? "above sea level"
                               : frame == AltitudeFrame::ground
                                   ? "above the ground"
                                   : "relative to home, which is 120 m"));
      EXPECT_EQ(says(result, "warning: judged with straight legs"), frame == AltitudeFrame::ground);
      const ImportedRoute back =
          read_imported_route(file, *result.text, scene.mission.truth, scene.mission.request,
                              result.mission.mission.home);
      EXPECT_EQ(back.route.front(), kAround.front());
      EXPECT_LT(farthest(back.route.waypoints(), kAround), 0.01);
      EXPECT_GT(farthest(back.route.waypoints(), kAround), 0);
      EXPECT_TRUE(judge(back.route, scene.mission.request, {}).ok());
      ++written;
    }
  }
  EXPECT_EQ(written, 21);
}

TEST(Export, HeightsOfAPlanAreInTheFrameThatItNames) {
  const Scene scene;
  for (const auto& [frame, numbers] : {std::pair(AltitudeFrame::sea, std::array{0, 2, 310}),
                                       std::pair(AltitudeFrame::ground, std::array{10, 4, 190}),
                                       std::pair(AltitudeFrame::home, std::array{3, 1, 190})}) {
    const Json plan = Json::parse(*exported(scene, options_of("qgc-plan", frame)).text);
    const Json& item = plan.at("mission").at("items").at(1);
    EXPECT_EQ(item.at("frame"), numbers[0]);
    EXPECT_EQ(item.at("AltitudeMode"), numbers[1]);
    EXPECT_EQ(item.at("Altitude"), numbers[2] + 0.123);
    EXPECT_EQ(item.at("params").at(6), item.at("Altitude"));
    EXPECT_EQ(plan.at("mission").at("plannedHomePosition").at(2), 120);
  }
}

TEST(Export, MoreDecimalsWhereFewerBreakTheRoute) {
  Scene scene;
  scene.mission.request.goal.tolerance_m = 0;
  const Exported result = exported(scene, options_of("kml"));
  ASSERT_TRUE(result.text.has_value());
  EXPECT_TRUE(says(result, "valid with 13 decimals of a degree and 8 of a metre (with fewer: "));
}

TEST(Export, WritesNothingThatIsNotSound) {
  const Scene scene;
  const Polyline through{{50, 50, 300}, {500, 500, 300}, {950, 950, 300}};
  const Exported result = exported(scene, options_of("qgc-plan"), through);
  EXPECT_FALSE(result.text.has_value());
  EXPECT_TRUE(says(result, "not written: the route is not valid: point 0, clearance"));
}

TEST(Export, AFenceHoldsTheZonesAndSaysWhatItCannot) {
  const Scene scene;
  const Exported result = exported(scene, options_of("qgc-plan"));
  EXPECT_TRUE(says(result, "zone 'site' is in the fence at every height"));
  EXPECT_TRUE(says(result, "zone 'yard' is in the fence without its holes"));
  const formats::MissionFile plan = formats::read_mission("r.plan", *result.text);
  ASSERT_EQ(plan.zones.size(), 3U);
  EXPECT_EQ(std::count_if(plan.zones.begin(), plan.zones.end(),
                          [](const Zone& zone) { return zone.keeps_in(); }),
            1);
  EXPECT_EQ(plan.zones.front().name, "yard");
  EXPECT_EQ(plan.zones.back().name, "site");
  const formats::ZoneVolume& circle =
      plan.zones.back().volumes.at(0);  // circles come after polygons
  EXPECT_GE(circle.radius_m, 100);      // in true metres: the frame is exact at another latitude
  EXPECT_LT(circle.radius_m, 100.2);
  const auto centre = scene.mission.truth.frame().to_local(circle.centre[0], circle.centre[1]);
  EXPECT_NEAR(centre[0], 500, 0.01);
  EXPECT_NEAR(centre[1], 500, 0.01);
}

// A fence without heights would stop a vehicle that flies over the zone, as it was planned to.
TEST(Export, AZoneThatTheRouteFliesOverStaysOutOfTheFence) {
  const Polyline over{{50, 50, 500}, {950, 950, 500}};
  const Scene scene(over);
  const Exported result = exported(scene, options_of("qgc-plan"), over);
  ASSERT_TRUE(result.text.has_value());
  EXPECT_TRUE(
      says(result, "zone 'site' is left out of the fence: the route passes above or below it"));
  EXPECT_EQ(formats::read_mission("r.plan", *result.text).zones.size(), 2U);
}

TEST(Export, KmlAndItsReaderKeepLimitsRolesAndHoles) {
  const Scene scene;
  const Exported result = exported(scene, options_of("kml"));
  const formats::MissionFile map = formats::read_mission("r.kml", *result.text);
  ASSERT_EQ(map.zones.size(), 3U);
  EXPECT_EQ(map.zones[0].name, "site");
  EXPECT_EQ(map.zones[0].volumes.at(0).upper, formats::ZoneLimit::sea(400));
  EXPECT_EQ(map.zones[0].volumes.at(0).polygon.outline.size(), 64U);
  EXPECT_EQ(map.zones[1].volumes.at(0).polygon.holes.size(), 1U);
  EXPECT_TRUE(map.zones[2].keeps_in());
}

/// A route of many points, as a text of WPML has it.
MissionText long_text(std::size_t points) {
  MissionText text;
  text.mission.home = formats::MissionPoint{8, 47, 400};
  for (std::size_t n = 0; n < points; ++n) {
    text.mission.items.push_back(
        {MissionItem::Kind::waypoint, {8 + 1e-6 * double(n), 47, 50, AltitudeFrame::home}, 0, ""});
  }
  return text;
}

TEST(Export, WpmlIsSplitAtItsLimitAndReadsBackWhole) {
  const RouteFormat& wpml = format_named("wpml");
  for (const std::size_t points : {2, 65'537}) {
    const MissionText text = long_text(points);
    const formats::MissionFile read = wpml.read("r.kmz", wpml.write(text));
    ASSERT_EQ(read.items.size(), points);
    EXPECT_EQ(read.route_problem, "");
    for (const std::size_t n : {std::size_t(0), points / 2, points - 1}) {
      EXPECT_NEAR(read.items[n].at.lon, text.mission.items[n].at.lon, 1e-7);
      EXPECT_EQ(read.items[n].at.frame, AltitudeFrame::home);
    }
    EXPECT_NEAR(read.home.value().altitude_m, 400, 0.01);
    EXPECT_EQ(wpml.notes(text).size(), points > 65'536 ? 3U : 2U);
  }
}

TEST(Export, TheDocumentationListsTheTableOfFormats) {
  const std::string page =
      altiplan::testing::text_of(folders::source() / "docs" / "reference" / "route-formats.md");
  for (const RouteFormat& format : route_formats()) {
    std::string frames;
    for (const AltitudeFrame frame : format.frames) {
      frames += (frames.empty() ? "" : ", ") + std::string(name(frame));
    }
    const char* zones = format.zones == RouteFormat::Zones::fence    ? "as fence"
                        : format.zones == RouteFormat::Zones::solids ? "yes"
                                                                     : "no";
    const std::string row = std::string("| `") + format.name + "` | `" + format.extension + "` | " +
                            format.description + " | " + zones + " | " + frames + " |";
    EXPECT_NE(page.find(row), std::string::npos) << row;
  }
}

TEST(Export, FormatsWithoutAPlaceForZonesSaySo) {
  const Scene scene;
  for (const char* format : {"waypoints", "gpx"}) {
    EXPECT_TRUE(says(exported(scene, options_of(format)), "3 zones are not written"));
  }
}

TEST(Export, TakeOffAndLandingAreCommandsAndTheRouteStaysTheSame) {
  const Scene scene;
  for (const auto frame : {AltitudeFrame::sea, AltitudeFrame::ground, AltitudeFrame::home}) {
    for (const auto& [format, file] :
         {std::pair("qgc-plan", "r.plan"), std::pair("waypoints", "r.waypoints")}) {
      ExportOptions options = options_of(format, frame);
      options.takeoff = options.land = true;
      const Exported result = exported(scene, options);
      ASSERT_TRUE(result.text.has_value());
      const formats::MissionFile read = formats::read_mission(file, *result.text);
      ASSERT_EQ(read.items.size(), kAround.size() + 1);
      EXPECT_EQ(read.items.front().kind, MissionItem::Kind::takeoff);
      EXPECT_EQ(read.items.back().kind, MissionItem::Kind::land);
      EXPECT_EQ(read.items.back().at.altitude_m, frame == AltitudeFrame::sea ? 120 : 0);
      EXPECT_EQ(read.items.back().at.lat, read.items[kAround.size() - 1].at.lat);
      EXPECT_EQ(read_imported_route(file, *result.text, scene.mission.truth, scene.mission.request)
                    .route.size(),
                kAround.size());
    }
  }
}

TEST(Export, FewerItemsOnlyWhileTheRouteStaysSound) {
  Polyline dense;
  for (std::size_t n = 0; n + 1 < kAround.size(); ++n) {
    for (int k = 0; k < 10; ++k) {
      dense.push_back(kAround[n] + (kAround[n + 1] - kAround[n]) * (k / 10.0));
    }
  }
  dense.push_back(kAround.back());
  const Scene scene(dense);
  ExportOptions options = options_of("waypoints");
  options.max_items = 6;
  const Exported six = exported(scene, options, dense);
  ASSERT_TRUE(six.text.has_value());
  EXPECT_TRUE(says(six, "35 of 41 points dropped"));
  EXPECT_EQ(formats::read_mission("r.waypoints", *six.text).items.size(), 6U);
  options.land = true;
  EXPECT_EQ(
      formats::read_mission("r.waypoints", *exported(scene, options, dense).text).items.size(), 6U);
  options.land = false;
  options.max_items = 2;  // straight through the site
  const Exported two = exported(scene, options, dense);
  EXPECT_FALSE(two.text.has_value());
  EXPECT_TRUE(says(two, "not written: the route needs 3 items to stay valid"));
}

TEST(Export, MoreItemsThanAutopilotsStoreAreWarnedOf) {
  const Vec3& start = kAround.front();
  const Vec3& goal = kAround[1];
  for (const int points : {500, 501}) {
    Polyline dense;
    for (int n = 0; n < points; ++n) {
      dense.push_back(start + (goal - start) * (n / (points - 1.0)));
    }
    const Scene scene(dense);
    for (const char* format : {"waypoints", "kml"}) {
      const Exported result = exported(scene, options_of(format), dense);
      ASSERT_TRUE(result.text.has_value());
      EXPECT_EQ(says(result, "warning: 501 items: PX4 stores 500"),
                points == 501 && std::string(format) == "waypoints");
    }
  }
}

TEST(Export, ThinningKeepsEndsAndViaPoints) {
  const Scene scene(kAround, true, nullptr);
  EXPECT_EQ(thinned(kAround, 2, scene.mission.request, {}), (std::vector<std::size_t>{0, 4}));
  EXPECT_EQ(thinned(kAround, 2, scene.mission.request, {2}), (std::vector<std::size_t>{0, 2, 4}));
  EXPECT_EQ(thinned(kAround, 9, scene.mission.request, {}).size(), kAround.size());
}

TEST(Export, SaysHowFarAutopilotsFlyBesideLongLegs) {
  // 60 km along 36.5° N in a frame of longitude and latitude: L² tan(lat) / 8R = 52.3 m.
  const auto notes_of = [](double length, const char* format) {
    const Polyline route{{50, 50, 300}, {50 + length, 50, 300}};
    Scene scene(route, true, nullptr);
    scene.mission.request.volume.max.x() = scene.mission.track_request.volume.max.x() = 1e5;
    const Exported exported =
        export_route(scene.mission, ExportSource{"x", route, {}, {}}, options_of(format));
    std::string all;
    for (const std::string& message : exported.messages) {
      all += message + '\n';
    }
    return all;
  };
  EXPECT_NE(notes_of(60'000, "qgc-plan")
                .find("PX4 flies up to 52.3 m beside the line that was "
                      "judged, ArduPilot 0.0 m"),
            std::string::npos)
      << notes_of(60'000, "qgc-plan");
  EXPECT_EQ(notes_of(60'000, "kml").find("beside the line"), std::string::npos);
  EXPECT_EQ(notes_of(5'000, "qgc-plan").find("beside the line"), std::string::npos);
}

TEST(Export, AFlightIsJudgedAsATrackWithItsTimes) {
  Scene scene;
  scene.mission.track_request.vehicle.speed_mps = 20;
  ExportSource source{"flight", kAround, {0, 40, 60, 80, 120}, {}};
  const Exported csv = export_route(scene.mission, source, options_of("csv"));
  ASSERT_TRUE(csv.text.has_value());
  EXPECT_TRUE(csv.text->starts_with("time_s,x_m,y_m,z_m,longitude_deg,latitude_deg,altitude_m,"));
  source.times = {0, 4, 6, 8, 12};
  const Exported fast = export_route(scene.mission, source, options_of("csv"));
  EXPECT_FALSE(fast.text.has_value());
  EXPECT_TRUE(says(fast, "speed"));
}

TEST(Export, SaysWhatTheWorldLacks) {
  const Scene nowhere(kAround, false, nullptr);
  EXPECT_THROW(exported(nowhere, options_of("kml")), Error);
  const Exported csv = exported(nowhere, options_of("csv", AltitudeFrame::home));
  ASSERT_TRUE(csv.text.has_value());
  EXPECT_TRUE(csv.text->starts_with(
      "time_s,x_m,y_m,z_m,altitude_m,altitude_frame\n0,50,50,300,180,home\n"));
  Scene groundless(kAround, true, nullptr);
  groundless.mission.truth = groundless.mission.truth.without("ground");
  EXPECT_THROW(exported(groundless, options_of("kml", AltitudeFrame::ground)), Error);
  ExportOptions land = options_of("qgc-plan");
  land.land = true;
  EXPECT_THROW(exported(groundless, land), Error);
  // A height that nobody gave is not made up: it would be flown.
  EXPECT_THROW(exported(groundless, options_of("qgc-plan", AltitudeFrame::home)), Error);
  EXPECT_TRUE(says(exported(groundless, options_of("qgc-plan")),
                   "home is written at the start's own height"));
  ExportOptions home = options_of("qgc-plan", AltitudeFrame::home);
  home.takeoff = home.land = true;
  home.home_altitude_m = 80;
  const Exported with_home = exported(groundless, home);
  EXPECT_TRUE(says(with_home, "relative to home, which is 80 m"));
  const formats::MissionFile file = formats::read_mission("a.plan", with_home.text.value());
  EXPECT_EQ(file.items.front().at.altitude_m, 220);
  EXPECT_EQ(file.items.back().at.altitude_m, 0);
  home.home_altitude_m = 300;
  EXPECT_THROW(exported(groundless, home), Error);
}

TEST(Export, TheWaysUpAndDownAreJudgedToo) {
  const char* below_start =
      "{list: [{id: roof, cylinder: {at_m: [50, 50], radius_m: 20},"
      " ceiling_m: 200}]}";
  const char* below_goal =
      "{list: [{id: roof, cylinder: {at_m: [950, 950], radius_m: 20},"
      " ceiling_m: 200}]}";
  for (const bool start : {true, false}) {
    const Scene scene(kAround, true, start ? below_start : below_goal);
    ExportOptions options = options_of("qgc-plan");
    EXPECT_TRUE(exported(scene, options).text.has_value());
    (start ? options.land : options.takeoff) = true;
    EXPECT_TRUE(exported(scene, options).text.has_value());
    (start ? options.takeoff : options.land) = true;
    const Exported refused = exported(scene, options);
    EXPECT_FALSE(refused.text.has_value());
    EXPECT_TRUE(says(refused, "passes too close to 'zones'"));
  }
}

TEST(Export, OptionsThatDoNotGoTogether) {
  EXPECT_EQ(options_of("qgc-plan", AltitudeFrame::home).problem(), "");
  EXPECT_NE(options_of("gpx", AltitudeFrame::ground).problem(), "");
  EXPECT_NE(options_of("kml", AltitudeFrame::home).problem(), "");
  for (const auto format : {"kml", "gpx", "geojson"}) {
    ExportOptions options = options_of(format);
    options.takeoff = true;
    EXPECT_NE(options.problem(), "");
  }
}

TEST(ImportedRoute, FramesAreResolvedInTheWorld) {
  const Scene scene;
  const World& world = scene.mission.truth;
  const std::optional<formats::MissionPoint> home = formats::MissionPoint{-84.3, 36.5, 55};
  EXPECT_EQ(to_local({-84.3, 36.5, 7, AltitudeFrame::sea}, home, world).z(), 7);
  EXPECT_EQ(to_local({-84.3, 36.5, 7, AltitudeFrame::ground}, home, world).z(), 127);
  EXPECT_EQ(to_local({-84.3, 36.5, 7, AltitudeFrame::home}, home, world).z(), 62);
  EXPECT_THROW(to_local({-84.3, 36.5, 7, AltitudeFrame::home}, {}, world), Error);
  EXPECT_THROW(to_local({-84.3, 36.5, 7, AltitudeFrame::ground}, home, World()), Error);
}

TEST(ImportedRoute, PapersListWhatLiesBetweenTheEnds) {
  Request request;
  request.start.position = {0, 0, 5};
  request.goal.position = {9, 9, 6};
  const ImportedRoute read =
      read_imported_route("r.csv", "x,y,z\n1,2,3\n4,5,6\n", World(), request);
  EXPECT_EQ(read.route, Route({{0, 0, 5}, {1, 2, 3}, {4, 5, 6}, {9, 9, 6}}));
  // With metres beside them those are the route.
  EXPECT_EQ(
      read_imported_route("r.csv", "x,y,z,x_m,y_m,z_m\n1,2,3,4,5,6\n", World(), request).route,
      Route({{4, 5, 6}}));
}

TEST(ImportedRoute, RefusesTablesWithTheLine) {
  const auto refusal = [](const std::string& text) {
    try {
      read_imported_route("r.csv", text, World(), {});
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string head = "z_m,x_m,y_m,note\n";
  EXPECT_EQ(refusal(head + "3,1,2,a\r\n\r\n4,1,2,b\r\n"), "");
  const std::pair<std::string, const char*> damaged[] = {
      {"", "r.csv: it contains no route"},
      {head, "r.csv: it contains no route"},
      {"x_m,y_m\n1,2\n", "r.csv:1: expected a first line that names the columns x_m, y_m and z_m"},
      {head + "1,2,3\n", "r.csv:2: expected 4 columns, found 3"},
      {head + "1,2,3,a\n1,2,b,a\n", "r.csv:3: expected a number of metres, found 'b'"},
      {head + "1,nan,3,a\n", "r.csv:2: expected a number of metres, found 'nan'"},
      {head + "1,1e999,3,a\n", "r.csv:2: expected a number of metres"},
      {head + "1,,3,a\n", "r.csv:2: expected a number of metres, found ''"},
      {std::string("\0\0\n", 3), "r.csv:1: expected a first line"}};
  for (const auto& [text, words] : damaged) {
    EXPECT_NE(refusal(text).find(words), std::string::npos) << refusal(text);
  }
}
}  // namespace
}  // namespace altiplan::host::export_test
