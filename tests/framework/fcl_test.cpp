// SPDX-License-Identifier: Apache-2.0
// Obstacle sets against FCL: another tree and another way to decide.
#include <gtest/gtest.h>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "framework/shape_oracle.hpp"
#include "reference/fcl_peer.hpp"

namespace altiplan::kit::fcl_test {
namespace {

using oracle::Draw;

// Finite and convex, as FCL needs them.
Shape convex_solid(Draw& draw, const Vec3& at, double size) {
  const double tall = size * draw(0.1, 1);
  switch (draw.below(4)) {
    case 0:
      return Sphere{at, size * draw(0.1, 1)};
    case 1:
      return Cylinder{at.x(), at.y(), size * draw(0.1, 1), at.z() - tall, at.z() + tall};
    case 2: {
      const Vec3 half(size * draw(0.1, 1), size * draw(0.1, 1), tall);
      return BoxShape{{at - half, at + half}};
    }
    default: {
      Prism prism{{}, {}, at.z() - tall, at.z() + tall};
      const int corners = 3 + draw.below(5);
      for (int n = 0; n < corners; ++n) {  // on a circle, so convex
        const double angle = 2 * kPi * (n + draw(-0.3, 0.3)) / corners;
        prism.outline.push_back({at.x() + size * std::cos(angle), at.y() + size * std::sin(angle)});
      }
      return prism;
    }
  }
}

TEST(Fcl, AgreesOnLegsAndDistances) {
  // What FCL may be wrong by, of the scale: its distances from prisms were by 1.4e-4.
  constexpr double kTrusted = 1e-5;
  constexpr double kTrustedDistance = 5e-4;
  Draw draw(1);
  int compared = 0;
  int blocked = 0;
  for (int world = 0; world < 60; ++world) {
    const double scale = std::exp(draw(0, std::log(1000)));
    std::vector<Shape> shapes;
    for (int n = 0; n < 1 + 4 * world; ++n) {
      shapes.push_back(convex_solid(draw, draw.point(scale), scale * draw(0.02, 0.2)));
    }
    const ObstacleSet set(shapes);
    const bench::FclPeer fcl(shapes);
    for (int n = 0; n < 300; ++n) {
      const Vec3 a = draw.point(1.2 * scale);
      const Vec3 b = a + draw.point(0.4 * scale);
      const double r = draw(0.001, 0.1) * scale;
      double distance = kInfinity;
      for (const Shape& shape : shapes) {
        distance = std::min(distance, leg_distance(shape, a, b));
      }
      if (std::abs(distance - r) > kTrusted * scale) {
        ASSERT_EQ(set.blocked(a, b, r), fcl.blocked(a, b, r)) << distance << ' ' << r;
        ++compared;
        blocked += set.blocked(a, b, r);
      }
      const double clearance = set.clearance(a);
      if (clearance > 0.01 * scale) {
        ASSERT_NEAR(fcl.clearance(a), clearance, kTrustedDistance * scale);
      } else if (clearance < -0.01 * scale) {
        ASSERT_LT(fcl.clearance(a), 0.01 * scale);
      }
    }
  }
  EXPECT_GT(compared, 15000);
  EXPECT_GT(blocked, 3000);
}
}  // namespace
}  // namespace altiplan::kit::fcl_test
