// SPDX-License-Identifier: Apache-2.0
// Fences made small enough for autopilots, compared with their zones at random points.
#include "host/import_export/fence_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "altiplan/geometry.hpp"

namespace altiplan::host::fence_fit_test {
namespace {

using formats::Point2;
using formats::Restriction;
using formats::Ring;
using formats::Zone;

constexpr double kMetre = 1 / 111'320.0;  // degrees

bool is_inside(const Ring& ring, const Point2& p) {
  bool inside = false;
  for (std::size_t n = 0; n < ring.size(); ++n) {
    const Point2& a = ring[n];
    const Point2& b = ring[(n + 1) % ring.size()];
    if ((a[1] > p[1]) != (b[1] > p[1]) &&
        p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) {
      inside = !inside;
    }
  }
  return inside;
}

/// True if an autopilot with that fence stops there.
bool is_closed(const std::vector<Zone>& zones, const Point2& p) {
  return std::any_of(zones.begin(), zones.end(), [&](const Zone& zone) {
    const formats::ZoneVolume& volume = zone.volumes.front();
    if (volume.polygon.outline.empty()) {
      const bool inside = geodesic_course(volume.centre, p).metres < volume.radius_m;
      return inside != zone.keeps_in();
    }
    const auto& holes = volume.polygon.holes;
    const bool inside =
        is_inside(volume.polygon.outline, p) &&
        (!zone.keeps_in() || std::none_of(holes.begin(), holes.end(),
                                          [&](const Ring& hole) { return is_inside(hole, p); }));
    return inside != zone.keeps_in();
  });
}

Zone zone_of(Ring ring, bool keeps_in) {
  Zone zone;
  zone.restriction = keeps_in ? Restriction::keep_in : Restriction::keep_out;
  zone.volumes = {{{std::move(ring), {}}, {}, {}}};
  return zone;
}

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  /// A star around a place, with corners that point in and out.
  Ring star(const Point2& at, double radius_m, int corners) {
    Ring ring;
    for (int n = 0; n < corners; ++n) {
      const double angle = 2 * kPi * n / corners;
      const double reach = radius_m * between(0.6, 1) * kMetre;
      ring.push_back({at[0] + reach * std::cos(angle) / std::cos(radians(at[1])),
                      at[1] + reach * std::sin(angle)});
    }
    return ring;
  }

 private:
  std::mt19937 random_;
};

/// Zones around a route to the east along 46.5° N, and one about all of them.
std::vector<Zone> random_zones(Draw& draw, std::size_t count, int corners) {
  std::vector<Zone> zones{zone_of(draw.star({14.25, 46.5}, 60'000, 300), true)};
  while (zones.size() <= count) {
    const double radius = draw.between(300, 4000);
    const Point2 at{draw.between(13.9, 14.6), draw.between(46.3, 46.7)};
    if (std::abs(at[1] - 46.5) < (radius + 100) * kMetre) {
      continue;
    }
    if (zones.size() % 5 == 0) {
      Zone circle = zone_of({}, false);
      circle.volumes.front().centre = at;
      circle.volumes.front().radius_m = radius;
      zones.push_back(circle);
    } else {
      zones.push_back(zone_of(draw.star(at, radius, corners), false));
    }
  }
  return zones;
}

const Ring kRoute{{14.0, 46.5}, {14.2, 46.5002}, {14.5, 46.5}};

TEST(FenceFit, NothingThatAZoneClosesIsOpenAndTheRouteStays) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Draw draw(seed);
    const std::vector<Zone> zones = random_zones(draw, 4 + 3 * seed, 5 + int(seed));
    for (const VehicleType vehicle : {VehicleType::copter, VehicleType::plane}) {
      std::vector<Zone> fence = zones;
      const FenceLimits limits = fence_limits(vehicle);
      const std::vector<std::string> notes = fit_fence(fence, kRoute, limits);
      const FenceLimits size = fence_size(fence);
      EXPECT_LE(size.points, limits.points) << seed;
      EXPECT_LE(size.bytes, limits.bytes) << seed;
      EXPECT_EQ(notes.size(), 1U) << seed;
      std::size_t closed = 0;
      for (int n = 0; n < 10'000; ++n) {
        const Point2 p{draw.between(13.3, 15.2), draw.between(45.9, 47.1)};
        if (is_closed(zones, p)) {
          ++closed;
          ASSERT_TRUE(is_closed(fence, p)) << seed << ": " << p[0] << ", " << p[1];
        }
        const double share = draw.between(0, 1);
        const Point2& from = kRoute[n % 2];
        const Point2& to = kRoute[n % 2 + 1];
        ASSERT_FALSE(is_closed(
            fence, {from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])}))
            << seed;
      }
      EXPECT_GT(closed, 2000U);
    }
  }
}

TEST(FenceFit, AFenceThatFitsStaysAsItIs) {
  Draw draw(7);
  std::vector<Zone> fence{zone_of(draw.star({14.1, 46.4}, 2000, 9), false), zone_of({}, false),
                          zone_of(draw.star({14.25, 46.5}, 50'000, 6), true)};
  fence[1].volumes.front().centre = {14.3, 46.6};
  fence[1].volumes.front().radius_m = 700;
  fence[0].name = "a";
  const std::vector<Zone> before = fence;
  EXPECT_TRUE(fit_fence(fence, kRoute, {}).empty());
  ASSERT_EQ(fence.size(), 3U);
  EXPECT_EQ(fence[0].name, "a");
  EXPECT_EQ(fence[1].volumes.front().radius_m, 700);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(fence[n].volumes.front().polygon.outline.size(),
              before[n].volumes.front().polygon.outline.size());
  }
}

std::vector<Zone> row_of_circles(bool keeps_in) {
  std::vector<Zone> circles;
  for (int n = 0; n < 70; ++n) {
    Zone circle = zone_of({}, keeps_in);
    circle.volumes.front().centre = {14 + 0.01 * n, 46.6};
    circle.volumes.front().radius_m = keeps_in ? 200'000 : 200;
    circles.push_back(circle);
  }
  return circles;
}

TEST(FenceFit, CirclesAreJoinedWhereTheyAreTooMany) {
  const std::vector<Zone> circles = row_of_circles(false);
  std::vector<Zone> fence = circles;
  EXPECT_EQ(fit_fence(fence, kRoute, {}).size(), 1U);
  EXPECT_LE(fence_size(fence).points, 64U);
  EXPECT_LE(fence_size(fence).bytes, 560U);
  Draw draw(1);
  for (int n = 0; n < 10'000; ++n) {
    const Point2 p{draw.between(13.9, 14.8), draw.between(46.59, 46.61)};
    ASSERT_TRUE(!is_closed(circles, p) || is_closed(fence, p)) << p[0] << ", " << p[1];
  }
}

TEST(FenceFit, CornersOnStraightEdgesGo) {
  Ring ring;
  const Ring square{{14, 46.4}, {14.4, 46.4}, {14.4, 46.6}, {14, 46.6}};
  for (std::size_t n = 0; n < 4; ++n) {
    for (int k = 0; k < 5; ++k) {
      const Point2& a = square[n];
      const Point2& b = square[(n + 1) % 4];
      ring.push_back({a[0] + k / 5.0 * (b[0] - a[0]), a[1] + k / 5.0 * (b[1] - a[1])});
    }
  }
  for (const bool keeps_in : {true, false}) {
    std::vector<Zone> fence{zone_of(ring, keeps_in)};
    EXPECT_TRUE(fit_fence(fence, {{14.1, 46.5}, {14.3, 46.5}}, {}).empty());
    EXPECT_EQ(fence.front().volumes.front().polygon.outline.size(), 4U);
  }
}

TEST(FenceFit, WhatDoesNotFitIsSaid) {
  std::vector<Zone> circles = row_of_circles(true);
  const std::vector<std::string> notes = fit_fence(circles, kRoute, {});
  EXPECT_EQ(circles.size(), 70U);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes.front().find("has 70 points and does not fit: PX4 holds 64"), std::string::npos);
}

TEST(FenceFit, AcrossTheLineOfDates) {
  std::vector<Zone> fence{zone_of({}, false)};
  for (int n = 0; n < 90; ++n) {
    const double angle = 2 * kPi * n / 90;
    fence[0].volumes.front().polygon.outline.push_back(
        {longitude_near(180 + 0.2 * std::cos(angle), 0), 0.2 * std::sin(angle)});
  }
  EXPECT_EQ(fit_fence(fence, {{179, 1}, {-179, 1}}, {}).size(), 1U);
  const Ring& ring = fence.front().volumes.front().polygon.outline;
  EXPECT_LE(ring.size(), 64U);
  for (const Point2& p : ring) {
    EXPECT_GT(std::abs(p[0]), 179.7);
    EXPECT_LE(std::abs(p[0]), 180);
  }
}
}  // namespace
}  // namespace altiplan::host::fence_fit_test
