// SPDX-License-Identifier: Apache-2.0
#include "reference/visibility_graph.hpp"

#include <gtest/gtest.h>

#include "framework/shape_oracle.hpp"
#include "support/support.hpp"

namespace altiplan::reference::visibility_graph_test {
namespace {

TEST(VisibilityGraph, LengthsKnownByHand) {
  const VisibilityGraph empty({});
  EXPECT_DOUBLE_EQ(empty.shortest({0, 0}, {3, 4}), 5);

  // Over the near corners of a box in the way.
  const VisibilityGraph box({rectangle(4, -1, 6, 3)});
  EXPECT_DOUBLE_EQ(box.shortest({0, 0}, {10, 0}), 2 * std::hypot(4, 1) + 2);
  EXPECT_DOUBLE_EQ(box.shortest({0, -1}, {10, -1}), 10);  // along its edge
  EXPECT_DOUBLE_EQ(box.shortest({4, 3}, {6, -1}), 6);     // from corner to corner, not through
  EXPECT_DOUBLE_EQ(box.shortest({0, 3}, {0, -1}), 4);

  // Into and out of a U.
  const VisibilityGraph trap({{{0, 0}, {5, 0}, {5, 4}, {0, 4}, {0, 3}, {4, 3}, {4, 1}, {0, 1}}});
  EXPECT_DOUBLE_EQ(trap.shortest({3, 2}, {7, 2}), std::hypot(3, 1) + 1 + 5 + std::hypot(2, 2));

  // Between two boxes that share a corner, or an edge, a point may pass.
  const VisibilityGraph corner({rectangle(0, 0, 1, 1), rectangle(1, 1, 2, 2)});
  EXPECT_DOUBLE_EQ(corner.shortest({0.5, 1.5}, {1.5, 0.5}), std::sqrt(2.0));

  // A ring of overlapping boxes.
  const VisibilityGraph ring({rectangle(0, 0, 10, 1), rectangle(0, 9, 10, 10),
                              rectangle(0, 0, 1, 10), rectangle(9, 0, 10, 10)});
  EXPECT_EQ(ring.shortest({5, 5}, {20, 5}), kInfinity);
}

Polygon random_convex(oracle::Draw& draw) {
  const double x = draw(15, 85);
  const double y = draw(15, 85);
  const int corners = 3 + draw.below(4);
  const double size = draw(4, 14);
  const double turn = draw(0, 2 * kPi);
  Polygon polygon;
  for (int n = 0; n < corners; ++n) {
    const double angle = turn + 2 * kPi * (n + draw(-0.3, 0.3)) / corners;
    polygon.push_back({x + size * std::cos(angle), y + size * std::sin(angle)});
  }
  return polygon;
}

/// A fine lattice with long moves comes near to the exact length from above; the kit's shapes say
/// what it may cross.
TEST(VisibilityGraph, IsTheLimitOfFineLattices) {
  int bent = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    oracle::Draw draw(seed);
    std::vector<Polygon> polygons;
    std::vector<Shape> shapes;
    for (int n = 0; n < 6; ++n) {
      polygons.push_back(random_convex(draw));
      shapes.emplace_back(Prism{polygons.back(), {}, -10, 10});
    }
    const double exact = VisibilityGraph(polygons).shortest({1, 1}, {99, 99});
    ASSERT_GE(exact, std::hypot(98, 98) * (1 - 1e-12));
    bent += exact > std::hypot(98, 98) * (1 + 1e-9);
    Request request = testing::request_in(testing::world_of(shapes), {1, 1, 0}, {99, 99, 0},
                                          {{-20, -20, -1}, {120, 120, 1}});
    request.level_m = 0;
    const auto planned = testing::make_planner("astar", "{cell_m: [0.5, 0.5, 1]}")->plan(request);
    ASSERT_EQ(planned.status, PlanStatus::solved) << seed;
    const double lattice = length(planned.route);
    EXPECT_GE(lattice, exact * (1 - 1e-9)) << seed;
    // Eight directions are at most 8.24 % longer; the rest is for the cells beside the corners.
    EXPECT_LE(lattice, exact * 1.0824 + 10 * 0.5) << seed;
  }
  EXPECT_GT(bent, 6);
}

/// Turned, mirrored and from the other end the length is the same; one more polygon, not shorter.
TEST(VisibilityGraph, KeepsItsLaws) {
  for (std::uint64_t seed = 100; seed < 125; ++seed) {
    oracle::Draw draw(seed);
    std::vector<Polygon> polygons;
    for (int n = 0; n < 8; ++n) {
      polygons.push_back(random_convex(draw));
    }
    const Point2 start = {0, draw(0, 100)};
    const Point2 goal = {100, draw(0, 100)};
    const double plain = VisibilityGraph(polygons).shortest(start, goal);
    EXPECT_NEAR(VisibilityGraph(polygons).shortest(goal, start), plain, 1e-9);
    const double angle = draw(0, 2 * kPi);
    const auto turned = [&](const Point2& p) {
      return Point2{std::cos(angle) * p[0] - std::sin(angle) * p[1],
                    -std::sin(angle) * p[0] - std::cos(angle) * p[1]};
    };
    std::vector<Polygon> other = polygons;
    for (Polygon& polygon : other) {
      std::transform(polygon.begin(), polygon.end(), polygon.begin(), turned);
    }
    EXPECT_NEAR(VisibilityGraph(other).shortest(turned(start), turned(goal)), plain, 1e-7) << seed;
    polygons.push_back(random_convex(draw));
    EXPECT_GE(VisibilityGraph(polygons).shortest(start, goal), plain - 1e-9) << seed;
  }
}
}  // namespace
}  // namespace altiplan::reference::visibility_graph_test
