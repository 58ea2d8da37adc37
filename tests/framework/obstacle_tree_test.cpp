// SPDX-License-Identifier: Apache-2.0
// The tree of an obstacle set changes no bit of an answer: each is compared with the closed forms
// asked for every shape in turn.
#include <gtest/gtest.h>

#include <algorithm>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "framework/shape_oracle.hpp"

namespace altiplan::kit::obstacle_tree_test {
namespace {

using oracle::Draw;

double clearance(const std::vector<Shape>& shapes, const Vec3& p) {
  double least = kInfinity;
  for (const Shape& shape : shapes) {
    least = std::min(least, signed_distance(shape, p));
  }
  return least;
}

// As the contract has it: nearer than r - 1e-6 m, or, for what is as good as a point, inside.
bool blocked(const std::vector<Shape>& shapes, const Vec3& a, const Vec3& b, double r) {
  const double limit = r - kLengthTolerance;
  return std::any_of(shapes.begin(), shapes.end(), [&](const Shape& shape) {
    const double distance = leg_distance(shape, a, b);
    return distance < limit || (limit <= 1e-9 && distance <= 1e-9 &&
                                -leg_depth(shape, a, b) < r - kLengthTolerance / 2);
  });
}

std::vector<int> near(const std::vector<Shape>& shapes, const Vec3& p, double reach) {
  std::vector<int> ids;
  for (std::size_t id = 0; id < shapes.size(); ++id) {
    if (signed_distance(shapes[id], p) <= reach) {
      ids.push_back(int(id));
    }
  }
  return ids;
}

std::vector<Shape> random_shapes(Draw& draw, int count, const Vec3& middle, double scale,
                                 double size) {
  std::vector<Shape> shapes;
  for (int n = 0; n < count; ++n) {
    const Vec3 at = middle + draw.point(scale);
    shapes.push_back(oracle::random_solid(draw, at, size * draw(0.1, 1)).shape);
  }
  return shapes;
}

// Asks for a place on, in and beside the shapes, and for legs and radii that just touch.
void compare(const std::vector<Shape>& shapes, Draw& draw, const Vec3& middle, double scale,
             int queries) {
  const ObstacleSet set(shapes);
  for (int n = 0; n < queries; ++n) {
    Vec3 a = middle + draw.point(1.2 * scale);
    if (n % 4 == 0 && !shapes.empty()) {
      a = nearest_surface_point(shapes[std::size_t(draw.below(int(shapes.size())))], a);
    }
    const Vec3 b = n % 3 == 0 ? middle + draw.point(scale) : Vec3(a + draw.point(0.1 * scale));
    const Vec3 up = n % 5 == 0 ? Vec3(a.x(), a.y(), b.z()) : b;
    ASSERT_EQ(set.clearance(a), clearance(shapes, a));
    ASSERT_EQ(set.clearance(b), clearance(shapes, b));
    double least = kInfinity;
    for (const Shape& shape : shapes) {
      least = std::min(least, leg_distance(shape, a, up));
    }
    const double edge = std::isfinite(least) ? least + kLengthTolerance : 1;
    for (const double r : {0.0, draw(0, 0.05 * scale), draw(0, 1e-6), edge, edge + 1e-9,
                           edge - 1e-9, std::nextafter(edge, kInfinity), -0.01 * scale}) {
      ASSERT_EQ(set.blocked(a, up, r), blocked(shapes, a, up, r)) << n << ", radius " << r;
    }
    ASSERT_EQ(set.blocked(a, a, edge), blocked(shapes, a, a, edge));
    for (const double reach : {draw(0, 0.1 * scale), clearance(shapes, a), -0.01 * scale}) {
      std::vector<int> ids;
      set.near(a, reach, [&](const Nearby& nearby) { ids.push_back(nearby.id); });
      ASSERT_EQ(ids, near(shapes, a, reach)) << n << ", reach " << reach;
    }
  }
}

void compare_many(int share) {
  Draw draw(1);
  for (const int count : {0, 1, 2, 7, 8, 9, 63, 64, 65, 200, 513, 5000, 20000}) {
    const int queries = (count > 5000 ? 10 : count > 1000 ? 60 : 300) / share;
    for (const double size : {0.02, 0.3}) {
      const std::vector<Shape> shapes = random_shapes(draw, count, {0, 0, 0}, 1000, 1000 * size);
      compare(shapes, draw, {0, 0, 0}, 1000, queries);
    }
  }
}

TEST(ObstacleTree, AnswersAreThoseOfEveryShapeInTurn) { compare_many(4); }
TEST(NightlyObstacleTree, AnswersAreThoseOfEveryShapeInTurn) { compare_many(1); }

TEST(ObstacleTree, FarFromTheOriginToo) {
  Draw draw(2);
  for (const double far : {1e3, 1e6, 1e8}) {
    for (const double scale : {1.0, 100.0, 1e5}) {
      const Vec3 middle = draw.point(far);
      const std::vector<Shape> shapes = random_shapes(draw, 90, middle, scale, 0.2 * scale);
      compare(shapes, draw, middle, scale, 300);
    }
  }
}

TEST(ObstacleTree, EndlessHugeAndTinyShapes) {
  Draw draw(3);
  std::vector<Shape> shapes = random_shapes(draw, 40, {0, 0, 0}, 100, 20);
  shapes.emplace_back(BoxShape{{{50, -kInfinity, -kInfinity}, {60, kInfinity, kInfinity}}});
  shapes.emplace_back(BoxShape{{{-1e17, -1e17, -1e17}, {1e17, 1e17, -90}}});
  shapes.emplace_back(Cylinder{1e6, 0, 1e6 - 80, -kInfinity, kInfinity});
  shapes.emplace_back(Sphere{{0, 3e16, 0}, 1});
  for (int n = 0; n < 20; ++n) {
    shapes.emplace_back(Sphere{draw.point(100), n % 2 == 0 ? 0.0 : 1e-9});
  }
  compare(shapes, draw, {0, 0, 0}, 100, 1500);
  const ObstacleSet set(shapes);
  for (const double far : {1e14, 1e16, 1e19, 1e300}) {
    const Vec3 p(far, -far, 0);
    EXPECT_EQ(set.clearance(p), clearance(shapes, p)) << far;
    EXPECT_EQ(set.blocked({-far, 1, 2}, {far, 2, 1}, 1),
              blocked(shapes, {-far, 1, 2}, {far, 2, 1}, 1))
        << far;
    EXPECT_EQ(set.blocked({0, 0, 0}, {1, 1, 1}, far), blocked(shapes, {0, 0, 0}, {1, 1, 1}, far));
  }
}

TEST(ObstacleTree, BoxesInFacesAndEqualShapes) {
  Draw draw(4);
  std::vector<Shape> shapes;
  for (int n = 0; n < 300; ++n) {  // whole numbers, so that faces, edges and corners meet
    const Vec3 low(draw.below(10), draw.below(10), draw.below(10));
    shapes.emplace_back(BoxShape{{low, low + Vec3(1, 1 + draw.below(2), 1)}});
  }
  const ObstacleSet set(shapes);
  for (int n = 0; n < 3000; ++n) {
    const auto half = [&] { return 0.5 * draw.below(24) - 1; };
    const Vec3 a(half(), half(), half());
    const Vec3 b(half(), half(), n % 2 == 0 ? a.z() : half());
    ASSERT_EQ(set.clearance(a), clearance(shapes, a));
    for (const double r : {0.0, 0.5, 0.5 + kLengthTolerance, 1.0}) {
      ASSERT_EQ(set.blocked(a, b, r), blocked(shapes, a, b, r));
    }
  }
}

TEST(ObstacleTree, ALimitIsDecidedAsTheDistanceDoes) {
  Draw draw(5);
  for (int n = 0; n < 15000; ++n) {
    const double scale = std::exp(draw(0, std::log(1e6)));
    const Shape shape = oracle::random_solid(draw, draw.point(scale), 0.4 * scale).shape;
    const Vec3 a = draw.point(scale);
    const Vec3 b = n % 2 == 0 ? draw.point(scale) : Vec3(a + 0.01 * draw.point(scale));
    const double distance = leg_distance(shape, a, b);
    for (const double limit :
         {0.0, 1e-9, distance, std::nextafter(distance, kInfinity), distance * (1 + 1e-12),
          distance * (1 - 1e-12), distance + 1e-9, distance - 1e-9, draw(0, scale)}) {
      ASSERT_EQ(comes_within(shape, a, b, limit), distance < limit)
          << shape.index() << ' ' << distance << ' ' << limit;
    }
  }
}
}  // namespace
}  // namespace altiplan::kit::obstacle_tree_test
