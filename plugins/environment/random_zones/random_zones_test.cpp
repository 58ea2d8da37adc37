// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "framework/shape_oracle.hpp"
#include "support/support.hpp"

namespace altiplan::random_zones_test {
namespace {

using oracle::Point2;
using testing::make_environment;

std::vector<Shape> zones(const std::string& yaml) {
  const Drawing drawing = make_environment("random_zones", yaml)->drawing().value();
  std::vector<Shape> shapes;
  for (const Drawn& drawn : drawing.shapes) {
    shapes.push_back(drawn.shape);
  }
  return shapes;
}

/// A circle as a ring of points: the coordinates are treated as metres.
std::vector<Point2> outline(const Shape& shape) {
  if (const auto* prism = std::get_if<Prism>(&shape)) {
    return prism->outline;
  }
  const auto& cylinder = std::get<Cylinder>(shape);
  std::vector<Point2> ring;
  for (int n = 0; n < 90; ++n) {
    ring.push_back({cylinder.x + cylinder.radius * std::cos(n * kPi / 45),
                    cylinder.y + cylinder.radius * std::sin(n * kPi / 45)});
  }
  return ring;
}

double between(const std::vector<Point2>& ring, const std::vector<Point2>& other) {
  double minimum = kInfinity;
  for (const Point2& p : ring) {
    for (std::size_t n = 0; n < other.size(); ++n) {
      minimum =
          std::min(minimum, oracle::to_edge(other[n], other[(n + 1) % other.size()], p[0], p[1]));
    }
  }
  return minimum;
}

TEST(RandomZones, FirstOnesOfSeedOne) {
  // Compared with exact values: a changed generator would produce other maps for the same seeds.
  SplitMix64 random(1);
  const auto in = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  const std::string open = "{seed: 1, gap_m: 0, clear_of_m: [], bars_across: 0, extent_m: ";
  // A rectangle so large that no zone is rejected (the zone's middle is far from its sides).
  const std::vector<Shape> all = zones(open + "[1e8, 1e8], bars: 1, blocks: 1, circles: 1}");
  ASSERT_EQ(all.size(), 3U);

  double x = in(0, 1e8);
  double y = in(0, 1e8);
  const double direction = in(0, 2 * kPi);
  const double length = in(260, 400);
  const double width = in(30, 60);
  const double bend = in(-1, 1) * kPi / 3;
  const auto& bar = std::get<Prism>(all[0]).outline;
  ASSERT_EQ(bar.size(), 6U);
  const Point2 end = {(bar[2][0] + bar[3][0]) / 2, (bar[2][1] + bar[3][1]) / 2};
  const double ahead = direction + bend / 2;
  EXPECT_NEAR(end[0], x + length / 2 * std::cos(ahead), 1e-6);
  EXPECT_NEAR(end[1], y + length / 2 * std::sin(ahead), 1e-6);
  EXPECT_NEAR(std::hypot(bar[2][0] - bar[3][0], bar[2][1] - bar[3][1]), width, 1e-6);
  EXPECT_NEAR(std::hypot(bar[0][0] - bar[5][0], bar[0][1] - bar[5][1]), width, 1e-6);
  // Both halves have the same width everywhere: their long sides run at the same distance from the
  // middle.
  const auto beside = [&](const Point2& p, const Point2& q) {
    return std::abs(oracle::cross(p, q, {x, y})) / std::hypot(q[0] - p[0], q[1] - p[1]);
  };
  for (const int n : {0, 1, 3, 4}) {
    EXPECT_NEAR(beside(bar[std::size_t(n)], bar[std::size_t(n) + 1]), width / 2, 1e-6) << n;
  }

  x = in(0, 1e8);
  y = in(0, 1e8);
  const int corners = 3 + int(in(0, 4));
  const double turn = in(0, 2 * kPi);
  const double reach = in(105, 155);
  const auto& block = std::get<Prism>(all[1]).outline;
  ASSERT_EQ(int(block.size()), corners);
  for (int n = 0; n < corners; ++n) {
    const double angle = turn + 2 * kPi * (n + in(-0.2, 0.2)) / corners;
    const double far = reach * in(0.7, 1);
    EXPECT_NEAR(block[std::size_t(n)][0], x + far * std::cos(angle), 1e-6);
    EXPECT_NEAR(block[std::size_t(n)][1], y + far * std::sin(angle), 1e-6);
  }

  const auto& circle = std::get<Cylinder>(all[2]);
  EXPECT_EQ(circle.x, in(0, 1e8));
  EXPECT_EQ(circle.y, in(0, 1e8));
  EXPECT_EQ(circle.radius, in(58, 90));
}

TEST(RandomZones, KeepApartAndOffThePoints) {
  for (int seed = 1; seed <= 40; ++seed) {
    const std::vector<Shape> all = zones("{seed: " + std::to_string(seed) + "}");
    ASSERT_EQ(all.size(), 10U);
    for (std::size_t n = 0; n < all.size(); ++n) {
      EXPECT_EQ(std::holds_alternative<Cylinder>(all[n]), n >= 6);
      const std::vector<Point2> ring = outline(all[n]);
      for (const Point2& p : ring) {
        EXPECT_GE(std::min({p[0], p[1], 1000 - p[0], 660 - p[1]}), 25 - 1e-9);
      }
      EXPECT_GE(between({{30, 30}, {970, 630}}, ring), 60 - 1e-9);
      for (std::size_t m = 0; m < n; ++m) {
        const std::vector<Point2> other = outline(all[m]);
        // The rings of points lie within their circles, so this never understates a distance.
        EXPECT_GE(std::min(between(ring, other), between(other, ring)), 25 - 1e-9) << seed;
        EXPECT_GT(signed_distance(all[m], {ring[0][0], ring[0][1], 0}), 0) << "one in the other";
        EXPECT_GT(signed_distance(all[n], {other[0][0], other[0][1], 0}), 0);
      }
      if (n < 2) {
        EXPECT_EQ(leg_distance(all[n], {30, 30, 0}, {970, 630, 0}), 0) << "a bar across";
      }
    }
  }
}

TEST(RandomZones, AMapIsItsSeed) {
  const auto first = make_environment("random_zones", "{seed: 3}");
  const auto again = make_environment("random_zones", "{seed: 3}");
  const auto other = make_environment("random_zones", "{seed: 4}");
  bool differs = false;
  for (double x = 0; x < 1000; x += 50) {
    const Vec3 p(x, 330, -7);
    EXPECT_EQ(first->clearance(p), again->clearance(p));
    differs = differs || first->clearance(p) != other->clearance(p);
  }
  EXPECT_TRUE(differs);
}

TEST(RandomZones, RefusesWhatDoesNotFit) {
  const auto problems = [](const std::string& yaml) {
    return testing::parameter_problems("environment", "random_zones", yaml);
  };
  EXPECT_EQ(problems("{seed: 1}"), "");
  EXPECT_NE(problems("{bars: 1}").find("bars_across"), std::string::npos);
  EXPECT_NE(problems("{clear_of_m: []}").find("clear_of_m"), std::string::npos);
  EXPECT_NE(problems("{radius_m: [9, 8]}").find("minimum"), std::string::npos);
  EXPECT_NE(problems("{bar_length_m: [50, 60], bend_deg: 90}").find("too short"),
            std::string::npos);
  EXPECT_NE(problems("{seed: -1}"), "");
  EXPECT_THROW(make_environment("random_zones", "{seed: 1, blocks: 200}"), Error);
}
}  // namespace
}  // namespace altiplan::random_zones_test
