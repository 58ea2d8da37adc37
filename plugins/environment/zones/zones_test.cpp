// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "altiplan/voxel_grid.hpp"
#include "altiplan/world.hpp"
#include "support/support.hpp"

namespace altiplan::testing::zones_test {
namespace {

const World kNothing;
constexpr double kNoon = 1560772800;  // 2019-06-17T12:00:00Z

Site site_of() {
  Site site;
  site.before = &kNothing;
  return site;
}

Site site_at(double start_time_s) {
  Site site = site_of();
  site.has_start_time = true;
  site.start_time_s = start_time_s;
  return site;
}

std::unique_ptr<Environment> zones(const std::string& yaml, const Site& site = site_of()) {
  return make_environment("zones", yaml, site);
}

std::string refusal(const std::string& yaml, const Site& site = site_of()) {
  try {
    zones(yaml, site);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string written(const std::string& name, const std::string& text) {
  const std::string file = ::testing::TempDir() + "zones_" + name + ".geojson";
  std::ofstream(file) << text;
  return file;
}

std::string feature(const std::string& coordinates, const std::string& properties = "{}",
                    const std::string& type = "Polygon") {
  return R"({"type": "Feature", "id": "Z1", "properties": )" + properties +
         R"(, "geometry": {"type": ")" + type + R"(", "coordinates": )" + coordinates + "}}";
}

TEST(Zones, KeepOutCylinderHasFloorCeilingAndThreat) {
  const auto layer = zones(
      "{list: [{id: tower, cylinder: {at_m: [100, 200], radius_m: 50}, floor_m: 10, ceiling_m: "
      "90}]}");
  EXPECT_NEAR(layer->clearance({100, 200, 50}), -40, 1e-9);
  EXPECT_NEAR(layer->clearance({180, 200, 130}), 50, 1e-9);
  EXPECT_TRUE(layer->blocked({0, 200, 50}, {300, 200, 50}, 1));
  EXPECT_FALSE(layer->blocked({0, 200, 92}, {300, 200, 92}, 2));
  ASSERT_EQ(layer->info().threats.size(), 1U);
  EXPECT_EQ(layer->info().threats[0].id, "tower");
  EXPECT_EQ(layer->info().threats[0].kind, "zone");
  EXPECT_EQ(layer->over_approximation(), 0);
}

TEST(Zones, PolygonWithAHoleIsFreeInTheHole) {
  const auto layer = zones(
      "{list: [{polygon: {outline_m: [[0, 0], [100, 0], [100, 100], [0, 100], [0, 0]],"
      " holes_m: [[[40, 40], [60, 40], [60, 60], [40, 60]]]}}]}");
  EXPECT_NEAR(layer->clearance({50, 50, 1e5}), 10, 1e-9);
  EXPECT_NEAR(layer->clearance({20, 50, -1e5}), -20, 1e-9);
  EXPECT_FALSE(layer->blocked({45, 45, 0}, {55, 55, 900}, 5));
  EXPECT_TRUE(layer->blocked({45, 45, 0}, {55, 55, 900}, 5.1));
}

TEST(Zones, ABufferIsKeptFromAllZones) {
  const std::string out = "list: [{id: tower, cylinder: {at_m: [100, 200], radius_m: 50}}]}";
  const auto plain = zones("{" + out);
  const auto layer = zones("{buffer_m: 30, " + out);
  EXPECT_NEAR(layer->clearance({200, 200, 0}), 20, 1e-9);
  EXPECT_TRUE(layer->blocked({190, 0, 0}, {190, 400, 0}, 10.1));
  EXPECT_FALSE(layer->blocked({190, 0, 0}, {190, 400, 0}, 10));
  EXPECT_EQ(layer->bounds().max.x(), 180);
  EXPECT_EQ(layer->info().threats[0].radius, 80);
  EXPECT_EQ(std::get<Cylinder>(layer->drawing()->shapes[0].shape).radius, 50) << "as published";
  layer->near({200, 200, 0}, 20, [&](const Nearby& near) {
    EXPECT_NEAR(near.distance, 20, 1e-9);
    EXPECT_NEAR(near.point.x(), 180, 1e-9);
  });
  GridSpec spec{{0, 0, 0}, {10, 10, 10}, {30, 40, 1}};
  VoxelGrid grown(spec);
  layer->rasterize(grown);
  spec.inflation = 30;
  VoxelGrid inflated(spec);
  plain->rasterize(inflated);
  EXPECT_EQ(grown.words(), inflated.words());
}

TEST(Zones, ABufferIsKeptInsideFences) {
  const auto layer = zones(
      "{buffer_m: 20, list: [{kind: keep_in, floor_m: 0, ceiling_m: 100, polygon: {outline_m: "
      "[[0, 0], [100, 0], [100, 100], [0, 100]]}}]}");
  EXPECT_NEAR(layer->clearance({50, 50, 50}), 30, 1e-9);
  EXPECT_FALSE(layer->blocked({50, 20, 50}, {50, 80, 50}, 0));
  EXPECT_TRUE(layer->blocked({50, 20, 50}, {50, 81, 50}, 0));
  EXPECT_TRUE(layer->blocked({50, 50, 50}, {50, 50, 81}, 0)) << "the ceiling has one too";
}

TEST(Zones, ClippingKeepsWhatABufferReaches) {
  Site site = site_of();
  site.volume = {{0, 0, 0}, {100, 100, 100}};
  const auto layer =
      zones("{clip: true, buffer_m: 30, file: " +
                written("beyond", R"({"type": "FeatureCollection", "features": [)" +
                                      feature("[[[0.002, 0], [0.003, 0], [0.003, 0.001], [0.002, "
                                              "0.001], [0.002, 0]]]") +
                                      "]}") +
                "}",
            [&] {
              site.frame = Frame::local({0.0009, 0});
              return site;
            }());
  EXPECT_TRUE(layer->blocked({95, 50, 50}, {95, 60, 50}, 0)) << "22 m east of the bounds";
}

TEST(Zones, KeepInBlocksAllOutsideOfTheUnion) {
  const auto layer = zones(
      "{list: [{kind: keep_in, polygon: {outline_m: [[0, 0], [100, 0], [100, 100], [0, 100]]},"
      " floor_m: 0, ceiling_m: 100},"
      " {kind: keep_in, cylinder: {at_m: [120, 50], radius_m: 50}, floor_m: 0, ceiling_m: 200}]}");
  EXPECT_FALSE(layer->blocked({10, 50, 50}, {160, 50, 50}, 10));
  EXPECT_TRUE(layer->blocked({10, 50, 50}, {160, 50, 50}, 10.1));  // its ends are 10 m deep
  EXPECT_FALSE(layer->blocked({50, 50, 50}, {120, 50, 50}, 15));
  EXPECT_TRUE(layer->blocked({50, 50, 50}, {120, 50, 50}, 15.1));  // the overlap is 30 m wide
  EXPECT_TRUE(layer->blocked({10, 50, 50}, {200, 50, 50}, 0));     // leaves
  EXPECT_TRUE(layer->blocked({50, 50, 50}, {50, 50, 150}, 0));
  EXPECT_FALSE(layer->blocked({0, 0, 0}, {100, 0, 0}, 0));      // along the border
  EXPECT_TRUE(layer->blocked({90, 99, 50}, {150, 85, 50}, 0));  // out and in again
  EXPECT_NEAR(layer->clearance({50, 50, 30}), 30, 1e-9);
  EXPECT_NEAR(layer->clearance({50, 50, -30}), -30, 1e-9);
  EXPECT_EQ(layer->bounds().max.x(), kInfinity);
}

constexpr const char* kTwoFences =
    "list: [{kind: keep_in, polygon: {outline_m: [[0, 0], [100, 0], [100, 100], [0, 100]]}},"
    " {kind: keep_in, cylinder: {at_m: [120, 50], radius_m: 50}}]";

TEST(Zones, KeepInAllBlocksAllOutsideOfTheIntersection) {
  const auto layer = zones(std::string("{keep_in: all, ") + kTwoFences + "}");
  EXPECT_NEAR(layer->clearance({90, 50, 0}), 10, 1e-9);
  EXPECT_NEAR(layer->clearance({50, 50, 0}), -20, 1e-9);   // outside of the circle alone
  EXPECT_NEAR(layer->clearance({130, 50, 0}), -30, 1e-9);  // outside of the square alone
  EXPECT_FALSE(layer->blocked({80, 50, 0}, {90, 50, 900}, 10));
  EXPECT_TRUE(layer->blocked({80, 50, 0}, {90, 50, 900}, 10.1));
  EXPECT_TRUE(layer->blocked({50, 50, 0}, {130, 50, 0}, 0));
  EXPECT_TRUE(layer->drawing()->keeps_in_all);
  EXPECT_FALSE(zones(std::string("{") + kTwoFences + "}")->drawing()->keeps_in_all);
  int count = 0;
  layer->near({90, 50, 0}, 40, [&](const Nearby&) { ++count; });
  EXPECT_EQ(count, 2) << "each fence's border is an obstacle";
}

// The free space of `all` is the intersection of the zones': what blocks is the union of what
// each alone blocks, so its distances and its legs are those of the nearest.
TEST(Zones, KeepInAllIsAsStrictAsEachZoneAlone) {
  RandomStream random;
  const auto number = [](double value) { return std::to_string(value); };
  for (int n = 0; n < 200; ++n) {
    std::string list;
    std::vector<std::unique_ptr<Environment>> alone;
    const int count = 1 + int(random.uniform(0, 4));
    for (int k = 0; k < count; ++k) {
      const double x = random.uniform(-30, 30);
      const double y = random.uniform(-30, 30);
      std::string zone = "{kind: keep_in, floor_m: " + number(random.uniform(-60, 0)) + ", ";
      if (k % 3 == 2) {
        zone += "cylinder: {at_m: [" + number(x) + ", " + number(y) +
                "], radius_m: " + number(random.uniform(30, 90)) + "}}";
      } else {  // star-shaped, hence without a crossing; mostly concave
        zone += "polygon: {outline_m: [";
        const int corners = 3 + int(random.uniform(0, 7));
        for (int c = 0; c < corners; ++c) {
          const double angle = 2 * kPi * c / corners;
          const double radius = random.uniform(40, 120);
          zone += (c > 0 ? ", [" : "[") + number(x + radius * std::cos(angle)) + ", " +
                  number(y + radius * std::sin(angle)) + "]";
        }
        zone += "]}}";
      }
      list += (k > 0 ? ", " : "") + zone;
      alone.push_back(zones("{list: [" + zone + "]}"));
    }
    const auto all = zones("{keep_in: all, list: [" + list + "]}");
    const auto place = [&] {
      return Vec3(random.uniform(-120, 120), random.uniform(-120, 120), random.uniform(-70, 70));
    };
    for (int m = 0; m < 50; ++m) {
      const Vec3 a = place();
      const Vec3 b = m % 2 == 0 ? place() : Vec3(a + 0.1 * place());
      const double r = random.uniform(0, 20);
      double nearest = kInfinity;
      bool is_blocked = false;
      for (const auto& one : alone) {
        nearest = std::min(nearest, one->clearance(a));
        is_blocked = is_blocked || one->blocked(a, b, r);
      }
      EXPECT_EQ(all->clearance(a), nearest) << list;
      EXPECT_EQ(all->blocked(a, b, r), is_blocked) << list;
    }
  }
}

// Sampled depths compared with the exact result, including zones with concave outlines.
TEST(Zones, KeepInLegsAgreeWithSamples) {
  const auto layer = zones(
      "{list: [{kind: keep_in, polygon: {outline_m: [[0, 0], [90, 10], [50, 40], [100, 100],"
      " [30, 60], [5, 95]], holes_m: [[[20, 20], [30, 22], [25, 40]]]}, floor_m: 0, ceiling_m: 50},"
      " {kind: keep_in, cylinder: {at_m: [70, 45], radius_m: 40}, floor_m: 10, ceiling_m: 80}]}");
  RandomStream random;
  int free_legs = 0;
  for (int n = 0; n < 4000; ++n) {
    const Vec3 a(random.uniform(0, 110), random.uniform(0, 100), random.uniform(0, 80));
    const Vec3 b =
        a + Vec3(random.uniform(-40, 40), random.uniform(-40, 40), random.uniform(-9, 9));
    double minimum = kInfinity;
    for (int m = 0; m <= 2000; ++m) {
      minimum = std::min(minimum, layer->clearance(a + m / 2000.0 * (b - a)));
    }
    const double spacing = (b - a).norm() / 2000;
    if (minimum <= 0) {
      continue;
    }
    ++free_legs;
    EXPECT_TRUE(layer->blocked(a, b, minimum + 2e-6)) << n;
    if (minimum > spacing) {
      EXPECT_FALSE(layer->blocked(a, b, minimum - spacing)) << n;
    }
  }
  EXPECT_GT(free_legs, 300);
}

TEST(Zones, KeepInRasterizesConvexZonesExactly) {
  const auto layer = zones(
      "{list: [{kind: keep_in, polygon: {outline_m: [[2, 2], [8, 2], [8, 8], [2, 8]]},"
      " floor_m: 1, ceiling_m: 5}]}");
  GridSpec spec;
  spec.counts = {10, 10, 10};
  VoxelGrid grid(spec);
  layer->rasterize(grid);
  EXPECT_EQ(1000 - grid.blocked_count(), 6U * 6 * 4);
  spec.inflation = 1;
  VoxelGrid grown(spec);
  layer->rasterize(grown);
  EXPECT_EQ(1000 - grown.blocked_count(), 4U * 4 * 2);
}

TEST(Zones, TimeWindowsMeetTheHorizon) {
  const std::string window =
      "{list: [{cylinder: {at_m: [0, 0], radius_m: 5}, from: '2019-06-17T13:00:00Z',"
      " until: '2019-06-17T14:30Z'}], horizon_s: 1800}";
  EXPECT_EQ(zones(window, site_at(kNoon))->clearance({0, 0, 0}), kInfinity);
  EXPECT_EQ(zones(window, site_at(kNoon + 1800))->clearance({0, 0, 0}), -5);  // 12:30 to 13:00
  EXPECT_EQ(zones(window, site_at(kNoon + 9000))->clearance({0, 0, 0}), -5);  // 14:30
  EXPECT_EQ(zones(window, site_at(kNoon + 9001))->clearance({0, 0, 0}), kInfinity);
  EXPECT_TRUE(says(refusal(window), "start_time"));
  EXPECT_TRUE(says(
      refusal("{list: [{cylinder: {at_m: [0, 0], radius_m: 5}, from: tomorrow}]}", site_at(kNoon)),
      "tomorrow"));
  EXPECT_TRUE(says(refusal("{list: [{cylinder: {at_m: [0, 0], radius_m: 5},"
                           " until: '2019-02-29T00:00:00Z'}]}",
                           site_at(kNoon)),
                   "2019-02-29"));
}

TEST(Zones, GeoJsonBringsAFrameHeightsAndHoles) {
  const std::string file = written(
      "plain",
      feature("[[[25, 60], [25.1, 60], [25.1, 60.1], [25, 60.1], [25, 60]],"
              " [[25.04, 60.04], [25.06, 60.04], [25.06, 60.06], [25.04, 60.06], [25.04, 60.04]]]",
              R"({"low": 100, "high": "450.5"})"));
  const auto layer = zones("{file: " + file + ", floor_property: low, ceiling_property: high}");
  ASSERT_TRUE(layer->info().frame.has_value());
  const auto corner = layer->info().frame->to_local(25, 60);
  EXPECT_NEAR(std::hypot(corner[0], corner[1]), 0, 1e-6);
  const auto middle = layer->info().frame->to_local(25.05, 60.05);
  EXPECT_GT(layer->clearance({middle[0], middle[1], 200}), 500);
  const auto solid = layer->info().frame->to_local(25.02, 60.02);
  EXPECT_NEAR(layer->clearance({solid[0], solid[1], 440}), -10.5, 1e-6);
  EXPECT_NEAR(layer->clearance({solid[0], solid[1], 90}), 10, 1e-6);
  Site placed = site_of();
  placed.frame = Frame::geographic(24, 59, 60);
  EXPECT_FALSE(zones("{file: " + file + "}", placed)->info().frame.has_value());
}

TEST(Zones, RefusesBadFilesWithThePlace) {
  const auto refused = [](const std::string& name, const std::string& text) {
    return refusal("{file: " + written(name, text) + ", floor_property: low}");
  };
  EXPECT_TRUE(says(refusal("{file: /nowhere.geojson}"), "there is no such file"));
  const std::string triangle = "[[[0, 0], [1, 0], [1, 1], [0, 0]]]";
  EXPECT_TRUE(says(
      refusal("{file: " + written("limits", feature(triangle, R"({"ceiling_m": 90})")) + "}"),
      "has the property 'ceiling_m', which is not read: expected ceiling_property: ceiling_m"));
  EXPECT_TRUE(says(refused("cut", R"({"type": "Feat)"), "not valid JSON"));
  EXPECT_TRUE(says(refused("kind", R"({"type": "Topology"})"), "Topology"));
  EXPECT_TRUE(
      says(refused("open", feature("[[[0, 0], [1, 0], [1, 1], [0, 1]]]")), "end where it starts"));
  EXPECT_TRUE(says(refused("range", feature("[[[0, 0], [190, 0], [1, 1], [0, 0]]]")), "190"));
  const auto kept_in = [](const std::string& name, const std::string& rings) {
    return refusal("{file: " + written(name, feature(rings)) + ", file_kind: keep_in}");
  };
  const std::string bow = kept_in("bow", "[[[0, 0], [2, 2], [2, 0], [0, 2], [0, 0]]]");
  EXPECT_TRUE(says(bow, "meets itself at (1, 1)")) << bow;
  EXPECT_TRUE(says(bow, "Z1"));
  EXPECT_TRUE(
      says(kept_in("hole", "[[[0, 0], [2, 0], [2, 2], [0, 0]], [[5, 5], [6, 5], [6, 6], [5, 5]]]"),
           "outside"));
  EXPECT_TRUE(says(
      refused("height", feature("[[[0, 0], [2, 0], [2, 2], [0, 0]]]", R"({"low": "surface"})")),
      "surface"));
  EXPECT_TRUE(says(refused("type", feature("[]", "{}", "Curve")), "Curve"));
  EXPECT_TRUE(says(refused("cut", "{\n\"type\":\n"),
                   ":3:1: is not valid JSON: it ends early or has an error here"));
  EXPECT_TRUE(says(refused("large", "[1e400]"), "a number that is too large"));
  EXPECT_TRUE(says(refused("deep", std::string(100, '[') + std::string(100, ']')),
                   "nested more than 64 levels deep"));
  EXPECT_TRUE(
      says(refused("property", feature("[[[0, 0], [2, 0], [2, 2], [0, 0]]]", R"({"lower": 1})")),
           "no feature has the property 'low'; present: lower"));
}

TEST(Zones, RefusesWrongParameters) {
  EXPECT_EQ(parameter_problems("environment", "zones",
                               "{list: [{cylinder: {at_m: [0, 0], radius_m: 5}}]}"),
            "");
  for (const char* wrong :
       {"{}", "{list: [{}]}", "{list: [{cylinder: {at_m: [0, 0], radius_m: -5}}]}",
        "{list: [{polygon: {}}]}",
        "{list: [{cylinder: {at_m: [0, 0], radius_m: 5}, floor_m: 9, ceiling_m: 3}]}",
        "{list: [{kind: maybe, cylinder: {at_m: [0, 0], radius_m: 5}}]}"}) {
    EXPECT_NE(parameter_problems("environment", "zones", wrong), "") << wrong;
  }
  EXPECT_TRUE(says(refusal("{list: [{polygon: {outline_m: [[0, 0], [2, 2], [2, 0], [0, 2]]}}]}"),
                   "(1, 1)"));
  EXPECT_NE(refusal("{list: [{cylinder: {at_lonlat: [25, 60], radius_m: 5}}]}"), "");
}

/// A zone that is not active all the time gives no room before or after.
TEST(Zones, KeepInZonesGiveRoomAllTheTime) {
  const auto zone = [](int west, const char* window) {
    const std::string w = std::to_string(west);
    const std::string e = std::to_string(west + 100);
    return "{kind: keep_in, polygon: {outline_m: [[" + w + ", 0], [" + e + ", 0], [" + e +
           ", 100], [" + w + ", 100]]}" + window + "}";
  };
  const std::string later = ", from: 2019-06-17T12:30:00Z";
  const std::string earlier = ", until: 2019-06-17T12:30:00Z";
  const auto two =
      zones("{list: [" + zone(0, "") + ", " + zone(90, later.c_str()) + "]}", site_at(kNoon));
  EXPECT_GT(two->clearance({50, 50, 10}), 0);
  EXPECT_LT(two->clearance({150, 50, 10}), 0);
  const auto in_turn =
      zones("{list: [" + zone(0, earlier.c_str()) + ", " + zone(90, later.c_str()) + "]}",
            site_at(kNoon));
  EXPECT_GT(in_turn->clearance({95, 50, 10}), 0);
  EXPECT_LT(in_turn->clearance({50, 50, 10}), 0);
  EXPECT_LT(in_turn->clearance({150, 50, 10}), 0);
}

TEST(Zones, ReadsFinnishZones) {
  ALTIPLAN_DATA_OR_SKIP(folder, "city");
  const auto restricted =
      zones("{file: " + (folder / "finland_rajoitukset.geojson").string() + "}");
  EXPECT_EQ(restricted->info().notes.front(),
            "51 polygons read, 0 features without an area skipped");
  const auto loviisa = restricted->info().frame->to_local(26.35, 60.37);
  EXPECT_LT(restricted->clearance({loviisa[0], loviisa[1], 300}), 0);
  EXPECT_TRUE(says(
      zones("{file: " + (folder / "finland_valvottu.geojson").string() + "}")->info().notes.front(),
      "28 polygons"));
  EXPECT_TRUE(says(zones("{file: " + (folder / "finland_lennatyspaikat.geojson").string() + "}")
                       ->info()
                       .notes.front(),
                   "84 features without an area skipped"));
  const std::string timed = "{file: " + (folder / "finland_sup.geojson").string() +
                            ", from_property: timeBegin, until_property: timeEnd}";
  EXPECT_EQ(zones(timed, site_at(kNoon))->info().notes.back(),
            "1 keep-out and 0 keep-in zones, 2 not active");
  EXPECT_TRUE(says(refusal(timed), "start_time"));
}
}  // namespace
}  // namespace altiplan::testing::zones_test
