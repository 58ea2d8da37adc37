// SPDX-License-Identifier: Apache-2.0
// Zones from GeoJSON with types, from KML and from the fences of ground stations; clip.
#include <gtest/gtest.h>

#include <algorithm>

#include "altiplan/error.hpp"
#include "altiplan/world.hpp"
#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::testing::zone_file_test {
namespace {

const World kNothing;

Site site_of(const Box& volume = {}) {
  Site site;
  site.before = &kNothing;
  site.frame = Frame::geographic(25, 60, 60);
  site.volume = volume;
  return site;
}

class ZoneFile : public ::testing::Test {
 protected:
  std::unique_ptr<Environment> zones(const std::string& name, const std::string& text,
                                     const std::string& more = "",
                                     const Site& site = site_of()) const {
    return make_environment("zones", "{file: " + folder_.write(name, text).string() + more + "}",
                            site);
  }
  std::string refusal(const std::string& name, const std::string& text,
                      const std::string& more = "", const Site& site = site_of()) const {
    try {
      zones(name, text, more, site);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  TempFolder folder_;
};

bool says(const Environment& layer, const std::string& part) {
  const auto notes = layer.info().notes;
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

Vec3 at(double lon, double lat, double z) {
  const auto [x, y] = Frame::geographic(25, 60, 60).to_local(lon, lat);
  return {x, y, z};
}

std::string feature(const std::string& id, double west, const std::string& properties) {
  const auto corner = [](double lon, const char* lat) {
    return "[" + std::to_string(lon) + ", " + lat + "]";
  };
  return R"({"type": "Feature", "id": ")" + id + R"(", "properties": )" + properties +
         R"(, "geometry": {"type": "Polygon", "coordinates": [[)" + corner(west, "60.0") + "," +
         corner(west + 0.1, "60.0") + "," + corner(west + 0.1, "60.1") + "," +
         corner(west, "60.1") + "," + corner(west, "60.0") + "]]}}";
}

const std::string kTyped =
    R"({"type": "FeatureCollection", "features": [)" + feature("A", 25.0, R"({"type": "R"})") +
    "," + feature("B", 25.2, R"({"type": "L"})") + "," +
    feature("C", 25.4, R"({"type": "L", "low": 120})") + "," +
    feature("D", 25.6, R"({"type": "X"})") + "," + feature("E", 25.8, "{}") + "]}";

TEST_F(ZoneFile, TypesGiveLimitsThatTheFeatureDoesNot) {
  const auto layer = zones("t.geojson", kTyped,
                           ", type_property: type, floor_property: low,"
                           " types: [{is: L, floor_m: 50}, {is: X, skip: true}]");
  EXPECT_LT(layer->clearance(at(25.05, 60.05, 10)), 0);           // R: closed from the ground
  EXPECT_NEAR(layer->clearance(at(25.25, 60.05, 10)), 40, 1e-6);  // L: free below 50 m
  EXPECT_LT(layer->clearance(at(25.25, 60.05, 51)), 0);
  EXPECT_NEAR(layer->clearance(at(25.45, 60.05, 110)), 10, 1e-6);  // its own floor
  EXPECT_GT(layer->clearance(at(25.65, 60.05, 10)), 1000);         // X: ignored
  EXPECT_LT(layer->clearance(at(25.85, 60.05, 10)), 0);            // no type: closed
  EXPECT_TRUE(says(*layer,
                   "5 polygons read (1 without a type, 2 of type L, 1 of type R, 1 of "
                   "type X), 0 features without an area skipped, 1 by their type"));
}

TEST_F(ZoneFile, TypesAreCheckedBeforeTheyMislead) {
  EXPECT_NE(refusal("t.geojson", kTyped, ", type_property: kind").find("present: low, type"),
            std::string::npos);
  EXPECT_NE(parameter_problems("environment", "zones", "{file: a, types: [{is: L}]}"), "");
  EXPECT_NE(parameter_problems("environment", "zones",
                               "{file: a, type_property: t, types: [{floor_m: 5}]}"),
            "");
  EXPECT_NE(parameter_problems("environment", "zones",
                               "{file: a, type_property: t,"
                               " types: [{is: L, floor_m: 5, ceiling_m: 5}]}"),
            "");
  EXPECT_NE(refusal("t.geojson", kTyped,
                    ", type_property: type, floor_property: low, types: [{is: L, ceiling_m: 90}]")
                .find("'C': the floor must be below the ceiling"),
            std::string::npos);
}

/// A Feature of that name whose geometry has these coordinates.
std::string polygon(const std::string& id, const std::string& coordinates,
                    const std::string& type = "Polygon") {
  return R"({"type": "Feature", "id": ")" + id + R"(", "properties": {}, "geometry": {"type": ")" +
         type + R"(", "coordinates": )" + coordinates + "}}";
}

std::string collection(const std::vector<std::string>& features) {
  std::string text;
  for (const std::string& one : features) {
    text += (text.empty() ? "" : ",") + one;
  }
  return R"({"type": "FeatureCollection", "features": [)" + text + "]}";
}

const std::vector<std::string> kFlat = {
    "[]",
    "[[]]",
    "[[[25, 60]]]",
    "[[[25, 60], [25, 60], [25, 60], [25, 60]]]",
    "[[[25, 60], [25.1, 60], [25, 60]]]",
    "[[[25, 60], [25.1, 60.1], [25.1, 60.1], [25, 60]]]",
    "[[[25.1, 60.1], [25.2, 60.2], [25.3, 60.3], [25.15, 60.15], [25.1, 60.1]]]"};

TEST_F(ZoneFile, APolygonWithoutAnAreaIsSkippedByName) {
  const std::string whole = feature("whole", 25.0, "{}");
  for (const std::string& flat : kFlat) {
    SCOPED_TRACE(flat);
    const auto layer = zones("f.geojson", collection({polygon("pier", flat), whole}));
    EXPECT_LT(layer->clearance(at(25.05, 60.05, 10)), 0);
    EXPECT_EQ(layer->drawing()->shapes.size(), 1U);
    EXPECT_TRUE(says(*layer, "1 polygons read, 1 features without an area skipped ('pier')"));
    EXPECT_TRUE(says(
        *zones("f.geojson", collection({polygon("pier", flat), polygon("jetty", flat), whole})),
        "2 features without an area skipped ('pier', 'jetty')"));
    const std::string said = refusal("f.geojson", collection({polygon("pier", flat)}));
    EXPECT_NE(said.find("f.geojson: contains no zone: 1 features without an area skipped "
                        "('pier')"),
              std::string::npos)
        << said;
  }
}

TEST_F(ZoneFile, PointsAndLinesAreZonesWhereAPropertySaysHowFarTheyReach) {
  const auto feature_of = [](const std::string& geometry, const std::string& properties) {
    return R"({"type": "Feature", "properties": )" + properties + R"(, "geometry": )" + geometry +
           "}";
  };
  const std::string point = R"({"type": "Point", "coordinates": [25.05, 60.05, 0]})";
  const std::string line =
      R"({"type": "LineString", "coordinates": [[25.05, 60.05], [25.2, 60.05]]})";
  const double degree = 111'319.5 * std::cos(radians(60.05));
  for (const std::string five_km :
       {R"({"title": "T", "Bufferzone": "5 km"})", R"({"name": "T", "radius": 5000})",
        R"({"name": "T", "buffer_km": 5})", R"({"name": "T", "radius": "5,0 KM"})",
        R"({"name": "T", "Radius_M": 5000})", R"({"name": "T", "buffer": 5})"}) {
    for (const std::string& geometry : {point, line}) {
      SCOPED_TRACE(five_km + geometry);
      const auto layer = zones("f.geojson", collection({feature_of(geometry, five_km)}));
      EXPECT_LT(layer->clearance(at(25.05 - 4980 / degree, 60.05, 10)), 0);
      EXPECT_GT(layer->clearance(at(25.05 - 5030 / degree, 60.05, 10)), 0);
      EXPECT_EQ(layer->clearance(at(25.18, 60.05, 10)) < 0, geometry == line);
      EXPECT_TRUE(says(*layer, "closed as far as a property says around 'T'"));
    }
  }
  EXPECT_NE(refusal("f.geojson", collection({feature_of(point, R"({"buffer": "some"})")}))
                .find("expected a length such as 5 km in the property 'buffer', found 'some'"),
            std::string::npos);
  const std::string whole = feature("whole", 25.0, "{}");
  EXPECT_TRUE(
      says(*zones("f.geojson", collection({feature_of(point, R"({"name": "mast"})"), whole})),
           "points and lines without a width, skipped: 'mast at 25.05, 60.05'"));
  const std::string kml =
      "<kml><Placemark><name>T</name><ExtendedData><Data name=\"Bufferzone\"><value>5 km</value>"
      "</Data></ExtendedData><Point><coordinates>25.05,60.05</coordinates></Point></Placemark></"
      "kml>";
  EXPECT_LT(zones("p.kml", kml)->clearance(at(25.05 - 4980 / degree, 60.05, 10)), 0);
}

TEST_F(ZoneFile, CoordinatesAreLongitudeAndLatitude) {
  const auto with = [](const std::string& crs) {
    return R"({"crs": {"type": "name", "properties": {"name": ")" + crs + R"("}}, )" +
           collection({feature("A", 25.0, "{}")}).substr(1);
  };
  EXPECT_EQ(refusal("f.geojson", with("urn:ogc:def:crs:OGC:1.3:CRS84")), "");
  const std::string said = refusal("f.geojson", with("urn:ogc:def:crs:EPSG::3857"));
  EXPECT_NE(said.find("crs: expected longitude and latitude of WGS 84"), std::string::npos) << said;
}

TEST_F(ZoneFile, OfAMultiPolygonThePartsWithAnAreaCount) {
  const std::string square = "[[[25, 60], [25.1, 60], [25.1, 60.1], [25, 60.1], [25, 60]]]";
  const auto layer = zones(
      "m.geojson", collection({polygon("both", "[" + kFlat[5] + "," + square + "]", "MultiPolygon"),
                               polygon("none", "[" + kFlat[5] + "]", "MultiPolygon"),
                               polygon("empty", "[]", "MultiPolygon")}));
  EXPECT_LT(layer->clearance(at(25.05, 60.05, 10)), 0);
  EXPECT_TRUE(says(*layer,
                   "1 polygons read, 2 features without an area skipped ('both', 'none', "
                   "'empty')"));
}

TEST_F(ZoneFile, WhatCannotBeReadOrContradictsItselfIsRefused) {
  const std::string whole = feature("whole", 25.0, "{}");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[[[25, 60], [25.1, 60], [25.1, 60.1]]]", "must end where it starts"},
      {"[[[25, 60], [25.1, 60]]]", "must end where it starts"},
      {"[[[25, 60], [25, 160], [25, 60]]]", "expected longitude in"},
      {"[[[25, 60], [25, \"x\"], [25, 60]]]", "expected a position"},
      {"[[7]]", "expected a position"},
      {"[7]", "a ring needs a list of positions"},
      {"7", "a Polygon needs a list of rings"},
      {"null", "a Polygon needs a list of rings"},
      {"[[[25, 60], [25.1, 60], [25, 60]],"
       " [[25, 60], [25.1, 60], [25.1, 60.1], [25, 60.1], [25, 60]]]",
       "the outline needs at least three different points"}};
  for (const auto& [coordinates, why] : cases) {
    const std::string said =
        refusal("f.geojson", collection({whole, polygon("pier", coordinates)}));
    EXPECT_NE(said.find("('pier'): "), std::string::npos) << said;
    EXPECT_NE(said.find(why), std::string::npos) << said;
  }
}

TEST_F(ZoneFile, RingsThatAreNoPolygonCloseAllThatTheyMayEnclose) {
  // A bow of two triangles; a square with a spike on its side; one whose hole reaches out of it.
  const std::string bow = "[[[25, 60], [25.1, 60.1], [25.1, 60], [25, 60.1], [25, 60]]]";
  const std::string spike =
      "[[[26, 60], [26.1, 60], [26.1, 60.05], [26.12, 60.05], [26.1, 60.05], [26.1, 60.1], "
      "[26, 60.1], [26, 60]]]";
  const std::string hole =
      "[[[27, 60], [27.1, 60], [27.1, 60.1], [27, 60.1], [27, 60]], "
      "[[27.05, 60.04], [27.2, 60.04], [27.2, 60.06], [27.05, 60.06], [27.05, 60.04]]]";
  const std::string all =
      collection({polygon("bow", bow), polygon("spike", spike), polygon("hole", hole)});
  const auto layer = zones("f.geojson", all);
  for (const auto& [lon, lat] :
       {std::pair(25.02, 60.05), {25.08, 60.05}, {26.05, 60.05}, {27.02, 60.05}, {27.07, 60.05}}) {
    EXPECT_LT(layer->clearance(at(lon, lat, 10)), 0) << lon;
  }
  for (const auto& [lon, lat] : {std::pair(25.05, 60.02), {25.05, 60.08}, {26.11, 60.06}}) {
    EXPECT_GT(layer->clearance(at(lon, lat, 10)), 0) << lon;
  }
  EXPECT_TRUE(says(*layer,
                   "rings that are no polygon, closed in all that they may enclose: 'bow', "
                   "'spike', 'hole'"));
  // What a hole holds in a hole, or shares with one, is closed as well.
  const std::string ring = "[[28, 60], [28.1, 60], [28.1, 60.1], [28, 60.1], [28, 60]]";
  const std::string large =
      "[[28.02, 60.02], [28.08, 60.02], [28.08, 60.08], [28.02, 60.08], [28.02, 60.02]]";
  const std::string small =
      "[[28.04, 60.04], [28.06, 60.04], [28.06, 60.06], [28.04, 60.06], [28.04, 60.04]]";
  const std::string beside =
      "[[28.06, 60.04], [28.09, 60.04], [28.09, 60.06], [28.06, 60.06], [28.06, 60.04]]";
  for (const std::string& other : {small, beside}) {
    for (const std::string& rings : {large + "," + other, other + "," + large}) {
      const auto nested =
          zones("n.geojson", collection({polygon("n", "[" + ring + "," + rings + "]")}));
      EXPECT_LT(nested->clearance(at(28.05, 60.05, 10)), 0);
      EXPECT_LT(nested->clearance(at(28.07, 60.05, 10)), 0);
    }
  }
  // To be kept in by them would be a guess.
  for (const std::string& rings : {bow, spike, hole}) {
    EXPECT_NE(refusal("in.geojson", collection({polygon("in", rings)}), ", file_kind: keep_in")
                  .find("'in': "),
              std::string::npos)
        << rings;
  }
}

const std::string kKml =
    "<kml><Placemark><name>park</name><Polygon><extrude>1</extrude>"
    "<altitudeMode>absolute</altitudeMode><outerBoundaryIs><LinearRing><coordinates>"
    "25,60,200 25.1,60,200 25.1,60.1,200 25,60.1,200 25,60,200"
    "</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></kml>";

TEST_F(ZoneFile, KmlPolygonsReachUpToWhereTheyAreExtrudedFrom) {
  const auto layer = zones("p.kml", kKml);
  EXPECT_NEAR(layer->clearance(at(25.05, 60.05, 190)), -10, 1e-6);
  EXPECT_NEAR(layer->clearance(at(25.05, 60.05, 230)), 30, 1e-6);
  EXPECT_LT(layer->clearance(at(25.05, 60.05, -500)), 0);
  EXPECT_EQ(layer->drawing()->shapes.at(0).name, "park");
  const auto inside = zones("p.kml", kKml, ", file_kind: keep_in");
  EXPECT_NEAR(inside->clearance(at(25.05, 60.05, 190)), 10, 1e-6);
  EXPECT_LT(inside->clearance(at(25.05, 60.05, 230)), 0);
  EXPECT_NE(refusal("p.kml", kKml, ", floor_property: low").find("properties are GeoJSON's"),
            std::string::npos);
  EXPECT_NE(refusal("p.kml", "<kml/>").find("contains no zone"), std::string::npos);
}

TEST_F(ZoneFile, AKmlPolygonWithoutAnAreaIsSkippedByName) {
  const std::string park = kKml.substr(5, kKml.size() - 11);
  for (const char* flat : {"", "25,60", "25,60 25,60 25,60 25,60", "25,60 25.1,60 25,60",
                           "25.1,60.1 25.2,60.2 25.3,60.3 25.1,60.1"}) {
    SCOPED_TRACE(flat);
    const std::string pier =
        "<Placemark><name>pier</name><Polygon><outerBoundaryIs><LinearRing><coordinates>" +
        std::string(flat) + "</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark>";
    const auto layer = zones("p.kml", "<kml>" + pier + park + "</kml>");
    EXPECT_NEAR(layer->clearance(at(25.05, 60.05, 230)), 30, 1e-6);
    EXPECT_TRUE(says(*layer,
                     "1 zones read, 0 waypoints of a route ignored; skipped, without an area: "
                     "'pier'"));
    EXPECT_NE(refusal("p.kml", "<kml>" + pier + "</kml>").find("no area in 'pier'"),
              std::string::npos);
  }
}

TEST_F(ZoneFile, FencesSayThemselvesWhatIsKeptInAndOut) {
  const auto layer = zones(
      "f.waypoints",
      "QGC WPL 110\n0\t0\t0\t5001\t3\t0\t0\t0\t60\t25\t0\t0\n1\t0\t0\t5001\t3\t0\t0\t0\t60\t26\t0"
      "\t0\n2\t0\t0\t5001\t3\t0\t0\t0\t61\t25.5\t0\t0\n3\t0\t0\t5004\t500\t0\t0\t0\t60.3\t25.5\t0"
      "\t0\n");
  EXPECT_NEAR(layer->clearance(at(25.5, 60.3, 10)), -500, 0.05);  // metres on the ground
  EXPECT_GT(layer->clearance(at(25.5, 60.2, 10)), 1000);
  EXPECT_LT(layer->clearance(at(25.1, 60.9, 10)), 0);
  EXPECT_TRUE(says(*layer, "1 keep-out and 1 keep-in zones"));
}

TEST_F(ZoneFile, AFileFixesTheFrameOfAWorldWithoutOne) {
  Site nowhere;
  nowhere.before = &kNothing;
  const auto layer = zones("p.kml", kKml, "", nowhere);
  ASSERT_TRUE(layer->info().frame.has_value());
  const auto corner = layer->info().frame->to_local(25, 60);
  EXPECT_NEAR(std::hypot(corner[0], corner[1]), 0, 1e-6);
}

TEST_F(ZoneFile, ZonesAllOverTheEarthHaveNoFrameOfTheirOwn) {
  Site nowhere;
  nowhere.before = &kNothing;
  const std::string far = collection({feature("A", 25.0, "{}"), feature("B", 165.0, "{}")});
  const std::string said = refusal("far.geojson", far, "", nowhere);
  EXPECT_NE(said.find("far.geojson: its zones lie farther apart than a frame"), std::string::npos)
      << said;
  EXPECT_LT(zones("far.geojson", far)->clearance(at(25.05, 60.05, 10)), 0);
  // What only informs needs no place in the frame.
  const auto zone = [](const std::string& id, const std::string& restriction,
                       const std::string& projection) {
    return R"({"identifier": ")" + id + R"(", "restriction": ")" + restriction +
           R"(", "applicability": [{"permanent": "YES"}], "geometry": [{"uomDimensions": "M",
           "lowerLimit": 0, "lowerVerticalReference": "AGL", "upperLimit": 99999,
           "upperVerticalReference": "AMSL", "horizontalProjection": )" +
           projection + "}]}";
  };
  const std::string world = R"({"type": "Polygon", "coordinates":
      [[[-180, -90], [180, -90], [180, 90], [-180, 90], [-180, -90]]]})";
  const std::string circle = R"({"type": "Circle", "center": [25.05, 60.05], "radius": 3000})";
  const auto layer = zones("w.json",
                           R"({"features": [)" + zone("W", "NO_RESTRICTION", world) + "," +
                               zone("P", "PROHIBITED", circle) + "]}",
                           "", nowhere);
  const auto [x, y] = layer->info().frame.value().to_local(25.05, 60.05);
  EXPECT_LT(layer->clearance({x, y, 10}), 0);
}

TEST_F(ZoneFile, ClipDropsAndCutsWithoutChangingWhatIsInside) {
  const Vec3 corner = at(25.25, 60.05, 0);
  const Site site = site_of({{0, 0, 0}, {corner.x(), corner.y(), 500}});
  const auto whole = zones("t.geojson", kTyped);
  const auto clipped = zones("t.geojson", kTyped, ", clip: true", site);
  EXPECT_TRUE(says(*clipped, "3 zones outside the bounds dropped, 2 cut at them"));
  EXPECT_EQ(clipped->drawing()->shapes.size(), 2U);
  EXPECT_NEAR(clipped->bounds().max.x(), corner.x(), 1e-9);
  EXPECT_GT(whole->bounds().max.x(), 2 * corner.x());
  RandomStream random;
  int blocked = 0;
  for (int n = 0; n < 1000; ++n) {
    const Vec3 p = random.in(site.volume);
    EXPECT_EQ(whole->blocked(p, p, 0), clipped->blocked(p, p, 0)) << n;
    blocked += whole->blocked(p, p, 0);
  }
  EXPECT_GT(blocked, 300);
  EXPECT_LT(blocked, 900);
  EXPECT_NE(refusal("t.geojson", kTyped, ", clip: true").find("needs a world with bounds"),
            std::string::npos);
}

TEST_F(ZoneFile, ClipCutsConcaveZonesIntoPieces) {
  const std::string comb =
      R"({"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [[)"
      "[25, 60], [25.3, 60], [25.3, 60.3], [25.2, 60.3], [25.2, 60.1], [25.1, 60.1], [25.1, 60.3],"
      " [25, 60.3], [25, 60]]]}}";
  const Vec3 low = at(24.9, 60.2, 0);
  const Vec3 high = at(25.5, 60.5, 500);
  const auto layer = zones("c.geojson", comb, ", clip: true", site_of({low, high}));
  EXPECT_EQ(layer->drawing()->shapes.size(), 2U);
  EXPECT_LT(layer->clearance(at(25.05, 60.25, 10)), 0);
  EXPECT_GT(layer->clearance(at(25.15, 60.25, 10)), 100);
  EXPECT_LT(layer->clearance(at(25.25, 60.25, 10)), 0);
}

TEST_F(ZoneFile, ClipLeavesKeepInZonesWhole) {
  const Site site = site_of({{0, 0, 0}, {1000, 1000, 500}});
  const auto layer = zones("p.kml", kKml, ", file_kind: keep_in, clip: true", site);
  EXPECT_GT(layer->drawing()->shapes.size(), 0U);
  EXPECT_FALSE(layer->blocked({1000, 500, 100}, {1000, 500, 100}, 50));
}

TEST_F(ZoneFile, FilesOfOthers) {
  ALTIPLAN_DATA_OR_SKIP(folder, "missions");
  const auto of = [&](const char* name) {
    return make_environment("zones", "{file: " + (folder / name).string() + "}");
  };
  EXPECT_TRUE(says(*of("qgc_PolygonGood.kml"), "1 keep-out and 0 keep-in zones"));
  EXPECT_TRUE(says(*of("qgc_geofence_home_base.plan"), "1 keep-out and 1 keep-in zones"));
  EXPECT_TRUE(
      says(*of("mavproxy_springvalleybottom-foamy-fence.txt"), "0 keep-out and 1 keep-in zones"));
  EXPECT_THROW(of("px4_avoidance.plan"), Error);
}
}  // namespace
}  // namespace altiplan::testing::zone_file_test
