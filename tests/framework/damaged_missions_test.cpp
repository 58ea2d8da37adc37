// SPDX-License-Identifier: Apache-2.0
// Mission files with one thing wrong: one error each, naming the file, the place and what was
// expected.
#include <gtest/gtest.h>

#include "altiplan/error.hpp"
#include "altiplan/formats/mission_file.hpp"
#include "support/files.hpp"

namespace altiplan::formats::damaged_missions_test {
namespace {

using altiplan::testing::replaced;

const std::string kPlan = R"({"fileType": "Plan", "version": 1, "groundStation": "QGC",
"mission": {"version": 2, "firmwareType": 12, "vehicleType": 2, "cruiseSpeed": 15, "hoverSpeed": 5,
 "plannedHomePosition": [47.4, 8.5, 488],
 "items": [{"type": "SimpleItem", "autoContinue": true, "command": 16, "doJumpId": 1, "frame": 3,
   "params": [0, 0, 0, null, 47.5, 8.6, 50]},
  {"type": "ComplexItem", "complexItemType": "survey",
   "TransectStyleComplexItem": {"Items": []}}]},
"geoFence": {"version": 2,
 "polygons": [{"version": 1, "inclusion": true, "polygon": [[47, 8], [48, 8], [48, 9]]}],
 "circles": [{"version": 1, "inclusion": false, "circle": {"center": [47.1, 8.1], "radius": 90}}]},
"rallyPoints": {"version": 2, "points": []}}
)";
const std::string kWaypoints =
    "QGC WPL 110\n"
    "0\t1\t0\t16\t0\t0\t0\t0\t47.4\t8.5\t488\t1\n"
    "1\t0\t3\t22\t0\t0\t0\tnan\t47.41\t8.51\t30\t1\n"
    "2\t0\t3\t16\t0\t0\t0\t0\t47.42\t8.52\t50\t1\n";
const std::string kFence =
    "QGC WPL 110\n"
    "0\t0\t0\t5002\t3\t0\t0\t0\t47.4\t8.4\t0\t1\n"
    "1\t0\t0\t5002\t3\t0\t0\t0\t47.5\t8.4\t0\t1\n"
    "2\t0\t0\t5002\t3\t0\t0\t0\t47.5\t8.5\t0\t1\n"
    "3\t0\t0\t5003\t77\t0\t0\t0\t47.6\t8.6\t0\t1\n";
const std::string kKml =
    "<?xml version=\"1.0\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n"
    "<Placemark><LineString><altitudeMode>absolute</altitudeMode>\n"
    "<coordinates>8.5,47.4,500 8.6,47.5,510</coordinates></LineString></Placemark>\n"
    "<Placemark><ExtendedData><Data name=\"role\"><value>keep_out</value></Data>"
    "<Data name=\"floor_m\"><value>50</value></Data></ExtendedData>\n"
    "<Polygon><outerBoundaryIs><LinearRing><coordinates>\n"
    "8,47 9,47 9,48 8,47\n</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark>\n"
    "</Document></kml>\n";
const std::string kGpx =
    "<?xml version=\"1.0\"?>\n<gpx version=\"1.1\"><rte>\n"
    "<rtept lat=\"47.4\" lon=\"8.5\"><ele>500</ele></rtept>\n"
    "<rtept lat=\"47.5\" lon=\"8.6\"><ele>510</ele></rtept>\n</rte></gpx>\n";
const std::string kGeoJson =
    R"({"type": "FeatureCollection", "features": [{"type": "Feature",
"properties": {"altitude_frame": "home", "home": [8.5, 47.4, 400]},
"geometry": {"type": "LineString", "coordinates": [[8.5, 47.4, 10], [8.6, 47.5, 20]]}}]}
)";

struct Damage {
  const char* before;  ///< what is replaced; "*": all of it
  std::string after;
  const char* says;
};

void expect_refused(const std::string& file, const std::string& valid,
                    const std::vector<Damage>& all) {
  ASSERT_NO_THROW(read_mission(file, valid));
  for (const Damage& damage : all) {
    const std::string text = std::string(damage.before) == "*"
                                 ? damage.after
                                 : replaced(valid, damage.before, damage.after);
    try {
      const MissionFile mission = read_mission(file, text);
      if (!mission.route_problem.empty()) {  // its commands are judged, but it is no route
        throw Error(file + ": " + mission.route_problem);
      }
      ADD_FAILURE() << file << ": accepted: " << damage.before << " -> "
                    << damage.after.substr(0, 60);
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with(file + ":")) << message;
      EXPECT_NE(message.find(damage.says), std::string::npos)
          << message << "\n  expected: " << damage.says;
      EXPECT_LT(message.size(), 400U) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
}

TEST(DamagedMissions, Plans) {
  const std::string deep(1'000'000, '[');
  expect_refused(
      "m.plan", kPlan,
      {{"*", kPlan.substr(0, kPlan.size() / 2),
        ": is not valid JSON: it ends early or has an error here"},
       {"*", kPlan.substr(0, 1), "m.plan:1:2: is not valid JSON"},
       {"*", "{\n \"ä\": 1, ?}", "m.plan:2:10: is not valid JSON"},
       {"*", "{\"a\": 1,\n\"a\": 2}", "m.plan:2:4: the key \"a\" is given twice"},
       {"*", kPlan + "}", "is not valid JSON"},
       {"*", "[1, 2]", "expected a plan (\"fileType\": \"Plan\"), found [1,2]"},
       {"*", deep, "nested more than 64 levels deep"},
       {"*", R"({"items": [], "groundStation": "QGC"})", "in the old format"},
       {"\"Plan\"", "\"Mission\"", "fileType: expected \"Plan\", found \"Mission\""},
       {"\"Plan\"", "7", "fileType: expected text, found 7"},
       {"\"version\": 1, \"groundStation\"", "\"version\": 2, \"groundStation\"",
        "version: expected version 1, found 2"},
       {"\"version\": 1, \"groundStation\"", "\"version\": 1.5, \"groundStation\"",
        "version: expected a whole number"},
       {"\"groundStation\": \"QGC\",", "", "the key 'groundStation' is missing"},
       {"\"mission\": {\"version\": 2", "\"mission\": {\"version\": \"2\"",
        "mission.version: expected"},
       {"\"cruiseSpeed\": 15,", "", "mission: the key 'cruiseSpeed' is missing"},
       {"\"hoverSpeed\": 5", "\"hoverSpeed\": \"fast\"", "mission.hoverSpeed: expected a number"},
       {"\"vehicleType\": 2", "\"vehicleType\": -1",
        "mission.vehicleType: expected a whole number"},
       {"[47.4, 8.5, 488]", "[47.4, 8.5]",
        "plannedHomePosition: expected [latitude, longitude, alt"},
       {"[47.4, 8.5, 488]", "[120.4, 8.5, 488]", "are the axes swapped?"},
       {"[47.4, 8.5, 488]", "[47.4, 8.5, 1e9]", "within 100 km of its reference, found 1e+09"},
       {"[47.4, 8.5, 488]", "null", "plannedHomePosition: expected a list, found null"},
       {"\"items\": [{", "\"items\": {\"a\": [{", "is not valid JSON"},
       {"\"SimpleItem\"", "\"Item\"", "mission.items.0.type: expected SimpleItem or ComplexItem"},
       {"\"type\": \"SimpleItem\",", "", "mission.items.0: the key 'type' is missing"},
       {"\"autoContinue\": true", "\"autoContinue\": 1", "autoContinue: expected true or false"},
       {"\"command\": 16", "\"command\": \"waypoint\"",
        "mission.items.0.command: expected a whole"},
       {"\"command\": 16", "\"command\": 1e300", "mission.items.0.command: expected a whole"},
       {"\"frame\": 3", "\"frame\": 2", "expected the frame 0 (sea level), 3 (relative to home)"},
       {"\"frame\": 3", "\"frame\": -3", "mission.items.0.frame: expected a whole number"},
       {"null, 47.5, 8.6, 50]", "null, 47.5, 8.6]", "params: expected a list of 7 numbers"},
       {"null, 47.5, 8.6, 50]", "null, 95, 8.6, 50]", "found longitude 8.6 and latitude 95"},
       {"null, 47.5, 8.6, 50]", "null, 47.5, 181, 50]", "found longitude 181"},
       {"null, 47.5, 8.6, 50]", "null, 147.5, 8.6, 50]", "are the axes swapped?"},
       {"null, 47.5, 8.6, 50]", "null, null, null, 50]", "a waypoint needs a position"},
       {"null, 47.5, 8.6, 50]", "null, 0, 0, 50]", "a waypoint needs a position"},
       {"null, 47.5, 8.6, 50]", "null, 47.5, null, 50]", "found longitude nan"},
       {"null, 47.5, 8.6, 50]", "null, 47.5, 8.6, null]", "an altitude within 100 km"},
       {"null, 47.5, 8.6, 50]", "null, 47.5, 8.6, 1e300]", "an altitude within 100 km"},
       {"null, 47.5, 8.6, 50]", "null, 47.5, 8.6, 1e400]", "a number that is too large"},
       {"null, 47.5, 8.6, 50]", "null, \"47.5\", 8.6, 50]", "params.4: expected a number"},
       {"null, 47.5, 8.6, 50]", "null, NaN, 8.6, 50]", "is not valid JSON"},
       {"\"complexItemType\": \"survey\"", "\"complexItemType\": 3",
        "complexItemType: expected text"},
       {"{\"Items\": []}", "{\"Items\": [{\"command\": 16}]}",
        "Items.0: the key 'params' is missing"},
       {"\"geoFence\": {\"version\": 2", "\"geoFence\": {\"version\": 3",
        "geoFence.version: expected"},
       {"\"inclusion\": true", "\"inclusion\": \"yes\"", "inclusion: expected true or false"},
       {"[48, 8], [48, 9]]", "[48, 8]]", "expected three corners or more"},
       {"[48, 8], [48, 9]]", "[48, 9], [48, 8], [47, 9]]", "meets itself at"},
       {"[48, 8], [48, 9]]", "[48, 8], [148, 9]]", "are the axes swapped?"},
       {"[48, 8], [48, 9]]", "[48, 8], null]", "polygon.2: expected a list, found null"},
       {"\"radius\": 90", "\"radius\": -90", "expected a radius above 0 m, found -90"},
       {"\"radius\": 90", "\"radius\": 1e300", "expected a radius"},
       {"\"center\": [47.1, 8.1], ", "", "circles.0.circle: the key 'center' is missing"},
       {"\"points\": []", "\"points\": 3", "rallyPoints.points: expected a list, found 3"},
       {"\"points\": []", "\"points\": [[47.4, 8.5]]",
        "rallyPoints.points.0: expected [latitude, longitude, altitude]"},
       {"\"points\": []", "\"points\": [[147.4, 8.5, 9]]", "rallyPoints.points.0: expected"},
       {"\"points\": []", "\"points\": [[47.4, 8.5, 1e9]]", "rallyPoints.points.0: "}});
}

TEST(DamagedMissions, Waypoints) {
  expect_refused(
      "m.waypoints", kWaypoints,
      {{"110", "120", "m.waypoints:1: expected QGC WPL 110, found version '120'"},
       {"QGC WPL 110", "QGC", "m.waypoints:1: expected QGC WPL 110, JSON or XML, found 'QGC'"},
       {"*", "QGC WPL 110\n", "contains no mission items"},
       {"*", kWaypoints.substr(0, kWaypoints.size() - 20), "m.waypoints:4: expected 12 columns"},
       {"*", std::string("PK\3\4rest"), "a ZIP archive (KMZ?)"},
       {"*", std::string("\0\1\2\3", 4), "m.waypoints:1: expected QGC WPL 110"},
       {"*", "RALLY 1 2 3\n", "m.waypoints:1: expected RALLY and 6 numbers"},
       {"*", "RALLY 1 2 3 4 5 0\nQGC WPL 110\n", "m.waypoints:2: expected RALLY and 6 numbers"},
       {"*", "RALLY 91 2 3 4 5 0\n", "m.waypoints:1: expected longitude in [-180, 180]"},
       {"*", "RALLY 1 2 x 4 5 0\n", "m.waypoints:1: expected a number, found 'x'"},
       {"*", "47.1 8.5\n47.2 8.6\n", "in the old format"},
       {"\t50\t1", "\t50\t1\t9", "m.waypoints:4: expected 12 columns, found 13"},
       {"\t50\t1", "\t50,5\t1",
        "m.waypoints:4: expected a number as altitude, found '50,5', which has a comma"},
       {"\t50\t1", ",50,1", "separated by tabs or spaces, not by commas"},
       {"2\t0\t3\t16", "3\t0\t3\t16", "m.waypoints:4: expected item 2, found 3"},
       {"\n0\t1", "\n1\t1",
        "m.waypoints:2: expected item 0, found 1: the file has no home position, which is item 0"},
       {"2\t0\t3\t16", "x\t0\t3\t16", "expected a number as number, found 'x'"},
       {"2\t0\t3\t16", "2\t0\t2\t16", "expected the frame 0 (sea level)"},
       {"2\t0\t3\t16", "2\t0\t3.5\t16", "as frame"},
       {"2\t0\t3\t16", "2\t7\t3\t16", "expected a whole number from 0 to 1 as current"},
       {"2\t0\t3\t16", "2\t0\t3\t1e9", "as command"},
       {"47.42", "97.42", "m.waypoints:4: expected longitude in [-180, 180] and latitude"},
       {"47.42", "nan", "expected a number as latitude, found 'nan'"},
       {"47.42", "inf", "expected a number as latitude, found 'inf'"},
       {"47.42", "1e999", "expected a number as latitude"},
       {"47.42", "47,42", "expected a number as latitude, found '47,42'"},
       {"47.42\t8.52", "147.42\t8.52", "are the axes swapped?"},
       {"47.42\t8.52", "0\t0", "a waypoint needs a position"},
       {"8.52\t50", "8.52\t5e6", "an altitude within 100 km"},
       {"47.4\t8.5\t488", "47.4\t8.5\t-200000", "m.waypoints:2: expected an altitude"},
       {"0\t1\t0\t16\t0\t0\t0\t0\t47.4\t8.5", "0\t1\t3\t22\t0\t0\t0\t0\t0\t0",
        "begins at the vehicle's position, but the file has no home position"}});
  expect_refused(
      "f.txt", kFence,
      {{"5002\t3\t0\t0\t0\t47.4", "5002\t2\t0\t0\t0\t47.4", "f.txt:2: expected the number of the"},
       {"5002\t3\t0\t0\t0\t47.4", "5002\tnan\t0\t0\t0\t47.4",
        "f.txt:2: expected the number of the"},
       {"5002\t3\t0\t0\t0\t47.4", "5002\t1e12\t0\t0\t0\t47.4", "f.txt:2: expected the number of"},
       {"1\t0\t0\t5002\t3", "1\t0\t0\t5002\t4", "f.txt:3: the polygon of line 2 has 3 corners"},
       {"2\t0\t0\t5002\t3", "2\t0\t0\t5001\t3", "f.txt:4: the fence's polygon of line 2 ends 1"},
       {"47.5\t8.5", "47.45\t8.4", "f.txt:4: the outline"},
       {"47.5\t8.5", "95\t8.5", "f.txt:4: expected longitude"},
       {"5003\t77", "5003\t0", "f.txt:5: expected a radius above 0 m, found 0"},
       {"*", kFence.substr(0, kFence.find("2\t0\t0\t5002")), "ends 1 corners early"}});
}

TEST(DamagedMissions, Xml) {
  std::string nested = "<kml>";
  for (int n = 0; n < 100'000; ++n) {
    nested += "<Folder>";
  }
  const std::string bomb =
      "<?xml version=\"1.0\"?><!DOCTYPE l [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;\">"
      "]><kml><name>&b;</name></kml>";
  std::string deep = nested;
  for (int n = 0; n < 100'000; ++n) {
    deep += "</Folder>";
  }
  deep += "</kml>";
  expect_refused(
      "m.kml", kKml,
      {{"*", kKml.substr(0, kKml.size() / 2), "is not XML"},
       {"</Document>", "", "m.kml:10: is not XML"},
       {"*", bomb, "m.kml:1: a document type (<!DOCTYPE) is not accepted"},
       {"*", nested, "is not XML"},
       {"*", deep, "elements are nested more than 64 levels deep"},
       {"*", "<html><body/></html>", "m.kml:1: expected the element kml or gpx, found 'html'"},
       {"*", "<", "is not XML"},
       {"absolute", "above", "m.kml:4: expected the altitudeMode absolute, relativeToGround or"},
       {"8.6,47.5,510", "8.6", "m.kml:4: expected longitude,latitude[,altitude], found '8.6'"},
       {"8.6,47.5,510", "8.6,47.5,510,1", "expected longitude,latitude[,altitude]"},
       {"8.6,47.5,510", "8.6,,510", "expected a number, found ''"},
       {"8.6,47.5,510", "8.6,north,510", "expected a number, found 'north'"},
       {"8.6,47.5,510", "8.6,nan,510", "expected a number, found 'nan'"},
       {"8.6,47.5,510", "8.6,95,510", "found longitude 8.6 and latitude 95"},
       {"8.6,47.5,510", "8.6,147.5,510", "are the axes swapped?"},
       {"8.6,47.5,510", "8.6,47.5,1e300", "an altitude within 100 km"},
       {"<coordinates>8.5,47.4,500 8.6,47.5,510</coordinates>", "", "'coordinates' is missing"},
       {"9,48 8,47\n", "9,48 8,47.5\n", "m.kml:7: a ring must end where it starts"},
       {"outerBoundaryIs><LinearRing>", "innerBoundaryIs><LinearRing>", "is not XML"},
       {"keep_out", "avoid", "expected the role keep_in or keep_out, found 'avoid'"},
       {"<value>50</value>", "<value>low</value>", "expected a number, found 'low'"}});
  expect_refused("m.gpx", kGpx,
                 {{"lat=\"47.5\"", "lat=\"95\"", "m.gpx:4: expected longitude"},
                  {"lat=\"47.5\"", "", "m.gpx:4: expected a number, found ''"},
                  {"lat=\"47.5\"", "lat=\"147.5\"", "are the axes swapped?"},
                  {"<ele>510", "<ele>high", "m.gpx:4: expected a number, found 'high'"},
                  {"<ele>510", "<ele>1e9", "an altitude within 100 km"},
                  {"</rte>", "", "is not XML"}});
}

TEST(DamagedMissions, GeoJsonRoutes) {
  expect_refused(
      "m.geojson", kGeoJson,
      {{"\"home\", ", "\"mars\", ", "altitude_frame: expected sea, ground or home, found \"mars\""},
       {"[8.5, 47.4, 400]", "[8.5, 47.4]", "home: expected [longitude, latitude, altitude]"},
       {", \"home\": [8.5, 47.4, 400]", "", "properties: the key 'home' is missing"},
       {"[8.6, 47.5, 20]", "[8.6]", "coordinates.1: expected [longitude, latitude, altitude]"},
       {"[8.6, 47.5, 20]", "[8.6, 95, 20]", "coordinates.1: expected longitude"},
       {"[8.6, 47.5, 20]", "[8.6, 147.5, 20]", "are the axes swapped?"},
       {"[8.6, 47.5, 20]", "[8.6, 47.5, null]", "coordinates.1.2: expected a number, found null"},
       {"[[8.5, 47.4, 10], [8.6, 47.5, 20]]", "{}", "coordinates: expected a list"},
       {"\"features\"", "\"things\"", "the key 'features' is missing"}});
}
}  // namespace
}  // namespace altiplan::formats::damaged_missions_test
