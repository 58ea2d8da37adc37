// SPDX-License-Identifier: Apache-2.0
// Prisms with many corners answer through a tree over their edges: the same as the plain loops over
// all edges, which the functions on shapes are.
#include <gtest/gtest.h>

#include "altiplan/formats/polygon.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"
#include "framework/shape_oracle.hpp"

namespace altiplan::many_corners_test {
namespace {

using oracle::Draw;
using oracle::Point2;
using Ring = std::vector<Point2>;

/// Corners on whole numbers: many share a coordinate, follow each other on a line, or are the same.
Ring castle(Draw& draw, int teeth, double x, double y) {
  Ring ring;
  for (int n = 0; n < teeth; ++n) {
    const double high = 1 + draw.below(4);
    ring.push_back({x + 2 * n, y});
    ring.push_back({x + 2 * n, y + high});
    ring.push_back({x + 2 * n + 0.5, y + high});
    if (draw.below(3) == 0) {
      ring.push_back(ring.back());
    }
    ring.push_back({x + 2 * n + 1, y + high});
    ring.push_back({x + 2 * n + 1, y});
  }
  for (int n = 4 * teeth; n >= 0; --n) {
    ring.push_back({x - 1 + n * 0.5, y - 2});
  }
  return ring;
}

Ring square(double x, double y, double half) {
  return {{x - half, y - half}, {x + half, y - half}, {x + half, y + half}, {x - half, y + half}};
}

Prism random_prism(Draw& draw, int kind) {
  Prism prism;
  if (kind == 0) {
    prism = std::get<Prism>(oracle::star(draw, draw(-50, 50), 3, 40, 50 + draw.below(400),
                                         draw.below(2) == 0, -5, draw(0, 5))
                                .shape);
  } else if (kind == 1) {
    prism.outline = castle(draw, 10 + draw.below(50), -20, 1);
  } else {
    prism.outline = square(0, 0, 30);
    for (int n = 0; n < 25; ++n) {
      prism.holes.push_back(square(-24 + 12 * (n % 5), -24 + 12 * (n / 5), 1 + draw.below(4)));
    }
  }
  prism.floor = draw.below(4) == 0 ? -kInfinity : -5;
  prism.ceiling = draw.below(4) == 0 ? kInfinity : 5;
  return prism;
}

/// Somewhere about the prism; every second time at a corner, on an edge or in line with a corner.
Vec3 place(Draw& draw, const Prism& prism) {
  const Ring& ring = prism.holes.empty() || draw.below(2) == 0
                         ? prism.outline
                         : prism.holes[std::size_t(draw.below(int(prism.holes.size())))];
  const auto size = int(ring.size());
  const int n = draw.below(size);
  const Point2& e = ring[std::size_t(n)];
  const Point2& f = ring[std::size_t((n + 1) % size)];
  const double z = draw.below(3) == 0 ? 5 : draw(-8, 8);
  switch (draw.below(6)) {
    case 0:
      return {e[0], e[1], z};
    case 1:
      return {(e[0] + f[0]) / 2, (e[1] + f[1]) / 2, z};
    case 2:
      return {draw(-100, 100), e[1], z};
    default:
      return {draw(-70, 70), draw(-60, 60), z};
  }
}

Vec3 other_end(Draw& draw, const Prism& prism, const Vec3& a) {
  Vec3 b = place(draw, prism);
  if (const int bent = draw.below(6); bent < 3) {
    b[bent] = a[bent];  // along an axis, level, or both
  }
  return draw.below(20) == 0 ? Vec3(a.x(), a.y(), b.z()) : b;
}

TEST(ManyCorners, PointsAnswerAsThePlainLoopDoes) {
  Draw draw(1);
  for (int n = 0; n < 45; ++n) {
    const Prism prism = random_prism(draw, n % 3);
    const Shape shape = prism;
    const kit::ObstacleSet set({shape});
    for (int m = 0; m < 100; ++m) {
      const Vec3 p = place(draw, prism);
      ASSERT_EQ(set.clearance(p), signed_distance(shape, p)) << n << ": " << p.transpose();
      set.near(p, 20, [&](const Nearby& near) {
        EXPECT_EQ(near.distance, signed_distance(shape, p));
        EXPECT_EQ(near.point, nearest_surface_point(shape, p)) << n << ": " << p.transpose();
      });
    }
  }
}

TEST(ManyCorners, LegsAnswerAsThePlainLoopDoes) {
  Draw draw(2);
  int blocked = 0;
  int asked = 0;
  for (int n = 0; n < 45; ++n) {
    const Prism prism = random_prism(draw, n % 3);
    const Shape shape = prism;
    const kit::ObstacleSet set({shape});
    for (int m = 0; m < 60; ++m) {
      const Vec3 a = place(draw, prism);
      const Vec3 b = other_end(draw, prism, a);
      const double distance = leg_distance(shape, a, b);
      for (const double r : {0.0, 0.25, distance * 0.999, distance * 1.001}) {
        const bool meets = r > 1e-3 ? distance < r - kLengthTolerance
                                    : distance == 0 && leg_depth(shape, a, b) > kLengthTolerance;
        if (std::abs(distance - r) < 3 * kLengthTolerance && r > 0) {
          continue;  // rounding may decide
        }
        ++asked;
        blocked += meets;
        ASSERT_EQ(set.blocked(a, b, r), meets)
            << n << ": " << a.transpose() << " to " << b.transpose() << " by " << r;
      }
    }
  }
  EXPECT_GT(blocked, asked / 5);
  EXPECT_LT(blocked, asked * 4 / 5);
}

TEST(ManyCorners, DepthIsAtLeastHalfOfTheGreatest) {
  Draw draw(3);
  for (int n = 0; n < 30; ++n) {
    const Prism prism = random_prism(draw, n % 3);
    for (int m = 0; m < 20; ++m) {
      const Vec3 a = place(draw, prism);
      const Vec3 b = other_end(draw, prism, a);
      double deepest = 0;
      for (int k = 0; k <= 600; ++k) {
        deepest = std::max(deepest, -signed_distance(prism, a + k / 600.0 * (b - a)));
      }
      const double depth = leg_depth(prism, a, b);
      ASSERT_GE(depth, deepest / 2 - 1e-12) << a.transpose() << " to " << b.transpose();
      ASSERT_LE(depth, deepest + (b - a).norm() / 1200 + 1e-12);
    }
  }
}

TEST(ManyCorners, DepthIsThatOfTheHallBehindACorridor) {
  constexpr double kHalf = kLengthTolerance / 2;  // of the corridor's width: not to be entered
  Prism key{{}, {}, -100, 100};
  for (int n = 0; n < 20; ++n) {
    key.outline.push_back({n * 0.5, -kHalf});
  }
  for (int n = 0; n <= 40; ++n) {
    key.outline.push_back({100 + 20.0 * n / 40, n % 40 == 0 ? -kHalf : -10});
  }
  for (int n = 0; n <= 40; ++n) {
    key.outline.push_back({120 - 20.0 * n / 40, n % 40 == 0 ? kHalf : 10});
  }
  for (int n = 19; n >= 0; --n) {
    key.outline.push_back({n * 0.5, kHalf});
  }
  const kit::ObstacleSet set({key});
  EXPECT_TRUE(set.blocked({-5, 0, 0}, {115, 0, 0}, 0));
  EXPECT_TRUE(set.blocked({125, 0, 0}, {10, 0, 0}, 0));
  EXPECT_FALSE(set.blocked({-5, 0, 0}, {99, 0, 0}, 0));
  EXPECT_GT(leg_depth(key, {-5, 0, 0}, {115, 0, 0}), 4.5);
}

TEST(ManyCorners, GridsAreThoseOfThePlainLoop) {
  Draw draw(4);
  for (int n = 0; n < 12; ++n) {
    const Shape shape = random_prism(draw, n % 3);
    GridSpec spec;
    spec.origin = {-60, -50, -8};
    spec.cell = {1.7, 1.3, 4};
    spec.counts = {70, 75, 4};
    spec.inflation = n % 2 * 1.5;
    spec.rule = n % 4 < 2 ? GridSpec::Rule::touched : GridSpec::Rule::centre;
    VoxelGrid grid(spec);
    kit::ObstacleSet({shape}).rasterize(grid);
    for (int k = 0; k < spec.counts[2]; ++k) {
      for (int j = 0; j < spec.counts[1]; ++j) {
        for (int i = 0; i < spec.counts[0]; ++i) {
          const bool expected =
              spec.rule == GridSpec::Rule::centre
                  ? signed_distance(shape, spec.centre({i, j, k})) <= spec.inflation + 1e-9
                  : overlaps(shape, spec.cell_box({i, j, k}), spec.inflation);
          ASSERT_EQ(grid.blocked(i, j, k), expected) << n << ": " << i << ' ' << j << ' ' << k;
        }
      }
    }
  }
}

using Whole = std::array<std::int64_t, 2>;

std::int64_t side(const Whole& o, const Whole& p, const Whole& q) {
  return (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
}

bool is_between(const Whole& e, const Whole& f, const Whole& p) {
  return side(e, f, p) == 0 && std::min(e[0], f[0]) <= p[0] && p[0] <= std::max(e[0], f[0]) &&
         std::min(e[1], f[1]) <= p[1] && p[1] <= std::max(e[1], f[1]);
}

bool meet(const Whole& a, const Whole& b, const Whole& c, const Whole& d) {
  const auto apart = [](std::int64_t one, std::int64_t other) {
    return (one > 0 && other < 0) || (one < 0 && other > 0);
  };
  return (apart(side(a, b, c), side(a, b, d)) && apart(side(c, d, a), side(c, d, b))) ||
         is_between(a, b, c) || is_between(a, b, d) || is_between(c, d, a) || is_between(c, d, b);
}

/// Whether two edges of the ring that are no neighbours meet, or two neighbours more than at their
/// corner: in whole numbers, every pair.
bool meets_itself(const std::vector<Whole>& ring) {
  const std::size_t size = ring.size();
  for (std::size_t n = 0; n < size; ++n) {
    const Whole& a = ring[n];
    const Whole& b = ring[(n + 1) % size];
    for (std::size_t m = n + 1; m < size; ++m) {
      const Whole& c = ring[m];
      const Whole& d = ring[(m + 1) % size];
      const bool after = m == n + 1;
      const bool before = n == 0 && m + 1 == size;
      if (after || before) {
        if (is_between(a, b, after ? d : c) || is_between(c, d, after ? a : b)) {
          return true;
        }
      } else if (meet(a, b, c, d)) {
        return true;
      }
    }
  }
  return false;
}

TEST(ManyCorners, RingsThatMeetThemselvesAreFound) {
  Draw draw(5);
  int wrong = 0;
  for (int n = 0; n < 600; ++n) {
    const int size = 20 + draw.below(100);
    std::vector<Whole> ring;
    for (int k = 0; k < size; ++k) {
      const double angle = 2 * kPi * k / size;
      const double far = draw.below(30) == 0 ? draw(20, 300) : draw(150, 200);
      ring.push_back({std::int64_t(far * std::cos(angle)), std::int64_t(far * std::sin(angle))});
    }
    if (draw.below(3) == 0) {  // a corner somewhere else, perhaps on an edge or a corner
      ring[std::size_t(draw.below(size))] = draw.below(2) == 0
                                                ? ring[std::size_t(draw.below(size))]
                                                : Whole{draw.below(300) - 150, draw.below(100)};
    }
    formats::Ring points;
    for (const Whole& p : ring) {
      points.push_back({double(p[0]), double(p[1])});
    }
    if (formats::without_repeats(points).size() != points.size()) {
      continue;
    }
    const bool expected = meets_itself(ring);
    wrong += expected;
    ASSERT_EQ(formats::polygon_problem({points, {}}).empty(), !expected) << n;
  }
  EXPECT_GT(wrong, 50);
  EXPECT_LT(wrong, 500);
}

TEST(ManyCorners, HolesAreHeldAgainstEachOtherAndTheOutline) {
  formats::Polygon polygon{square(0, 0, 1000), {}};
  for (int n = 0; n < 400; ++n) {
    polygon.holes.push_back(square(-900 + 90 * (n % 20), -900 + 90 * (n / 20), 40));
  }
  EXPECT_EQ(formats::polygon_problem(polygon), "");
  const auto with = [&](const Ring& hole) {
    formats::Polygon other = polygon;
    other.holes.push_back(hole);
    return formats::polygon_problem(other);
  };
  EXPECT_EQ(with(square(-900, -900, 10)), "hole 401 and hole 1 lie one inside the other");
  EXPECT_EQ(with(square(-810, -900, 45)), "hole 401 and hole 2 lie one inside the other");
  EXPECT_EQ(with(square(-765, -900, 6)), "hole 401 meets hole 2 at (-770, -906)");
  EXPECT_EQ(with(square(1100, 0, 10)), "hole 401 lies outside of the outline, at (1090, -10)");
  EXPECT_EQ(with(square(990, 0, 10)), "hole 401 meets the outline at (1000, -10)");
}
}  // namespace
}  // namespace altiplan::many_corners_test
