// SPDX-License-Identifier: Apache-2.0
#include "reference/circle_visibility.hpp"

#include <gtest/gtest.h>

#include "reference/visibility_graph.hpp"

namespace altiplan::reference::circle_visibility_test {
namespace {

TEST(CircleVisibility, LengthsKnownByHand) {
  EXPECT_DOUBLE_EQ(CircleVisibility({}).shortest({0, 0}, {3, 4}), 5);

  // Around one disc: two tangents of sqrt(d² - r²), and the rim between them.
  const CircleVisibility one({{{0, 0}, 1}});
  EXPECT_NEAR(one.shortest({-2, 0}, {2, 0}), 2 * std::sqrt(3) + kPi / 3, 1e-12);
  EXPECT_NEAR(one.shortest({-2, 1}, {2, 1}), 4, 1e-12) << "along it";
  EXPECT_NEAR(one.shortest({-1, 0}, {1, 0}), kPi, 1e-9) << "from rim to rim";
  EXPECT_EQ(one.shortest({0.5, 0}, {2, 0}), kInfinity) << "from inside";

  // Between two discs, over one and under the other: by the inner tangent.
  const CircleVisibility two({{{0, -0.5}, 1}, {{6, 0.5}, 1}});
  const double distance = std::hypot(6, 1);
  const double straight = two.shortest({-20, -0.25}, {26, 0.25});
  EXPECT_GT(straight, 46);
  EXPECT_LT(straight, 46.2);
  EXPECT_GT(two.shortest({0, 0.5}, {6, -0.5}), std::sqrt(distance * distance - 4));

  // Two that overlap are passed around, two that touch are passed between.
  const CircleVisibility overlap({{{0, -0.9}, 1}, {{0, 0.9}, 1}});
  EXPECT_GT(overlap.shortest({-3, 0}, {3, 0}), 2 * std::hypot(3, 1.9));
  const CircleVisibility gap({{{0, -1}, 1}, {{0, 1}, 1}});
  EXPECT_NEAR(gap.shortest({-3, 0}, {3, 0}), 6, 1e-6);

  // A ring of discs.
  std::vector<Circle> ring;
  for (int n = 0; n < 12; ++n) {
    ring.push_back({{10 * std::cos(n * kPi / 6), 10 * std::sin(n * kPi / 6)}, 3});
  }
  EXPECT_EQ(CircleVisibility(ring).shortest({0, 0}, {20, 0}), kInfinity);
  ring.pop_back();
  EXPECT_LT(CircleVisibility(ring).shortest({0, 0}, {20, 0}), 30);
}

std::vector<Circle> random_circles(std::uint64_t seed, int count) {
  oracle::Draw draw(seed);
  std::vector<Circle> circles;
  while (int(circles.size()) < count) {
    const Circle circle{{draw(0, 100), draw(0, 100)}, draw(2, 16)};
    if (std::hypot(circle.centre[0], circle.centre[1]) > circle.radius &&
        std::hypot(circle.centre[0] - 100, circle.centre[1] - 100) > circle.radius) {
      circles.push_back(circle);
    }
  }
  return circles;
}

/// The regular polygon whose corners are at `reach` from the middle.
Polygon regular(const Circle& circle, double reach, int corners) {
  Polygon polygon;
  for (int n = 0; n < corners; ++n) {
    const double angle = 2 * kPi * n / corners;
    polygon.push_back(
        {circle.centre[0] + reach * std::cos(angle), circle.centre[1] + reach * std::sin(angle)});
  }
  return polygon;
}

/// Polygons inside the discs leave a way that is not longer, polygons around them one not shorter,
/// among other polygons too, which overlap discs and each other and may be concave.
TEST(CircleVisibility, LiesBetweenThoseOfPolygons) {
  constexpr int kCorners = 14;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const std::vector<Circle> circles = random_circles(seed, 4);
    std::vector<Polygon> polygons;
    oracle::Draw draw(seed);
    while (polygons.size() < seed / 2) {
      const double x = draw(10, 90);
      const double y = draw(10, 90);
      const oracle::Solid star = oracle::star(draw, x, y, 25, 5, false, 0, 1);
      const Polygon& outline = std::get<Prism>(star.shape).outline;
      if (!VisibilityGraph({outline}).is_inside_one({0, 0}) &&
          !VisibilityGraph({outline}).is_inside_one({100, 100})) {
        polygons.push_back(outline);
      }
    }
    std::vector<Polygon> inner = polygons;
    std::vector<Polygon> outer = polygons;
    for (const Circle& circle : circles) {
      inner.push_back(regular(circle, circle.radius, kCorners));
      outer.push_back(regular(circle, circle.radius / std::cos(kPi / kCorners), kCorners));
    }
    const double exact = CircleVisibility(circles, polygons).shortest({0, 0}, {100, 100});
    const double least = VisibilityGraph(inner).shortest({0, 0}, {100, 100});
    const double most = VisibilityGraph(outer).shortest({0, 0}, {100, 100});
    EXPECT_GE(exact, least - 1e-9) << seed;
    EXPECT_LE(exact, most + 1e-9) << seed;
    EXPECT_LT(most - least, 4) << seed << ": these say little";
  }
}

/// Without discs it is the other reference.
TEST(CircleVisibility, IsThatOfPolygonsAmongPolygons) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    oracle::Draw draw(seed);
    std::vector<Polygon> polygons;
    for (int n = 0; n < 6; ++n) {
      const double x = draw(10, 90);
      const double y = draw(10, 90);
      polygons.push_back(
          std::get<Prism>(oracle::star(draw, x, y, 20, 6, false, 0, 1).shape).outline);
    }
    EXPECT_EQ(CircleVisibility({}, polygons).shortest({-20, 30}, {120, 60}),
              VisibilityGraph(polygons).shortest({-20, 30}, {120, 60}))
        << seed;
  }
}

TEST(CircleVisibility, AroundACornerAndADisc) {
  // Under a box's corners, then over a disc that stands against another box.
  const CircleVisibility both({{{8, 1}, 1}}, {rectangle(2, -1, 4, 5), rectangle(7, -6, 9, 1)});
  const double to_rim = std::sqrt(std::pow(8 - 4, 2) + std::pow(1 + 1, 2) - 1);
  const double angle = std::atan2(-2, -4) - std::acos(1 / std::hypot(4, 2));
  const double away = kPi / 2;  // the goal is level with the disc's top
  EXPECT_NEAR(both.shortest({0, -1}, {12, 2}), 4 + to_rim + (angle + 2 * kPi - away) + 4, 1e-9);
}

/// Turned, mirrored and from the other end the length is the same; one more disc, not shorter.
TEST(CircleVisibility, KeepsItsLaws) {
  int bent = 0;
  for (std::uint64_t seed = 100; seed < 130; ++seed) {
    std::vector<Circle> circles = random_circles(seed, 12);
    const Point2 start{0, 0};
    const Point2 goal{100, 100};
    const double plain = CircleVisibility(circles).shortest(start, goal);
    bent += plain < kInfinity && plain > std::hypot(100, 100) + 1e-6;
    const auto same = [plain](double other) {
      return plain == kInfinity ? other == kInfinity : std::abs(other - plain) < 1e-7;
    };
    EXPECT_TRUE(same(CircleVisibility(circles).shortest(goal, start))) << seed;
    const double angle = double(seed);
    const auto turned = [&](const Point2& p) {
      return Point2{std::cos(angle) * p[0] - std::sin(angle) * p[1],
                    -std::sin(angle) * p[0] - std::cos(angle) * p[1]};
    };
    std::vector<Circle> other = circles;
    for (Circle& circle : other) {
      circle.centre = turned(circle.centre);
    }
    EXPECT_TRUE(same(CircleVisibility(other).shortest(turned(start), turned(goal)))) << seed;
    circles.push_back(random_circles(seed + 1000, 1).front());
    EXPECT_GE(CircleVisibility(circles).shortest(start, goal), plain - 1e-9) << seed;
  }
  EXPECT_GT(bent, 20);
}
}  // namespace
}  // namespace altiplan::reference::circle_visibility_test
