// SPDX-License-Identifier: Apache-2.0
// The oracle of convex sets against closed forms.
#include "reference/separation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "framework/shape_oracle.hpp"

namespace altiplan::oracle::separation_test {
namespace {

constexpr double kScales[] = {1, 100, 10'000};

Convex points_of(const Box& box) {
  Convex made;
  for (int n = 0; n < 8; ++n) {
    made.points.emplace_back((n & 1) != 0 ? box.max.x() : box.min.x(),
                             (n & 2) != 0 ? box.max.y() : box.min.y(),
                             (n & 4) != 0 ? box.max.z() : box.min.z());
  }
  return made;
}

Convex turned(Convex set, const Eigen::Quaterniond& by) {
  const Eigen::Matrix<Real, 3, 3> rotation = by.cast<Real>().toRotationMatrix();
  for (Vector& p : set.points) {
    p = rotation * p;
  }
  return set;
}

TEST(Separation, OfBoxesIsThatOfTheirSides) {
  Draw draw(1);
  int apart = 0;
  for (const double scale : kScales) {
    for (int n = 0; n < 2000; ++n) {
      const Vec3 low = draw.point(scale);
      const Vec3 other = low + draw.point(2 * scale);
      const Box a{low, low + scale * draw.within({1e-4, 1e-4, 1e-4}, {1, 1, 1})};
      const Box b{other, other + scale * draw.within({1e-4, 1e-4, 1e-4}, {1, 1, 1})};
      const Vec3 between = (b.min - a.max).cwiseMax(a.min - b.max);
      const double expected = between.cwiseMax(0).norm();
      const Eigen::Quaterniond by(Eigen::Vector4d(draw.point(1).homogeneous()).normalized());
      const Gap gap = separation(turned(points_of(a), by), turned(points_of(b), by));
      EXPECT_LE(double(gap.low), std::max(expected, 1e-12 * scale) + 1e-9);
      EXPECT_NEAR(double(gap.high), expected, 1e-9);
      if (expected > 0) {
        EXPECT_NEAR(double(gap.low), expected, 1e-9);
        ++apart;
      }
    }
  }
  EXPECT_GT(apart, 1000);
}

TEST(Separation, OfRoundSetsIsThatOfTheirAxes) {
  Draw draw(2);
  for (const double scale : kScales) {
    for (int n = 0; n < 2000; ++n) {
      const Vec3 a = draw.point(scale);
      const Vec3 b = draw.point(scale);
      const double r = draw(0, 1) * scale;
      const double tall = draw(0, 1) * scale;
      const Cylinder cylinder{0, 0, draw(0, 1) * scale, -tall, tall};
      const Convex capsule{{exact(a), exact(b)}, 0, r};
      const Convex ball{{exact({0, 0, 0})}, 0, cylinder.radius};
      const double to_centre = point_leg_distance(Vec3::Zero(), a, b) - r - cylinder.radius;
      const Gap of_ball = separation(capsule, ball);
      EXPECT_NEAR(double(of_ball.low), to_centre, 1e-9);
      EXPECT_NEAR(double(of_ball.high), to_centre, 1e-9);
      const Convex disc{{{0, 0, -tall}, {0, 0, tall}}, cylinder.radius, 0};
      const double to_cylinder = leg_distance({cylinder, {}}, a, b);
      const Gap of_cylinder = separation(capsule, disc);
      EXPECT_NEAR(double(of_cylinder.high), to_cylinder - r, 1e-9 * scale);
      if (to_cylinder > 1e-6 * scale) {
        EXPECT_NEAR(double(of_cylinder.low), to_cylinder - r, 1e-9 * scale);
      }
    }
  }
}

TEST(Separation, LongNeedlesAreToldApart) {
  Draw draw(3);
  for (int n = 0; n < 2000; ++n) {
    // Crossed at a point of each, almost parallel, a known distance apart. The corners are rounded.
    const Vec3 along = draw.point(1).normalized();
    const Vec3 across = along.unitOrthogonal();
    const Vec3 off = along.cross(across);
    const double gap = std::pow(10, draw(-6, 0));
    const double skew = std::pow(10, draw(-3, 0));
    const Vec3 end = 10'000 * along;
    const Vec3 other = 10'000 * (along + skew * across).normalized();
    const Vec3 to = gap * off;
    const Gap found = separation({{exact(-end), exact(end)}, 0, 0},
                                 {{exact(to - other), exact(to + other)}, 0, 0});
    EXPECT_NEAR(double(found.low), gap, 1e-8);
    EXPECT_NEAR(double(found.high), gap, 1e-8);
  }
}
}  // namespace
}  // namespace altiplan::oracle::separation_test
