// SPDX-License-Identifier: Apache-2.0
#include "altiplan/formats/airspace.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"
#include "altiplan/formats/airspace_index.hpp"
#include "altiplan/formats/input_file.hpp"
#include "altiplan/formats/iso_time.hpp"
#include "altiplan/geometry.hpp"
#include "support/support.hpp"

namespace altiplan::testing::airspace_test {
namespace {

using formats::Airspace;
using formats::AirspaceIndex;
using formats::Restriction;
using formats::Zone;
using formats::ZoneLimit;
using Datum = ZoneLimit::Datum;

Airspace read(const std::string& text, const std::string& file = "file") {
  const auto airspace = formats::read_airspace(file, text);
  if (!airspace) {
    throw std::runtime_error("no airspace");
  }
  return *airspace;
}

Airspace given(const std::filesystem::path& folder, const std::string& name) {
  return read(formats::read_file((folder / name).string()), name);
}

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

bool noted(const Airspace& airspace, const std::string& part) {
  return std::any_of(airspace.notes.begin(), airspace.notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

bool holds(const Airspace& airspace, const AirspaceIndex::Place& place, const char* time) {
  return AirspaceIndex(airspace.zones).find(place, formats::parse_iso_time(time).value()) !=
         nullptr;
}

/// A zone of ED-269 with parts replaced.
std::string ed269(const std::string& from = "", const std::string& to = "") {
  std::string text =
      R"({"features": [{"identifier": "Z1", "name": "Zone", "restriction": "PROHIBITED",
      "applicability": [{"permanent": "NO", "startDateTime": "2022-06-15T09:00:00.00Z",
        "endDateTime": "2023-06-15T09:00:00.00Z", "schedule": [
          {"day": ["SAT", "SUN"], "startTime": "17:00:00.00Z", "endTime": "23:59:59.00Z"}]}],
      "geometry": [{"uomDimensions": "FT", "lowerLimit": 500, "lowerVerticalReference": "AGL",
        "upperLimit": 3000, "upperVerticalReference": "AMSL",
        "horizontalProjection": {"type": "Circle", "center": [7, 46], "radius": 3000}}]}]})";
  if (!from.empty()) {
    text.replace(text.find(from), from.size(), to);
  }
  return text;
}

std::string openair(const std::string& records) {
  return "AC R\nAN Zone\nAL 500 ft AGL\nAH FL100\n" + records +
         "\nDP 46:00:00 N 007:00:00 E\nDP 46:10:00 N 007:00:00 E\nDP 46:10:00 N 007:10:00 E\n";
}

const AirspaceIndex::Place kInside{7, 46, 600, 300};
constexpr const char* kSaturday = "2022-06-18T18:00Z";

TEST(Airspace, ReadsTheGivenFilesWhole) {
  ALTIPLAN_DATA_OR_SKIP(folder, "airspace");
  const Airspace swiss = given(folder, "ed269-ch.json");
  ASSERT_EQ(swiss.zones.size(), 4U);
  EXPECT_EQ(swiss.zones[0].volumes[0].upper, ZoneLimit{});  // 99999 m
  EXPECT_EQ(swiss.zones[2].volumes[0].upper, (ZoneLimit{Datum::ground, 120}));
  EXPECT_EQ(swiss.zones[3].volumes.size(), 2U);
  const Airspace swedish = given(folder, "ed318-se.json");
  ASSERT_EQ(swedish.zones.size(), 3U);
  EXPECT_EQ(swedish.format, Airspace::Format::ed318);
  EXPECT_EQ(swedish.zones[2].volumes[0].upper, (ZoneLimit{Datum::sea, 1500 * 0.3048}));
  EXPECT_EQ(swedish.zones[2].periods[0].hours.size(), 2U);
  const Airspace grid = given(folder, "faa-uasfm.json");
  ASSERT_EQ(grid.zones.size(), 2U);
  EXPECT_EQ(grid.zones[0].volumes[0].lower, ZoneLimit{});  // CEILING 0
  EXPECT_EQ(grid.zones[1].volumes[0].lower, (ZoneLimit{Datum::ground, 200 * 0.3048}));
  const Airspace british = given(folder, "aixm51-gb.xml");
  ASSERT_EQ(british.zones.size(), 6U);
  EXPECT_EQ(british.zones[1].volumes[0].lower, (ZoneLimit{Datum::standard, 1524}));
  EXPECT_EQ(british.zones[1].volumes[0].upper, ZoneLimit{});  // FL999
  EXPECT_TRUE(noted(british, "Mon-Sat SR to SS."));
  const Airspace sample = given(folder, "openair_sample.txt");
  EXPECT_EQ(sample.zones.size(), 25U);  // of 26 entries one is terrain
  EXPECT_TRUE(noted(sample, "terrain, skipped: 'Lake Tahoe'"));
  EXPECT_TRUE(noted(sample, "Ask on 122.8"));
  EXPECT_EQ(given(folder, "openair_slovenia.txt").zones.size(), 58U);
  EXPECT_TRUE(refusal(formats::read_file((folder / "openair_broken.txt").string()))
                  .starts_with("file:5: DC needs a centre"));
}

TEST(Airspace, ClosesTheWeekendZoneInTheEvening) {
  ALTIPLAN_DATA_OR_SKIP(folder, "airspace");
  const Airspace airspace = given(folder, "ed269_u-space_che-1.json");
  ASSERT_EQ(airspace.zones.size(), 6U);
  const AirspaceIndex::Place montreux{6.913, 46.431, 700, 400};
  EXPECT_TRUE(holds(airspace, montreux, kSaturday));
  EXPECT_TRUE(holds(airspace, montreux, "2022-06-18T23:59:59.5Z"));
  EXPECT_FALSE(holds(airspace, montreux, "2022-06-18T12:00Z"));
  EXPECT_FALSE(holds(airspace, montreux, "2022-06-17T18:00Z"));  // a Friday
  EXPECT_FALSE(holds(airspace, montreux, "2024-06-15T18:00Z"));  // no longer valid
  EXPECT_FALSE(holds(airspace, {6.913, 46.431, 6260, 400}, kSaturday));
}

TEST(Airspace, WhatIsUnknownIsClosed) {
  const Airspace whole = read(ed269());
  EXPECT_TRUE(holds(whole, kInside, kSaturday));
  EXPECT_TRUE(whole.notes.empty());
  EXPECT_FALSE(holds(whole, {7, 46, 440, 300}, kSaturday));  // 140 m above ground
  EXPECT_TRUE(holds(whole, {7, 46, 440, {}}, kSaturday));    // above unknown ground
  EXPECT_FALSE(holds(whole, {7, 46, 915, 300}, kSaturday));
  const auto closed = [](const char* from, const char* to, const AirspaceIndex::Place& place,
                         const char* time, const char* note) {
    const Airspace airspace = read(ed269(from, to));
    return holds(airspace, place, time) && noted(airspace, note);
  };
  const AirspaceIndex::Place low{7, 46, 310, 300};
  const AirspaceIndex::Place high{7, 46, 9000, 300};
  constexpr const char* kMonday = "2022-06-20T18:00Z";
  EXPECT_TRUE(closed("500", "\"?\"", low, kSaturday, "lower limit"));
  EXPECT_TRUE(closed("\"upperLimit\": 3000, ", "", high, kSaturday, "upper limit (none given)"));
  EXPECT_TRUE(closed("\"FT\"", "\"furlong\"", high, kSaturday, "unit 'furlong'"));
  EXPECT_TRUE(closed("AMSL", "QNE", high, kSaturday, "reference 'QNE'"));
  EXPECT_TRUE(closed("AGL", "AMSL", kInside, kSaturday, "") == false);
  EXPECT_TRUE(closed("\"upperLimit\": 3000, \"upperVerticalReference\": \"AMSL\"",
                     "\"upperLimit\": 300, \"upperVerticalReference\": \"AGL\"", high, kSaturday,
                     "not below the upper one"));
  EXPECT_TRUE(closed("\"SUN\"", "\"HOLIDAY\"", kInside, kMonday, "active all day"));
  EXPECT_TRUE(closed("17:00:00.00Z", "17:00", kInside, kMonday, "active all day"));
  EXPECT_TRUE(closed("2023-06-15T09", "2021-06-15T09", kInside, kMonday, "before it starts"));
  EXPECT_TRUE(closed("2023-06-15T09:00:00.00Z", "later", kInside, "2031-06-14T18:00Z", "end of"));
  EXPECT_EQ(read(ed269("PROHIBITED", "ALLOWED")).zones[0].restriction, Restriction::keep_out);
  EXPECT_EQ(read(ed269("PROHIBITED", "REQ_AUTHORISATION")).zones[0].restriction, Restriction::ask);
}

TEST(Airspace, RefusesZonesWithoutAPlace) {
  EXPECT_EQ(refusal(ed269("3000}", "-3}")),
            "file: features.0.geometry.0.horizontalProjection.radius: expected a radius between 0 "
            "and 1000 km, found -3.000000 m (zone 'Z1 (Zone)')");
  EXPECT_NE(refusal(ed269("\"center\": [7, 46]", "\"center\": [46, 207]")), "");
  EXPECT_NE(refusal(ed269("\"Circle\"", "\"Square\"")), "");
  EXPECT_EQ(refusal(openair("DX 5")).substr(0, 30), "file:5: unknown record 'DX', e");
  EXPECT_EQ(refusal(openair("AP! 5")), "") << "a record of another description of the format";
  EXPECT_EQ(refusal(openair("X 5")).substr(0, 29), "file:5: unknown record 'X', e");
  EXPECT_EQ(refusal(openair("DC 5")), "file:5: DC needs a centre, expected V X=… before it");
  EXPECT_NE(refusal(openair("DP 46:61:00 N 007:00:00 E")), "");
  EXPECT_NE(refusal(openair("AN Other")).find("a second AN"), std::string::npos);
  EXPECT_EQ(refusal("AC A\nAN W1\nAL GND\nAH FL100\nDY 46:00:00 N 007:00:00 E\n"),
            "file:5: airspace 'W1' of line 1: DY needs a width, expected V W=… before it");
}

TEST(Airspace, SkipsWhatHasNoAreaByNameAndReadsTheRest) {
  const std::string rest = openair("");
  for (const std::string outline :
       {"", "DP 46:00:00 N 008:00:00 E\n", "DP 46:00:00 N 008:00:00 E\nDP 46:10:00 N 008:00:00 E\n",
        "DP 46:00:00 N 008:00:00 E\nDP 46:10:00 N 008:00:00 E\nDP 46:00:00 N 008:00:00 E\n"}) {
    const Airspace airspace = read("AC P\nAN AXIS\nAL GND\nAH FL100\n" + outline + rest);
    ASSERT_EQ(airspace.zones.size(), 1U) << outline;
    EXPECT_EQ(airspace.zones[0].name, "Zone");
    EXPECT_TRUE(noted(airspace,
                      "outline without an area (three corners or more that are not in "
                      "line), skipped: 'AXIS'"));
  }
  const Airspace other = read(openair("XX 5"));
  EXPECT_EQ(other.zones.size(), 1U);
  EXPECT_TRUE(noted(other, "record XX, not read: 'Zone'"));
  const std::string flat = "[[7, 46], [7.1, 46], [7.2, 46], [7, 46]]";
  const Airspace zones = read(ed269("{\"type\": \"Circle\", \"center\": [7, 46], \"radius\": 3000}",
                                    "{\"type\": \"Polygon\", \"coordinates\": [" + flat + "]}"));
  EXPECT_TRUE(zones.zones.empty());
  EXPECT_TRUE(noted(zones, "skipped: 'Z1 (Zone)'"));
  EXPECT_NE(refusal(R"({"features": [{"identifier": "Z", "restriction": "PROHIBITED",
      "applicability": [], "geometry": []}]})")
                .find("features.0.geometry: expected a list of volumes"),
            std::string::npos);
}

TEST(Airspace, AnAirwayIsAsWideAsItSays) {
  // Along a meridian, 5 NM wide: 4,630 m to either side.
  const Airspace airway = read(
      "V W=5\nAC A\nAN W1\nAL 1000 ft\nAH FL100\n"
      "DY 46:00:00 N 007:00:00 E\nDY 46:30:00 N 007:00:00 E\n");
  const double degree = 111'319.5 * std::cos(radians(46.25));
  const auto closed = [&](double lon, double lat) {
    return holds(airway, {lon, lat, 600, 600}, kSaturday);
  };
  for (const double side : {-1, 1}) {
    EXPECT_TRUE(closed(7 + side * 4600 / degree, 46.25));
    EXPECT_FALSE(closed(7 + side * 4670 / degree, 46.25));
  }
  EXPECT_TRUE(closed(7, 46 - 4600 / 111'150.0));  // rounded ends
  EXPECT_FALSE(closed(7, 46 - 4670 / 111'150.0));
}

TEST(Airspace, Ed269StandsWithinGeoJsonToo) {
  const auto zones = [](const std::string& restriction, const std::string& limits) {
    return read(R"({"type": "FeatureCollection", "features": [{"type": "Feature", "geometry":
      {"type": "Polygon", "coordinates": [[[7, 46], [7.1, 46], [7.1, 46.1], [7, 46.1], [7, 46]]]},
      "properties": {"identifier": "Z1", "type": "COMMON", "restriction": ")" +
                restriction + R"(", "zoneAuthority": [], "geometry": )" + limits +
                R"(, "applicability": [{"permanent": "YES", "schedule": []}]}}]})");
  };
  const std::string limits = R"({"uomDimensions": "M", "lowerLimit": 121,
      "lowerVerticalReference": "AGL", "upperLimit": 500, "upperVerticalReference": "AMSL"})";
  const Airspace closed = zones("PROHIBITED", limits);
  EXPECT_EQ(closed.format, Airspace::Format::ed269);
  ASSERT_EQ(closed.zones.size(), 1U);
  EXPECT_EQ(closed.zones[0].restriction, Restriction::keep_out);
  EXPECT_EQ(closed.zones[0].volumes[0].lower, (ZoneLimit{Datum::ground, 121}));
  EXPECT_EQ(closed.zones[0].volumes[0].upper, (ZoneLimit{Datum::sea, 500}));
  EXPECT_TRUE(closed.notes.empty()) << closed.notes[0];
  EXPECT_EQ(zones("NO_RESTRICTION", limits).zones[0].restriction, Restriction::inform);
  EXPECT_EQ(zones("REQ_AUTHORISATION", "[" + limits + "]").zones[0].restriction, Restriction::ask);
}

TEST(Airspace, OpenAirHasUnitsTimesAndTypes) {
  const auto zone = [](const std::string& records) { return read(openair(records)).zones.at(0); };
  EXPECT_EQ(zone("").volumes[0].lower, (ZoneLimit{Datum::ground, 152.4}));
  EXPECT_EQ(zone("").volumes[0].upper, (ZoneLimit{Datum::standard, 3048}));
  EXPECT_EQ(zone("AY CTR").restriction, Restriction::keep_out);  // the class is R
  EXPECT_FALSE(zone("AA 2023-12-16T12:00Z/2023-12-16T13:00Z").is_active(0, 1e9));
  EXPECT_TRUE(zone("AA 2023-12-16T12:00Z/2023-12-16T13:00Z").is_active(1702730000, 1702730000));
  EXPECT_TRUE(zone("AA NONE").is_active(0, 0));
  EXPECT_TRUE(zone("AA sometimes\nAA 2023-12-16T12:00Z/NONE").is_active(0, 0));
  const auto upper = [](const std::string& text) {
    std::string records = openair("");
    records.replace(records.find("FL100"), 5, text);
    return read(records).zones[0].volumes[0].upper;
  };
  EXPECT_EQ(upper("2500 m AGL"), (ZoneLimit{Datum::ground, 2500}));
  EXPECT_EQ(upper("17000ft (Mo-Fri)"), (ZoneLimit{Datum::sea, 17000 * 0.3048}));
  EXPECT_EQ(upper("4500MSL"), (ZoneLimit{Datum::sea, 4500 * 0.3048}));
  EXPECT_EQ(upper("UNLIMITED"), ZoneLimit{});
  EXPECT_EQ(upper("9 furlongs"), ZoneLimit{});
}

TEST(Airspace, OpenAirHasLabelsAndCommentsAnywhere) {
  const std::string zone = openair("");
  EXPECT_EQ(
      read("AT 45:50:00 N 007:10:00 E\n" + zone + "; not declared a danger area\n").zones.size(),
      read(zone).zones.size());
}

TEST(Airspace, SixtySecondsAreTheNextMinute) {
  const auto outline = [](const std::string& corner) {
    return read(openair("DP " + corner)).zones.at(0).volumes[0].polygon.outline;
  };
  const auto whole = outline("45:50:00 N 007:10:00 E");
  for (const std::string corner : {"45:49:60 N 007:09:60.000 E", "45:49:60N 7:10 E"}) {
    const auto rounded = outline(corner);
    ASSERT_EQ(rounded.size(), whole.size()) << corner;
    for (std::size_t n = 0; n < whole.size(); ++n) {
      EXPECT_NEAR(rounded[n][0], whole[n][0], 1e-12) << corner;
      EXPECT_NEAR(rounded[n][1], whole[n][1], 1e-12) << corner;
    }
  }
  EXPECT_NE(refusal(openair("DP 45:49:60.5 N 007:10:00 E")), "");
}

/// Points of the arcs that are in the zone by any reckoning.
TEST(Airspace, ChordsNeverCutIntoTheZone) {
  // A circle with a bite: its outer arc bulges out, the inner one in.
  const Airspace airspace = read(
      "AC R\nAN Bitten\nAL GND\nAH UNL\nV X=46:00:00 N 007:00:00 E\nDA 5,0,180\nV D=-\nDA "
      "3,180,0\n");
  ASSERT_EQ(airspace.zones[0].volumes.size(), 1U);
  EXPECT_TRUE(airspace.notes.empty());
  const AirspaceIndex index(airspace.zones);
  const auto inside = [&](double bearing, double metres) {
    // On the ellipsoid near 46° N; the second order matters below a metre.
    const double a = radians(bearing);
    const double lat0 = radians(46);
    const double w2 = 1 - 0.00669437999014 * std::pow(std::sin(lat0), 2);
    const double n = 6378137 / std::sqrt(w2);
    const double m = n * (1 - 0.00669437999014) / w2;
    const double north = metres * std::cos(a);
    const double east = metres * std::sin(a);
    const double lat = lat0 + north / m - east * east * std::tan(lat0) / (2 * m * n);
    const double lon = east / (n * std::cos(lat0)) * (1 + north * std::tan(lat0) / n);
    return index.find({7 + degrees(lon), degrees(lat), 0, 0}, 0) != nullptr;
  };
  for (double bearing = 1; bearing < 180; bearing += 0.37) {
    EXPECT_TRUE(inside(bearing, 5 * 1852 - 0.2)) << bearing;
    EXPECT_FALSE(inside(bearing, 5 * 1852 + 1.4)) << bearing;
    EXPECT_TRUE(inside(bearing, 3 * 1852 + 0.2)) << bearing;
    EXPECT_FALSE(inside(bearing, 3 * 1852 - 1.4)) << bearing;
  }
}

std::string aixm_slice(int from, int to) {
  return R"(<AIXMBasicMessage><Airspace><timeSlice><AirspaceTimeSlice><type>R</type><designator>S
      </designator><geometryComponent><AirspaceGeometryComponent><theAirspaceVolume><AirspaceVolume>
      <upperLimit uom="FT">UNL</upperLimit><lowerLimit uom="FT">GND</lowerLimit>
      <horizontalProjection><PolygonPatch><exterior><Ring><curveMember><Curve><segments>
      <LineStringSegment><posList>46 7</posList></LineStringSegment><ArcByCenterPoint><pos>46 7
      </pos><radius uom="KM">5</radius><startAngle>)" +
         std::to_string(from) + "</startAngle><endAngle>" + std::to_string(to) +
         R"(</endAngle></ArcByCenterPoint></segments></Curve></curveMember></Ring></exterior>
      </PolygonPatch></horizontalProjection></AirspaceVolume></theAirspaceVolume>
      </AirspaceGeometryComponent></geometryComponent></AirspaceTimeSlice></timeSlice></Airspace>
      </AIXMBasicMessage>)";
}

// A slice of a disc: with one reading of the angles, and with two.
TEST(Airspace, ArcsThatMayRunEitherWayAreClosedBothWays) {
  const AirspaceIndex::Place north{7, 46.02, 0, 0};
  const AirspaceIndex::Place south{7, 45.98, 0, 0};
  const Airspace plain = read(aixm_slice(-30, 30));
  EXPECT_TRUE(plain.notes.empty());
  EXPECT_TRUE(holds(plain, north, kSaturday));
  EXPECT_FALSE(holds(plain, south, kSaturday));
  const Airspace uncertain = read(aixm_slice(330, 30));
  EXPECT_TRUE(noted(uncertain, "may run either way"));
  EXPECT_TRUE(holds(uncertain, north, kSaturday));
  EXPECT_TRUE(holds(uncertain, south, kSaturday));
}

TEST(Airspace, AnOutlineThatMeetsItselfIsClosedInAllLoops) {
  const Airspace airspace = read(
      "AC R\nAN Bow\nAL GND\nAH UNL\nDP 46:00:00 N 007:00:00 E\nDP 46:10:00 N 007:10:00 E\n"
      "DP 46:10:00 N 007:00:00 E\nDP 46:00:00 N 007:10:00 E\n");
  EXPECT_TRUE(noted(airspace, "meets itself"));
  EXPECT_TRUE(holds(airspace, {7.08, 46.02, 0, 0}, kSaturday));
  EXPECT_TRUE(holds(airspace, {7.08, 46.15, 0, 0}, kSaturday));
  EXPECT_FALSE(holds(airspace, {7.01, 46.08, 0, 0}, kSaturday));
}

// Against the tables of the U.S. Naval Observatory, to the minute.
TEST(Airspace, TheSunRisesAndSets) {
  using Event = formats::DailyHours::Event;
  const auto day = [](const char* date) { return long(*formats::parse_iso_time(date) / 86400); };
  const auto off = [&](Event event, const char* date, const formats::Point2& at, const char* time) {
    return std::abs(*formats::sun_time(event, day(date), at) - *formats::parse_iso_time(time));
  };
  const formats::Point2 greenwich{0, 51.4779};
  EXPECT_LT(off(Event::sunrise, "2024-03-20", greenwich, "2024-03-20T06:03Z"), 90);
  EXPECT_LT(off(Event::sunset, "2024-06-20", greenwich, "2024-06-20T20:21Z"), 90);
  EXPECT_FALSE(formats::sun_time(Event::sunset, day("2024-06-20"), {20, 70}).has_value());
  const Airspace airspace = read(ed269(R"("startTime": "17:00:00.00Z", "endTime": "23:59:59.00Z")",
                                       R"("startEvent": "SR", "endEvent": "SS")"));
  // At 7° E, 46° N on 2022-06-18 the sun rises at 03:39 and sets at 19:27.
  EXPECT_FALSE(holds(airspace, kInside, "2022-06-18T03:25Z"));
  EXPECT_TRUE(holds(airspace, kInside, "2022-06-18T03:45Z"));
  EXPECT_TRUE(holds(airspace, kInside, "2022-06-18T19:22Z"));
  EXPECT_FALSE(holds(airspace, kInside, "2022-06-18T19:42Z"));
}

TEST(Airspace, FlightLevelsFollowThePressure) {
  EXPECT_EQ(formats::standard_to_sea(3048, 1013.25), 3048);
  EXPECT_NEAR(formats::standard_to_sea(3048, 1003.25), 3048 - 77, 3);  // 1 hPa is 27 to 30 ft
  EXPECT_GT(formats::standard_to_sea(3048, 1030), 3150);
}
}  // namespace
}  // namespace altiplan::testing::airspace_test
