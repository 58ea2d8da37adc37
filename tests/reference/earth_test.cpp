// SPDX-License-Identifier: Apache-2.0
// The geodesy of the framework against GeographicLib's own programs (Debian: geographiclib-tools),
// which solve geodesics and areas apart from it: random positions all over the Earth, a tenth of
// them within 100 km of the 180th meridian, another within 5 degrees of a pole.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "altiplan/earth.hpp"
#include "altiplan/formats/earth_polygon.hpp"
#include "altiplan/frame.hpp"
#include "altiplan/map_system.hpp"
#include "altiplan/random.hpp"

namespace altiplan::testing::earth_test {
namespace {

using formats::Point2;
using formats::Polygon;
using formats::Ring;

constexpr double kMillimetre = 1e-3;

bool has_tools() { return std::system("GeodSolve --version > /dev/null 2>&1") == 0; }

/// What a program prints for these lines.
std::istringstream answers(const std::string& command, const std::string& lines) {
  const std::string stem =
      std::filesystem::temp_directory_path() / ("altiplan_earth_" + std::to_string(::getpid()));
  std::ofstream(stem + ".in") << lines;
  const std::string call = command + " < " + stem + ".in > " + stem + ".out 2>&1";
  EXPECT_EQ(std::system(call.c_str()), 0) << command;
  std::stringstream text;
  text << std::ifstream(stem + ".out").rdbuf();
  std::filesystem::remove(stem + ".in");
  std::filesystem::remove(stem + ".out");
  return std::istringstream(text.str());
}

std::string line(std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers) {
    char one[40];
    std::snprintf(one, sizeof one, "%.15g ", number);
    text += one;
  }
  return text + "\n";
}

LonLat random_place(RandomStream& random) {
  const double kind = random.uniform(0, 10);
  if (kind < 1) {
    const double lat = random.uniform(-80, 80);
    const double off = random.uniform(-1, 1) * 0.9 / std::cos(radians(lat));
    return {longitude_near(180 + off, 0), lat};
  }
  if (kind < 2) {
    const double lat = 90 - random.uniform(0, 5);
    return {random.uniform(-180, 180), random.uniform(0, 1) < 0.5 ? lat : -lat};
  }
  return {random.uniform(-180, 180), degrees(std::asin(random.uniform(-1, 1)))};
}

struct Shot {
  LonLat from;
  double bearing_deg;
  double metres;
  LonLat to{0, 0};  ///< by GeodSolve
};

std::vector<Shot> shots(std::size_t count, double longest, std::uint64_t seed) {
  RandomStream random(seed);
  std::vector<Shot> all;
  std::string lines;
  for (std::size_t n = 0; n < count; ++n) {
    all.push_back({random_place(random), random.uniform(-180, 180), random.uniform(1, longest)});
    lines +=
        line({all.back().from[1], all.back().from[0], all.back().bearing_deg, all.back().metres});
  }
  std::istringstream found = answers("GeodSolve -p 9", lines);
  double azimuth = 0;
  for (Shot& shot : all) {
    found >> shot.to[1] >> shot.to[0] >> azimuth;
  }
  EXPECT_TRUE(found);
  return all;
}

double off_m(const LonLat& p, const LonLat& q) {
  const GroundRadii radii = ground_radii(std::min(std::abs(p[1]), 89.999));
  const double east = std::abs(p[1]) > 89.999 ? 1 : radii.east;
  return std::hypot(radians(longitude_near(p[0], q[0]) - q[0]) * east,
                    radians(p[1] - q[1]) * radii.north);
}
}  // namespace

TEST(Earth, Geodesics) {
  if (!has_tools()) {
    GTEST_SKIP() << "needs GeodSolve";
  }
  std::size_t wrong = 0;
  for (const Shot& shot : shots(25'000, 5e6, 1)) {
    wrong += off_m(geodesic_end(shot.from, shot.bearing_deg, shot.metres), shot.to) > kMillimetre;
    wrong += std::abs(geodesic_course(shot.from, shot.to).metres - shot.metres) > kMillimetre;
  }
  EXPECT_EQ(wrong, 0u);
}

TEST(Earth, LegsInALocalFrame) {
  if (!has_tools()) {
    GTEST_SKIP() << "needs GeodSolve";
  }
  std::size_t wrong = 0;
  for (const Shot& shot : shots(25'000, 20'000, 2)) {
    const Frame frame = Frame::local(shot.from);
    const auto [x, y] = frame.to_local(shot.to[0], shot.to[1]);
    // The scale grows to the sides by d² / (2 R²).
    const double slack = shot.metres * shot.metres * shot.metres / (2 * 6.35e6 * 6.35e6);
    wrong += std::abs(std::hypot(x, y) - shot.metres) > kMillimetre + slack;
    const double bearing = radians(90) - std::atan2(y, x);
    const double aside = shot.metres * std::sin(bearing - radians(shot.bearing_deg));
    wrong += std::abs(aside) > kMillimetre + slack;
    wrong += off_m(frame.to_lonlat(x, y), shot.to) > kMillimetre;
  }
  EXPECT_EQ(wrong, 0u);
}

TEST(Earth, CirclesHoldWhatIsWithinTheirRadius) {
  if (!has_tools()) {
    GTEST_SKIP() << "needs GeodSolve";
  }
  RandomStream random(3);
  std::size_t wrong = 0;
  for (const Shot& shot : shots(25'000, 10'000, 3)) {
    // The frame is true elsewhere: up to 20 km from the circle.
    const LonLat middle =
        geodesic_end(shot.from, random.uniform(0, 360), random.uniform(0, 20'000));
    const Frame frame = Frame::local({longitude_near(middle[0], 0), middle[1]});
    const auto [cx, cy] = frame.to_local(shot.from[0], shot.from[1]);
    const auto [x, y] = frame.to_local(shot.to[0], shot.to[1]);
    const double distance = std::hypot(x - cx, y - cy);
    const double outer = formats::radius_in(frame, shot.from, shot.metres, false);
    const double inner = formats::radius_in(frame, shot.from, shot.metres, true);
    wrong += !(distance <= outer + kMillimetre && distance >= inner - kMillimetre);
    wrong += outer - inner > kMillimetre + 1e-4 * shot.metres;
  }
  EXPECT_EQ(wrong, 0u);
}

namespace {

/// A star-shaped ring about a place in longitude and latitude, written with longitudes within 180.
Ring random_ring(RandomStream& random, const LonLat& about, double size_deg) {
  const int corners = 3 + int(random.uniform(0, 9));
  const double wide = 1 / std::max(std::cos(radians(about[1])), 0.02);
  Ring ring;
  for (int n = 0; n < corners; ++n) {
    const double angle = 2 * kPi * (n + 0.8 * random.uniform(0, 1)) / corners;
    const double reach = size_deg * random.uniform(0.2, 1);
    ring.push_back({longitude_near(about[0] + wide * reach * std::cos(angle), 0),
                    std::clamp(about[1] + reach * std::sin(angle), -89.9, 89.9)});
  }
  return ring;
}

/// By crossings in longitude and latitude; also the distance to the nearest edge, in metres.
bool is_inside(const Ring& ring, const LonLat& p, double& edge_m) {
  bool inside = false;
  edge_m = kInfinity;
  const GroundRadii radii = ground_radii(p[1]);
  for (std::size_t n = 0; n < ring.size(); ++n) {
    const Point2& b = ring[(n + 1) % ring.size()];
    // Each edge the short way, as seen from the point.
    const double ax = longitude_near(ring[n][0], p[0]) - p[0];
    const double bx = ax + longitude_near(b[0], ring[n][0]) - ring[n][0];
    const double ay = ring[n][1] - p[1];
    const double by = b[1] - p[1];
    inside ^= (ay > 0) != (by > 0) && ax - ay * (bx - ax) / (by - ay) > 0;
    const double dx = radians(bx - ax) * radii.east;
    const double dy = radians(by - ay) * radii.north;
    const double ox = -radians(ax) * radii.east;
    const double oy = -radians(ay) * radii.north;
    const double share = std::clamp((ox * dx + oy * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    edge_m = std::min(edge_m, std::hypot(ox - share * dx, oy - share * dy));
  }
  return inside;
}

bool holds(const std::vector<Polygon>& parts, double x, double y) {
  for (const Polygon& part : parts) {
    bool inside = false;
    for (std::size_t n = 0; n < part.outline.size(); ++n) {
      const Point2& a = part.outline[n];
      const Point2& b = part.outline[(n + 1) % part.outline.size()];
      inside ^= (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) * (b[0] - a[0]) / (b[1] - a[1]);
    }
    if (inside) {
      return true;
    }
  }
  return false;
}
void expect_rings_hold_what_is_inside_them(std::size_t rings) {
  RandomStream random(4);
  std::size_t wrong = 0;
  std::size_t inside = 0;
  for (std::size_t n = 0; n < rings; ++n) {
    LonLat about = random_place(random);
    about[1] = std::clamp(about[1], -89.0, 89.0);
    const double size = random.uniform(0.01, 0.3);
    const Ring ring = random_ring(random, about, size);
    const double wide = 1 / std::max(std::cos(radians(about[1])), 0.02);
    const LonLat p{longitude_near(about[0] + wide * size * random.uniform(-1, 1), 0),
                   std::clamp(about[1] + size * random.uniform(-1, 1), -89.9, 89.9)};
    const Frame frame = Frame::local(p);
    double edge_m = 0;
    const bool expected = is_inside(ring, p, edge_m);
    const auto parts = formats::in_frame(formats::unfolded(Polygon{ring, {}}), frame);
    inside += expected;
    wrong += edge_m > kMillimetre && holds(parts, 0, 0) != expected;
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(inside, rings / 5);
}

void expect_areas_of_rings(int rings) {
  if (!has_tools()) {
    GTEST_SKIP() << "needs Planimeter";
  }
  RandomStream random(5);
  std::string lines;
  std::vector<double> areas;
  for (int n = 0; n < rings; ++n) {
    LonLat about = random_place(random);
    about[1] = std::clamp(about[1], -88.0, 88.0);
    const Ring ring = random_ring(random, about, 0.05);
    const Frame frame = Frame::local(about);
    double twice = 0;
    for (const Polygon& part :
         formats::in_frame(formats::unfolded(Polygon{ring, {}}), frame, true)) {
      for (std::size_t k = 0; k < part.outline.size(); ++k) {
        twice +=
            formats::cross({0, 0}, part.outline[k], part.outline[(k + 1) % part.outline.size()]);
      }
    }
    areas.push_back(std::abs(twice) / 2);
    constexpr int kPieces = 64;  // geodesics along straight lines of longitude and latitude
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Point2& q = ring[(k + 1) % ring.size()];
      for (int piece = 0; piece < kPieces; ++piece) {
        const double share = double(piece) / kPieces;
        const double lon = ring[k][0] + share * (longitude_near(q[0], ring[k][0]) - ring[k][0]);
        lines += line({ring[k][1] + share * (q[1] - ring[k][1]), lon});
      }
    }
    lines += "\n";
  }
  std::istringstream found = answers("Planimeter -s", lines);
  std::size_t wrong = 0;
  double count = 0;
  double perimeter = 0;
  double area = 0;
  for (const double own : areas) {
    found >> count >> perimeter >> area;
    wrong += std::abs(own - std::abs(area)) > 1e-5 * own + kMillimetre * perimeter;
  }
  EXPECT_TRUE(found);
  EXPECT_EQ(wrong, 0u);
}
}  // namespace

TEST(Earth, RingsHoldWhatIsInsideThem) { expect_rings_hold_what_is_inside_them(4'000); }
TEST(NightlyEarth, RingsHoldWhatIsInsideThem) { expect_rings_hold_what_is_inside_them(25'000); }

TEST(Earth, AreasOfRings) { expect_areas_of_rings(100); }
TEST(NightlyEarth, AreasOfRings) { expect_areas_of_rings(1'000); }

TEST(Earth, EdgesOverMoreThanHalfOfTheEarth) {
  struct Case {
    Ring ring;
    Point2 at;
    bool inside;
  };
  const auto box = [](double west, double south, double east, double north) {
    return Ring{{west, south}, {east, south}, {east, north}, {west, north}};
  };
  const std::vector<Case> cases{{box(-180, -90, 180, 90), {25, 58}, true},
                                {box(-180, -90, 180, 90), {180, 10}, true},
                                {box(-180, -90, 180, 90), {0, 90}, true},
                                {box(-170, -80, 170, 80), {25, 58}, true},
                                {box(-170, -80, 170, 80), {175, 58}, false},
                                {box(-180, -80, 30, 80), {25, 58}, true},
                                {box(-180, -80, 20, 80), {25, 58}, false},
                                {box(-156, 58, -154, 60), {25, 58.9}, false},
                                {box(179, -18, -179, -16), {180, -17}, true},
                                {box(179, -18, -179, -16), {0, -17}, false},
                                {box(-179, -16, 179, -18), {180, -17}, true},
                                {box(170, 58, -170, 60), {-175, 59}, true},
                                {box(0, 80, 90, 90), {45, 89.9}, true},
                                {box(0, 80, 90, 90), {-135, 89.9}, false},
                                // Two readings, drawn either way around: both are closed.
                                {box(170, -20, -169, -14), {-175, -17}, true},
                                {box(-169, -20, 170, -14), {-175, -17}, true},
                                {box(160, 50, -140, 72), {175, 60}, true},
                                {box(-140, 50, 160, 72), {175, 60}, true},
                                {box(163, -90, -131, -5), {178, -17}, true},
                                {box(-131, -90, 163, -5), {178, -17}, true},
                                {box(100, 40, -100, 75), {25, 58}, true},
                                {box(-100, 40, 100, 75), {25, 58}, true},
                                {box(160, 50, -140, 72), {175, 80}, false},
                                // Around the pole, drawn either way around.
                                {{{-150, 70}, {-30, 75}, {90, 72}}, {20, 89}, true},
                                {{{90, 72}, {-30, 75}, {-150, 70}}, {20, 89}, true},
                                {{{90, -72}, {-30, -75}, {-150, -70}}, {20, -89}, true},
                                {{{0, 70}, {90, 70}, {180, 70}, {-90, 70}}, {10, 90}, true},
                                {{{0, 70}, {90, 70}, {180, 70}, {-90, 70}}, {-45, 75}, true},
                                {{{0, 70}, {90, 70}, {180, 70}, {-90, 70}}, {25, 58}, false},
                                {{{0, -70}, {-90, -70}, {180, -70}, {90, -70}}, {10, -85}, true}};
  for (const auto& [ring, at, inside] : cases) {
    const Frame frame = Frame::local(at);
    const auto parts = formats::in_frame(formats::unfolded(Polygon{ring, {}}), frame);
    EXPECT_EQ(holds(parts, 0.01, 0.01), inside)
        << ring[0][0] << " to " << ring[1][0] << " at " << at[0] << ", " << at[1];
  }
}

TEST(Earth, WhatHasTwoReadingsOpensNothing) {
  const Ring wide{{160, 50}, {-140, 50}, {-140, 72}, {160, 72}};
  const Ring world{{-180, -90}, {180, -90}, {180, 90}, {-180, 90}};
  for (const double lon : {175.0, 25.0}) {
    const Frame frame = Frame::local({lon, 60});
    EXPECT_FALSE(
        holds(formats::in_frame(formats::unfolded(Polygon{wide, {}}), frame, true), 0.01, 0.01));
    const Polygon mask = formats::unfolded(Polygon{world, {wide}});
    EXPECT_TRUE(formats::has_two_readings(mask));
    EXPECT_TRUE(holds(formats::in_frame(mask, frame), 0.01, 0.01));
  }
}

/// EGM96 at places that NGA publishes as examples of its program (F477), with what bilinear
/// interpolation in the grid of 15' is off.
TEST(Earth, GeoidIsAboveTheEllipsoidWhereItIsPositive) {
  EXPECT_NEAR(geoid_height(269.4622, 38.6281), -31.628, 0.15);
  EXPECT_NEAR(geoid_height(305.0211, -14.6212), -2.969, 0.05);
  EXPECT_NEAR(geoid_height(102.4485, 46.8743), -43.575, 0.05);
  EXPECT_NEAR(geoid_height(133.8743, -23.6174), 15.871, 0.15);
  EXPECT_NEAR(geoid_height(359.9999, 38.6255), 50.066, 0.05);
  EXPECT_NEAR(geoid_height(-0.0001, 38.6255), 50.066, 0.05);
}

TEST(Earth, SystemsOfFiles) {
  const auto near = [](const std::array<double, 3>& found, const std::array<double, 3>& expected) {
    return off_m({found[0], found[1]}, {expected[0], expected[1]}) < 5 &&
           std::abs(found[2] - expected[2]) < 0.1;
  };
  // The Empire State Building, in US survey feet.
  const MapSystem feet("EPSG:2263");
  EXPECT_NEAR(feet.unit_m(), 1200.0 / 3937, 1e-12);
  EXPECT_TRUE(near(feet.to_wgs84({988217, 211958, 328.083333}), {-73.98566, 40.74844, 100}))
      << feet.to_wgs84({988217, 211958, 328.083333})[0];
  const MapSystem degrees_up("EPSG:4979");
  EXPECT_EQ(degrees_up.unit_m(), 0);
  EXPECT_NEAR(degrees_up.to_wgs84({269.4622 - 360, 38.6281, 0})[2], 31.628, 0.15);
  EXPECT_EQ(MapSystem("EPSG:7415").to_wgs84({155000, 463000, 7})[2], 7);
  EXPECT_THROW(MapSystem("EPSG:1"), std::exception);
}
}  // namespace altiplan::testing::earth_test
