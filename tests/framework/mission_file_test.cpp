// SPDX-License-Identifier: Apache-2.0
// What ground stations wrote, read whole: which files are valid, and what stands in them.
#include "altiplan/formats/mission_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "altiplan/error.hpp"
#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::formats::mission_file_test {
namespace {

using altiplan::testing::TempFolder;
using Kind = MissionItem::Kind;

std::string refusal(const std::string& file) {
  try {
    read_mission(file);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

bool says(const MissionFile& mission, const std::string& part) {
  return std::any_of(mission.notes.begin(), mission.notes.end(),
                     [&](const std::string& note) { return says(note, part); });
}

struct Valid {
  const char* file;
  std::size_t items;
  std::size_t zones;
  const char* note;  ///< a part of one, "" for none at all
};

constexpr Valid kValid[] = {
    {"qgroundcontrol_sample.plan", 4, 0, "1 commands that fly to no position of their own (20)"},
    {"qgroundcontrol_sample_with_survey.plan", 8, 0, "12 commands taken out of survey items"},
    {"qgroundcontrol_sample_with_structured_scan.plan", 0, 0, "1 complex items skipped"},
    {"qgc_SectionTest.plan", 4, 0, "(205)"},
    {"qgc_geofence_home_base.plan", 0, 2, ""},
    {"px4_avoidance.plan", 3, 0, ""},
    {"qgc_MissionPlanner.waypoints", 5, 0, ""},
    {"qgc_MissionPlanner_full.waypoints", 11, 0, "1 commands that fly nowhere skipped (189)"},
    {"dronekit_mpmission.waypoints", 6, 0, ""},
    {"mavproxy_springvalley-foamy-mission-cw.txt", 9, 0, "(177)"},
    {"mavproxy_springvalleybottom-foamy-fence.txt", 0, 1, "1 return points of the fence skipped"},
    {"qgc_PolygonGood.kml", 0, 1, "1 polygons without altitude limits"},
};

TEST(MissionFile, ReadsEveryValidFileOfOthers) {
  ALTIPLAN_DATA_OR_SKIP(folder, "missions");
  for (const Valid& valid : kValid) {
    SCOPED_TRACE(valid.file);
    const std::string file = (folder / valid.file).string();
    ASSERT_EQ(refusal(file), "");
    const MissionFile mission = read_mission(file);
    EXPECT_EQ(mission.items.size(), valid.items);
    EXPECT_EQ(mission.zones.size(), valid.zones);
    EXPECT_EQ(mission.notes.empty(), std::string(valid.note).empty());
    EXPECT_TRUE(std::string(valid.note).empty() || says(mission, valid.note));
  }
}

TEST(MissionFile, RefusesOtherVersionsAndSaysWhichOtherFormatItIs) {
  ALTIPLAN_DATA_OR_SKIP(folder, "missions");
  const std::pair<const char*, const char*> refused[] = {
      {"qgroundcontrol_sample_without_mission.plan", "the key 'mission' is missing"},
      {"qgroundcontrol_sample_wrong_overall_version.plan", "version: expected version 1, found 42"},
      {"qgroundcontrol_sample_wrong_mission_version.plan",
       "mission.version: expected version 2, found 7"},
      {"qgc_OldFileFormat.mission", "in the old format (.mission)"},
      {"mavproxy_springvalley-foamy-fence.txt", "an ArduPilot fence in the old format"},
  };
  for (const auto& [name, words] : refused) {
    const std::string file = (folder / name).string();
    const std::string message = refusal(file);
    EXPECT_TRUE(message.starts_with(file)) << message;
    EXPECT_TRUE(says(message, words)) << message;
  }
}

TEST(MissionFile, TakesKindsFramesAndHomeFromAPlan) {
  ALTIPLAN_DATA_OR_SKIP(folder, "missions");
  const MissionFile plan = read_mission((folder / "qgroundcontrol_sample.plan").string());
  EXPECT_EQ(plan.format, MissionFile::Format::qgc_plan);
  ASSERT_TRUE(plan.home.has_value());
  EXPECT_EQ(plan.home->lat, 47.3977507);
  EXPECT_EQ(plan.home->lon, 8.5456075);
  EXPECT_EQ(plan.home->altitude_m, 488.93101752001763);
  EXPECT_EQ(plan.items[0].kind, Kind::takeoff);
  EXPECT_EQ(plan.items[1].kind, Kind::waypoint);
  EXPECT_EQ(plan.items[1].at.frame, AltitudeFrame::home);
  EXPECT_EQ(plan.items[1].at.lat, 47.39777106);
  EXPECT_EQ(plan.items[1].at.altitude_m, 50);
  EXPECT_EQ(plan.items[2].place, "mission.items.3");
  const MissionFile avoidance = read_mission((folder / "px4_avoidance.plan").string());
  EXPECT_EQ(avoidance.items.back().kind, Kind::land);
  EXPECT_EQ(avoidance.items.back().at.altitude_m, -1);
  const MissionFile old = read_mission((folder / "qgc_SectionTest.plan").string());
  EXPECT_EQ(old.items[1].at.lon, -122.08925023);
  const MissionFile fence = read_mission((folder / "qgc_geofence_home_base.plan").string());
  EXPECT_TRUE(fence.zones[0].keeps_in());
  EXPECT_FALSE(fence.zones[1].keeps_in());
  EXPECT_EQ(fence.zones[0].volumes[0].polygon.outline[1],
            (Point2{-77.49709285710168, 38.75094024382851}));
}

TEST(MissionFile, TakesHomeTakeOffAndFramesFromWaypoints) {
  ALTIPLAN_DATA_OR_SKIP(folder, "missions");
  const MissionFile full = read_mission((folder / "qgc_MissionPlanner_full.waypoints").string());
  ASSERT_TRUE(full.home.has_value());
  EXPECT_EQ(full.home->altitude_m, 1543.079956);
  EXPECT_EQ(full.items.front().kind, Kind::takeoff);  // written at 0, 0: from home
  EXPECT_EQ(full.items.front().at.lon, -105.170967);
  EXPECT_EQ(full.items.front().at.altitude_m, 30);
  EXPECT_EQ(full.items[6].kind, Kind::loiter);
  EXPECT_EQ(full.items.back().kind, Kind::land);
  const MissionFile many = read_mission((folder / "qgc_100Waypoints.waypoints").string());
  EXPECT_GE(many.items.size(), 90U);
  const MissionFile sea = read_mission((folder / "dronekit_mpmission.waypoints").string());
  EXPECT_EQ(sea.items.front().at.frame, AltitudeFrame::sea);
  const MissionFile fence =
      read_mission((folder / "mavproxy_springvalleybottom-foamy-fence.txt").string());
  EXPECT_TRUE(fence.zones[0].keeps_in());
  EXPECT_EQ(fence.zones[0].volumes[0].polygon.outline.size(), 4U);
}

TEST(MissionFile, ALoiterHasACircleIfItsRadiusAndItsTangentialExitAreGiven) {
  using Until = MissionCircle::Until;
  const auto circle = [](const std::string& command_and_params) {
    return read_mission("f.txt",
                        "QGC WPL 110\n0\t0\t3\t" + command_and_params + "\t60.1\t25.2\t100\t1\n")
        .items.front()
        .circle;
  };
  EXPECT_EQ(circle("18\t2\t1\t-80\t1"), (MissionCircle{Until::turns, 80, 1, 2}));
  EXPECT_EQ(circle("31\t1\t80.5\t0\t1"), (MissionCircle{Until::altitude, 80.5, -1, 0}));
  EXPECT_EQ(circle("17\t0\t0\t60\t0"), (MissionCircle{Until::forever, 60, -1, 0}));
  for (const char* without :
       {"18\t2\t1\t-80\t0", "18\t2\t1\t0\t1", "18\t-1\t1\t80\t1", "31\t1\t80\t0\tnan",
        "31\t1\tnan\t0\t1", "19\t30\t1\t80\t1", "16\t0\t0\t80\t1", "17\t0\t0\t1e9\t0"}) {
    EXPECT_FALSE(circle(without)) << without;
  }
}

TEST(MissionFile, ReadsCirclesOfBothFenceForms) {
  const MissionFile wpl =
      read_mission("f.txt",
                   "QGC WPL 110\r\n0\t0\t0\t5003\t120.5\t0\t0\t0\t60.1\t25.2\t0\t0\r\n"
                   "1\t0\t0\t5004\t30\t0\t0\t0\t60.11\t25.21\t0\t0\r\n\r\n");
  ASSERT_EQ(wpl.zones.size(), 2U);
  EXPECT_TRUE(wpl.zones[0].keeps_in());
  EXPECT_EQ(wpl.zones[0].volumes[0].radius_m, 120.5);
  EXPECT_EQ(wpl.zones[0].volumes[0].centre, (Point2{25.2, 60.1}));
  EXPECT_FALSE(wpl.zones[1].keeps_in());
}

TEST(MissionFile, KeepsRallyPoints) {
  const MissionFile wpl = read_mission("f.txt",
                                       "QGC WPL 110\n0\t0\t3\t5100\t0\t0\t0\t0\t60.1\t25.2\t30\t1\n"
                                       "1\t0\t0\t5100\t0\t0\t0\t0\t60.2\t25.3\t200.5\t1\n");
  ASSERT_EQ(wpl.rally.size(), 2U);
  EXPECT_EQ(wpl.rally[0].lat, 60.1);
  EXPECT_EQ(wpl.rally[0].lon, 25.2);
  EXPECT_EQ(wpl.rally[0].altitude_m, 30);
  EXPECT_EQ(wpl.rally[0].frame, AltitudeFrame::home);
  EXPECT_EQ(wpl.rally[1].frame, AltitudeFrame::sea);
  EXPECT_TRUE(wpl.items.empty());
  EXPECT_TRUE(wpl.notes.empty());
  const MissionFile plan = read_mission("f.plan", R"({
"fileType": "Plan", "version": 1, "groundStation": "QGroundControl",
"mission": {"version": 2, "firmwareType": 3, "vehicleType": 2, "cruiseSpeed": 15, "hoverSpeed": 5,
 "plannedHomePosition": [47.4, 8.5, 480], "items": []},
"geoFence": {"version": 2, "polygons": [], "circles": []},
"rallyPoints": {"version": 2, "points": [[47.41, 8.51, 40]]}})");
  ASSERT_EQ(plan.rally.size(), 1U);
  EXPECT_EQ(plan.rally[0].lat, 47.41);
  EXPECT_EQ(plan.rally[0].lon, 8.51);
  EXPECT_EQ(plan.rally[0].altitude_m, 40);
  EXPECT_EQ(plan.rally[0].frame, AltitudeFrame::home);
  EXPECT_TRUE(plan.notes.empty());
}

TEST(MissionFile, ReadsAListOfRallyPoints) {
  ALTIPLAN_DATA_OR_SKIP(folder, "missions");
  const MissionFile list =
      read_mission((folder / "mavproxy_springvalley-foamy-rally.txt").string());
  ASSERT_EQ(list.rally.size(), 1U);
  EXPECT_EQ(list.rally[0].lat, -35.281194);
  EXPECT_EQ(list.rally[0].lon, 149.006725);
  EXPECT_EQ(list.rally[0].altitude_m, 100);
  EXPECT_EQ(list.rally[0].frame, AltitudeFrame::home);
}

std::string kml(const std::string& placemarks) {
  return "<?xml version=\"1.0\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document>\n" +
         placemarks + "</Document></kml>\n";
}

TEST(MissionFile, ReadsKmlLinesPointsAndExtrudedPolygons) {
  const std::string line =
      "<Placemark><LineString><altitudeMode>relativeToGround</altitudeMode>"
      "<coordinates> 25,60,100\n 25.1,60.1,120 </coordinates></LineString></Placemark>\n";
  const std::string polygon =
      "<Folder><Placemark><name>A &amp; B</name><MultiGeometry><Polygon><extrude>1</extrude>"
      "<altitudeMode>absolute</altitudeMode><outerBoundaryIs><LinearRing><coordinates>"
      "25,60,300 26,60,300 26,61,300 25,60,300</coordinates></LinearRing></outerBoundaryIs>"
      "<innerBoundaryIs><LinearRing><coordinates>25.7,60.2,300 25.8,60.2,300 25.8,60.3,300 "
      "25.7,60.2,300</coordinates></LinearRing></innerBoundaryIs>"
      "</Polygon></MultiGeometry></Placemark></Folder>\n";
  const MissionFile both = read_mission("a.kml", kml(line + polygon));
  ASSERT_EQ(both.items.size(), 2U);
  EXPECT_EQ(both.items[1].at.frame, AltitudeFrame::ground);
  EXPECT_EQ(both.items[1].at.altitude_m, 120);
  ASSERT_EQ(both.zones.size(), 1U);
  EXPECT_EQ(both.zones[0].name, "A & B");
  EXPECT_EQ(both.zones[0].volumes[0].upper, ZoneLimit::sea(300));
  EXPECT_EQ(both.zones[0].volumes[0].lower, ZoneLimit{});
  EXPECT_EQ(both.zones[0].restriction, Restriction::unspecified);
  EXPECT_EQ(both.zones[0].volumes[0].polygon.holes.size(), 1U);
  const std::string point =
      "<Placemark><Point><altitudeMode>absolute</altitudeMode><coordinates>25,60,5</coordinates>"
      "</Point></Placemark>";
  const MissionFile points = read_mission("a.kml", kml(point + point));
  EXPECT_EQ(points.items.size(), 2U);
  EXPECT_EQ(points.items[0].at.frame, AltitudeFrame::sea);
  EXPECT_TRUE(says(read_mission("a.kml", kml(line + point)), "1 points beside the LineString"));
  EXPECT_TRUE(says(read_mission("a.kml", kml(line + line)).route_problem, "one LineString"));
}

// Heights that a route lacks are no fault of the zones beside it.
TEST(MissionFile, LeavesPlacesWithoutHeightsToWhoNeedsThem) {
  const std::string flat = "<Placemark><Point><coordinates>25,60</coordinates></Point></Placemark>";
  EXPECT_TRUE(says(read_mission("a.kml", kml(flat)).route_problem, "heights"));
  const std::string gpx = "<gpx><rte><rtept lat=\"60\" lon=\"25\"/></rte></gpx>";
  EXPECT_TRUE(says(read_mission("a.gpx", gpx).route_problem, "an ele in each point"));
}

TEST(MissionFile, ReadsTheFirstOfGpxRoutesAndTracks) {
  const std::string track =
      "<trk><trkseg><trkpt lat=\"60\" lon=\"25\"><ele>10.5</ele></trkpt>"
      "<trkpt lat=\"60.1\" lon=\"25.1\"><ele>11</ele></trkpt></trkseg></trk>";
  const MissionFile mission = read_mission("a.gpx", "<gpx>" + track + "</gpx>");
  ASSERT_EQ(mission.items.size(), 2U);
  EXPECT_EQ(mission.items[0].at.altitude_m, 10.5);
  EXPECT_TRUE(
      says(read_mission("a.gpx", "<gpx>" + track + track + "</gpx>").route_problem, "found 2"));
}

TEST(MissionFile, NeverReadsMoreThanItsCap) {
  const TempFolder folder;
  const auto file = folder / "huge.waypoints";
  {
    std::ofstream out(file, std::ios::binary);
    out.seekp(64'000'001);
    out << 'x';
  }
  EXPECT_TRUE(says(refusal(file.string()), "is larger than 64 MB"));
  EXPECT_TRUE(says(refusal("/dev/zero"), "is a device, expected a file"));
  EXPECT_TRUE(says(refusal((folder / "none.plan").string()), "there is no such file"));
  EXPECT_TRUE(says(refusal(folder.write("empty.plan", " \n").string()), "is empty"));
}
}  // namespace
}  // namespace altiplan::formats::mission_file_test
