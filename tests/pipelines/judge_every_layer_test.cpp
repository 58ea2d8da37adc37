// SPDX-License-Identifier: Apache-2.0
// The judge over every kind of layer: what is thinner than any sampling is found, touching is free,
// a little nearer is not; and the contract of environment.hpp, on random legs.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <span>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/measures.hpp"
#include "support/support.hpp"

namespace altiplan::judge_every_layer_test {
namespace {

using Made = std::shared_ptr<const Environment>;

/// A model of 41 x 31 posts 100 m apart, flat at 10 m but for the posts given (column, row from the
/// south, height), or of random heights.
Made terrain(const std::vector<std::array<double, 3>>& posts, bool rough = false) {
  constexpr int kColumns = 41;
  constexpr int kRows = 31;
  const auto file = std::filesystem::temp_directory_path() /
                    ("altiplan_judge_" + std::to_string(::getpid()) + ".asc");
  {
    std::ofstream out(file);
    out << "ncols 41\nnrows 31\nxllcorner 500000\nyllcorner 5000000\ncellsize 100\n";
    RandomStream random(7);
    for (int j = kRows - 1; j >= 0; --j) {
      for (int i = 0; i < kColumns; ++i) {
        double height = rough ? 10 + 60 * random.uniform() : 10;
        for (const auto& [column, row, post] : posts) {
          height = column == i && row == j ? post : height;
        }
        out << height << ' ';
      }
      out << '\n';
    }
  }
  Made made =
      testing::make_environment("terrain", "{crs: 'EPSG:32632', file: '" + file.string() + "'}");
  std::filesystem::remove(file);
  return made;
}

Made layer(const char* plugin, const std::string& yaml) {
  return testing::make_environment(plugin, yaml);
}

Made masked_radar(Made ground, const std::string& yaml) {
  World world = testing::world_of(std::move(ground), "ground");
  Site site;
  site.before = &world;
  return testing::make_environment("radar", yaml, site);
}

Made solid(Shape shape) {
  return std::make_shared<kit::ShapeLayer>(std::vector<Shape>{std::move(shape)});
}

const std::string kHills =
    "{base_m: 10, cap_m: 300, peaks: [{at_m: [900, 800], height_m: 120, sigma_m: [250, 400]}, "
    "{at_m: [2500, 2000], height_m: 400, sigma_m: [500, 300]}]}";
/// Outlines with a corner that points in, and a hole.
const std::string kPolygon =
    "{outline_m: [[500, 500], [3000, 600], [2900, 2500], [1700, 1200], [600, 2400]], "
    "holes_m: [[[2300, 900], [2700, 900], [2500, 1200]]]}";

/// Whether the judge lets a vehicle of radius r fly the leg, both ways; the only rule that may
/// speak is the layer's own.
bool free(const Made& environment, const Vec3& a, const Vec3& b, double r) {
  Request request = testing::request_in(testing::world_of(environment), a, b, Box{});
  request.limits.min_clearance = r;
  const bool ok = leg_ok(std::nullopt, a, b, request);
  EXPECT_EQ(leg_ok(std::nullopt, b, a, request), ok);
  for (const Violation& violation : leg_violations(std::nullopt, a, b, request, 0)) {
    EXPECT_EQ(violation.constraint, "clearance") << violation.message;
  }
  EXPECT_EQ(check({a, b}, request).ok(), ok);
  return ok;
}

struct Thin {
  const char* name;
  Made made;
  Vec3 a, b;  ///< a leg that the thin thing is in the way of
  Vec3 off;   ///< and how far the leg is moved to be clear of it
};

std::vector<Thin> thin_things() {
  const Vec3 up(0, 0, 1);
  const Vec3 west(0, 700, 100);
  const Vec3 east(4000, 700, 100);
  std::vector<Thin> things;
  const auto along = [&](const char* name, Made made, const Vec3& off) {
    things.push_back({name, std::move(made), west, east, off});
  };
  things.push_back({"a post 1 cm too high",
                    terrain({{17, 7, 10.01}}),
                    {0, 700, 10.009},
                    {4000, 700, 10.009},
                    up / 100});
  things.push_back({"a needle of hills",
                    layer("hills",
                          "{base_m: 0, cap_m: 900, peaks: [{at_m: [1234.5, 700], height_m: 50, "
                          "sigma_m: [1, 1]}]}"),
                    {0, 700, 49.99},
                    {4000, 700, 49.99},
                    up / 50});
  along("a radar of 5 mm", layer("radar", "{at_m: [1234.567, 700, 100], range_m: 0.005}"),
        up / 100);
  along("a cylinder zone of 5 mm",
        layer("zones", "{list: [{cylinder: {at_m: [1234.567, 700], radius_m: 0.005}}]}"),
        Vec3(0, 0.01, 0));
  along("a wall zone of 1 cm",
        layer("zones",
              "{list: [{polygon: {outline_m: [[1234.5, 0], [1234.51, 0], [1234.51, 900], "
              "[1234.5, 900]]}, ceiling_m: 100.001}]}"),
        up / 100);
  along("a slot of 1 cm into a keep-in zone",
        layer("zones",
              "{list: [{kind: keep_in, polygon: {outline_m: [[-9, 600], [4009, 600], [4009, 800], "
              "[2000.01, 800], [2000.01, 699.99], [2000, 699.99], [2000, 800], [-9, 800]]}}]}"),
        Vec3(0, -0.02, 0));
  along("a sphere of 5 mm", solid(Sphere{{1234.567, 700, 100}, 0.005}), up / 100);
  along("a cylinder of 5 mm", solid(Cylinder{1234.567, 700, 0.005, 0, 200}), Vec3(0, 0.01, 0));
  along("a box 1 cm thick", solid(BoxShape{{{1234.5, 0, 0}, {1234.51, 900, 100.001}}}), up / 100);
  along("a prism 1 cm thick",
        solid(Prism{{{1234.5, 0}, {1234.51, 0}, {1300, 900}}, {}, 0, 100.001}), up / 100);
  return things;
}

TEST(JudgeOfEveryLayer, ThinThingsAreFoundBetweenAnySamples) {
  for (const Thin& thing : thin_things()) {
    EXPECT_FALSE(free(thing.made, thing.a, thing.b, 0)) << thing.name;
    EXPECT_TRUE(free(thing.made, thing.a + thing.off, thing.b + thing.off, 0)) << thing.name;
  }
}

struct Touch {
  const char* name;
  Made made;
  Vec3 a, b;    ///< exactly r away
  Vec3 toward;  ///< the layer, unit
};

TEST(JudgeOfEveryLayer, TouchingIsFreeAndNearerIsNot) {
  const Vec3 down(0, 0, -1);
  const Vec3 north(0, 1, 0);
  for (const double r : {0.0, 5.0}) {
    const double z = 100 + r;
    const double y = 700 - r;
    const Vec3 west(500, 700, z);
    const Vec3 east(3500, 700, z);
    const Vec3 south_west(500, y, 50);
    const Vec3 south_east(3500, y, 50);
    std::vector<Touch> touches{
        {"terrain", terrain({}), {500, 700, 10 + r}, {3500, 700, 10 + r}, down},
        {"plain of hills",
         layer("hills",
               "{base_m: 100, cap_m: 900, peaks: [{at_m: [1e6, 1e6], "
               "height_m: 1, sigma_m: [9, 9]}]}"),
         west, east, down},
        {"radar", layer("radar", "{at_m: [1234.5, 700, 0], range_m: 100}"), west, east, down},
        {"cylinder zone",
         layer("zones", "{list: [{cylinder: {at_m: [2000, 800], radius_m: 100}}]}"), south_west,
         south_east, north},
        {"polygon zone",
         layer("zones",
               "{list: [{polygon: {outline_m: [[900, 700], [1900, 700], [950, 1800]]}, "
               "ceiling_m: 100}]}"),
         south_west, south_east, north},
        {"ceiling of a zone",
         layer("zones",
               "{list: [{polygon: {outline_m: [[900, 600], [1900, 600], [950, 1800]]}, "
               "ceiling_m: 100}]}"),
         west, east, down},
        {"keep-in zone",
         layer("zones",
               "{list: [{kind: keep_in, polygon: {outline_m: [[0, 0], [4000, 0], "
               "[4000, 700], [0, 700]]}}]}"),
         south_west, south_east, north},
        {"sphere", solid(Sphere{{1234.5, 700, 0}, 100}), west, east, down},
        {"cylinder", solid(Cylinder{1234.5, 800, 100, 0, 90}), south_west, south_east, north},
        {"box", solid(BoxShape{{{900, 600, 0}, {1000, 800, 100}}}), west, east, down},
        {"prism", solid(Prism{{{900, 600}, {1900, 600}, {950, 800}}, {}, 0, 100}), west, east,
         down}};
    for (const Touch& touch : touches) {
      EXPECT_TRUE(free(touch.made, touch.a, touch.b, r)) << touch.name << " at " << r;
      const Vec3 nearer = touch.toward * 1e-4;
      EXPECT_FALSE(free(touch.made, touch.a + nearer, touch.b + nearer, r))
          << touch.name << " at " << r;
    }
  }
}

TEST(JudgeOfEveryLayer, WhatTheGroundHidesFromARadarIsFree) {
  // A ridge along x = 2000 up to 210 m; the antenna stands west of it, 110 m high.
  std::vector<std::array<double, 3>> ridge;
  for (int j = 0; j < 31; ++j) {
    ridge.push_back({20, double(j), 210});
  }
  const Made ground = terrain(ridge);
  const Made radar =
      masked_radar(ground, "{at_m: [1000, 1500, 110], range_m: 5000, masking: true}");
  const double slack = radar->over_approximation();
  EXPECT_GT(slack, 0);
  // The line of sight over the ridge rises by a tenth of the way: at x = 3000 it is 310 m high.
  EXPECT_FALSE(free(radar, {3000, 1500, 310}, {3000, 1500, 320}, 0.1));
  EXPECT_FALSE(free(radar, {3000, 1500, 300}, {3000, 1500, 310.01}, 0)) << "1 cm into the sight";
  EXPECT_TRUE(free(radar, {2600, 1400, 40}, {3000, 1500, 100}, 5)) << "in the shadow";
  EXPECT_FALSE(free(radar, {2000, 1500, 211}, {2600, 1500, 40}, 0)) << "from the ridge down";
}

struct Kind {
  const char* name;
  Made made;
};

std::vector<Kind> kinds() {
  const Made rough = terrain({{20, 15, 300}}, true);
  return {{"terrain", rough},
          {"hills", layer("hills", kHills)},
          {"radar", layer("radar", "{at_m: [2000, 1500, 50], range_m: 900}")},
          {"masked radar",
           masked_radar(rough, "{at_m: [1500, 1200, 200], range_m: 1500, masking: true}")},
          {"zones", layer("zones",
                          "{list: [{cylinder: {at_m: [2000, 1500], radius_m: 400}, "
                          "floor_m: 50, ceiling_m: 200}, {polygon: " +
                              kPolygon + ", ceiling_m: 120}]}")},
          {"keep-in zones",
           layer("zones", "{list: [{kind: keep_in, polygon: " + kPolygon + ", ceiling_m: 340}]}")},
          {"sphere", solid(Sphere{{2000, 1500, 100}, 300})},
          {"cylinder", solid(Cylinder{2000, 1500, 500, 20, 180})},
          {"box", solid(BoxShape{{{1500, 900, 0}, {2600, 1800, 150}}})},
          {"prism",
           solid(Prism{
               {{500, 500}, {3000, 600}, {2900, 2500}, {1700, 1200}, {600, 2400}}, {}, 20, 180})}};
}

const Box kAround{{-600, -600, -60}, {4600, 3600, 420}};

TEST(LawsOfEveryLayer, HoldOnRandomLegs) {
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(kind.name);
    const Environment& made = *kind.made;
    RandomStream random(11);
    int blocked_legs = 0;
    int free_legs = 0;
    for (int n = 0; n < 1500; ++n) {
      const Vec3 a = random.in(kAround);
      const double reach = n % 3 == 0 ? 3000 : n % 3 == 1 ? 200 : 5;
      const Vec3 b =
          a + reach * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.1, 0.1));
      const double run = (b - a).norm();
      const double r = random.uniform(0, 40);
      EXPECT_LE(std::abs(made.clearance(a) - made.clearance(b)), run * (1 + 1e-9) + 1e-9);
      const bool blocked = made.blocked(a, b, r);
      (blocked ? blocked_legs : free_legs) += 1;
      EXPECT_EQ(blocked, made.blocked(b, a, r)) << "symmetric";
      EXPECT_TRUE(blocked || !made.blocked(a, b, r * random.uniform())) << "monotone in r";
      constexpr int kSamples = 40;
      double least = kInfinity;
      for (int k = 0; k <= kSamples; ++k) {
        const Vec3 on = k == kSamples ? b : Vec3(a + (b - a) * k / kSamples);
        const double clearance = made.clearance(on);
        least = std::min(least, clearance);
        EXPECT_TRUE(blocked || clearance > -1e-5) << "a sample lies inside";
        EXPECT_TRUE(blocked || !made.blocked(on, on, r)) << "a sample is blocked";
        // Points inside the solid that lie around the leg.
        const Vec3 side =
            on + random.uniform(0, r) *
                     Vec3(random.normal(), random.normal(), random.normal()).normalized();
        EXPECT_TRUE(blocked || made.clearance(side) > -1e-5 || (side - on).norm() > r - 1e-5);
      }
      // What the samples' clearances, 1-Lipschitz, prove to be free.
      if (least - run / kSamples / 2 > r * (1 + 1e-9) + made.over_approximation() + 1e-6) {
        EXPECT_FALSE(blocked) << "clearance " << least << " over r " << r;
      }
    }
    EXPECT_GT(blocked_legs, 20);
    EXPECT_GT(free_legs, 20);
  }
}

/// The distance between a leg and the ground about it: the best of a grid of places, each of the
/// thirty best looked at finer and finer.
double sampled_distance(const Environment& made, const Vec3& a, const Vec3& b, double reach) {
  struct Place {
    double distance, x, y;
  };
  const auto place = [&](double x, double y) {
    const Vec3 point(x, y, *made.ground()->height(x, y));
    return Place{point_leg_distance(point, a, b), x, y};
  };
  const auto nearer = [](const Place& p, const Place& q) { return p.distance < q.distance; };
  const Box box = leg_box(a, b).grown(reach);
  constexpr double kStep = 4;
  std::vector<Place> places;
  for (double x = box.min.x(); x <= box.max.x(); x += kStep) {
    for (double y = box.min.y(); y <= box.max.y(); y += kStep) {
      places.push_back(place(x, y));
    }
  }
  std::partial_sort(places.begin(), places.begin() + 30, places.end(), nearer);
  Place best = places.front();
  for (Place at : std::span(places).first(30)) {
    for (double half = kStep; half > 1e-4; half *= 0.7) {
      const Place from = at;
      for (int n = 0; n < 81; ++n) {
        at = std::min(at, place(from.x + half * (n % 9 - 4) / 4, from.y + half * (n / 9 - 4) / 4),
                      nearer);
      }
    }
    best = std::min(best, at, nearer);
  }
  return best.distance;
}

TEST(LawsOfEveryLayer, ClearanceFromGroundIsTheDistance) {
  // A plateau of 160 m on the flank of the higher hill.
  const std::string cut = "{base_m: 10, cap_m: 160, " + kHills.substr(kHills.find("peaks"));
  for (const Kind& kind :
       {Kind{"terrain", terrain({{20, 15, 200}}, true)}, Kind{"hills", layer("hills", kHills)},
        Kind{"hills with a plateau", layer("hills", cut)}}) {
    SCOPED_TRACE(kind.name);
    RandomStream random(19);
    for (int n = 0; n < 40; ++n) {
      Vec3 a(random.uniform(500, 3500), random.uniform(500, 2500), 0);
      Vec3 b = a + 100 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 0);
      a.z() = *kind.made->ground()->height(a.x(), a.y()) + random.uniform(30, 60);
      b = n % 4 == 0 ? a : Vec3(b.x(), b.y(), *kind.made->ground()->height(b.x(), b.y()) + 30);
      const double gap = kind.made->ground()->gap(a, b);
      if (gap < 5) {
        continue;
      }
      EXPECT_NEAR(leg_clearance(*kind.made, a, b), sampled_distance(*kind.made, a, b, gap), 1e-3)
          << n;
    }
  }
}

TEST(LawsOfEveryLayer, RasterLeavesNoTouchedCellFree) {
  GridSpec spec;
  spec.origin = {-500, -400, -20};
  spec.cell = {130, 110, 25};
  spec.counts = {37, 36, 16};
  for (const Kind& kind : kinds()) {
    for (const double inflation : {0.0, 30.0}) {
      SCOPED_TRACE(kind.name);
      spec.inflation = inflation;
      VoxelGrid grid(spec);
      kind.made->rasterize(grid);
      RandomStream random(13);
      int free_cells = 0;
      for (int n = 0; n < 20000; ++n) {
        const Vec3 p = random.in(spec.box());
        if (grid.blocked(spec.cell_of(p))) {
          continue;
        }
        ++free_cells;
        EXPECT_GT(kind.made->clearance(p), -1e-6) << "the point lies inside";
        const Vec3 q = p + random.uniform(0, inflation) *
                               Vec3(random.normal(), random.normal(), random.normal()).normalized();
        EXPECT_GT(kind.made->clearance(q), -1e-6) << "inside, within the inflation";
      }
      EXPECT_GT(free_cells, 200);
      EXPECT_GT(grid.blocked_count(), 20u);
    }
  }
}
}  // namespace
}  // namespace altiplan::judge_every_layer_test
