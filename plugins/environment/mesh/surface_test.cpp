// SPDX-License-Identifier: Apache-2.0
// The tree compared with a scan of all triangles, and the winding number with the sum of solid
// angles.
#include "surface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "random_triangles_test.hpp"

namespace altiplan::mesh::surface_test {
namespace {

/// A torus whose tube has flat sides, with its corners on a grid: many verticals meet edges.
std::vector<Triangle> torus(int around, int tube) {
  const auto corner = [&](int i, int j) {
    const double u = 2 * kPi * (i % around) / around;
    const double v = 2 * kPi * (j % tube) / tube;
    const double out = 0.6 + 0.3 * std::cos(v);
    return Vec3(out * std::cos(u), out * std::sin(u), 0.3 * std::sin(v));
  };
  std::vector<Triangle> all;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < tube; ++j) {
      all.push_back({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
      all.push_back({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
    }
  }
  return all;
}

TEST(Surface, TheTreeFindsWhatAWalkOverAllFinds) {
  RandomStream random(4);
  std::vector<Triangle> all;
  for (int n = 0; n < 150; ++n) {
    Triangle t = triangle(random, n);
    const Vec3 off = 4 * random.in(kAround);
    for (Vec3& corner : t) {
      corner = 0.3 * corner + off;
    }
    all.push_back(t);
  }
  const Surface surface(all);
  int nearer = 0;
  for (int n = 0; n < 200; ++n) {
    const Vec3 a = 5 * random.in(kAround);
    const Vec3 b = 5 * random.in(kAround);
    const Box box{a, a + 0.4 * (random.in(kAround) + Vec3(1, 1, 1))};
    const double r = random.uniform(0, 0.3);
    double nearest = kInfinity;
    double to_leg = kInfinity;
    double to_box = kInfinity;
    for (const Triangle& t : all) {
      nearest = std::min(nearest, (nearest_point(t, a) - a).norm());
      to_leg = std::min(to_leg, leg_distance(t, a, b));
      to_box = std::min(to_box, box_distance(t, box));
    }
    EXPECT_EQ(surface.nearest(a).distance, nearest);
    EXPECT_EQ(surface.leg_is_nearer(a, b, r), to_leg < r);
    EXPECT_EQ(surface.box_is_nearer(box, r), to_box < r);
    nearer += to_leg < r ? 1 : 0;
  }
  EXPECT_GT(nearer, 10);
  EXPECT_LT(nearer, 190);
}

/// A. Van Oosterom, J. Strackee, "The solid angle of a plane triangle", IEEE Transactions on
/// Biomedical Engineering 30(2), 1983.
double turns_by_angles(const std::vector<Triangle>& all, const Vec3& p) {
  double sum = 0;
  for (const Triangle& t : all) {
    const Vec3 a = t[0] - p;
    const Vec3 b = t[1] - p;
    const Vec3 c = t[2] - p;
    sum += 2 * std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                 b.dot(c) * a.norm() + c.dot(a) * b.norm());
  }
  return sum / (4 * kPi);
}

TEST(Surface, WindingIsThatOfTheSolidAngles) {
  RandomStream random(5);
  for (const auto& [around, tube] : {std::pair(8, 4), {7, 5}, {16, 8}}) {
    std::vector<Triangle> all = torus(around, tube);
    // Another one that overlaps the first, and one inside out.
    for (const Triangle& t : torus(around, tube)) {
      all.push_back({t[0] + Vec3(0.5, 0, 0), t[1] + Vec3(0.5, 0, 0), t[2] + Vec3(0.5, 0, 0)});
      all.push_back({t[0] + Vec3(0, 3, 0), t[2] + Vec3(0, 3, 0), t[1] + Vec3(0, 3, 0)});
    }
    const Surface surface(all);
    std::array<int, 4> seen{};
    for (int n = 0; n < 2000; ++n) {
      Vec3 p = random.in({{-1, -1, -0.4}, {1.5, 4, 0.4}});
      const Triangle& t = all[std::size_t(random.integer(0, std::int64_t(all.size()) - 1))];
      if (n % 3 == 1) {  // below or above a corner
        p.head<2>() = t[0].head<2>();
      } else if (n % 3 == 2) {  // an edge
        p.head<2>() = (0.5 * (t[0] + t[1])).head<2>();
      }
      if (surface.nearest(p).distance > 1e-9) {
        const int turns = surface.winding(p);
        EXPECT_NEAR(turns, turns_by_angles(all, p), 1e-6) << p.transpose();
        ++seen[std::size_t(turns + 1)];
      }
    }
    EXPECT_GT(*std::min_element(seen.begin(), seen.end()), 10);
  }
}

TEST(Surface, WallsAlongTheAxesAreOnNoVertical) {
  // A wall that rounding has left slightly tilted, and positions in its plane beside it.
  const double tilt = 6e-17;
  const Vec3 a(0, 0, 0);
  const Vec3 b(1, tilt, 0);
  const Vec3 c(0, 0, 1);
  const Vec3 d(0.3, 1, 0.2);
  const std::vector<Triangle> all{{a, b, c}, {b, d, c}, {d, a, c}, {a, d, b}};
  const Surface surface(all);
  for (const double x : {0.3, 0.5, 0.9}) {
    for (const double y : {0.0, tilt / 2, tilt, -tilt}) {
      EXPECT_EQ(surface.winding({x, y, 0.9}), 0) << x << " " << y;
      EXPECT_EQ(surface.winding({x, y, -0.1}), 0) << x << " " << y;
    }
  }
  EXPECT_EQ(std::abs(surface.winding({0.2, 0.1, 0.2})), 1);
}
}  // namespace
}  // namespace altiplan::mesh::surface_test
