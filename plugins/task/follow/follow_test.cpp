// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "altiplan/flown_route.hpp"
#include "altiplan/world.hpp"
#include "support/posts.hpp"
#include "support/support.hpp"

namespace altiplan::follow_task_test {
namespace {

Request copter() {
  Request request =
      testing::request_in({}, {0, 0, 0}, {0, 0, 0}, {{-1e4, -1e4, 0}, {1e4, 1e4, 500}});
  request.vehicle.acceleration.mps2 = 2;
  return request;
}

/// Distance of a place from the line, seen from above.
double away(const Vec3& p, const Polyline& line) {
  double minimum = kInfinity;
  for (std::size_t i = 1; i < line.size(); ++i) {
    minimum = std::min(minimum, point_leg_distance({p.x(), p.y(), 0}, line[i - 1], line[i]));
  }
  return minimum;
}

TEST(Follow, KeepsItsDistanceBesideTheLine) {
  const Polyline line{{0, 0, 0}, {400, 50, 0}, {700, 300, 0}, {500, 900, 0}};
  const auto task = testing::make_task(
      "follow",
      "{line_m: [[0, 0], [400, 50], [700, 300], [500, 900]], offsets_m: [30, -30], height_m: 90}");
  const TaskOrder order = task->order(copter(), {});
  ASSERT_EQ(order.passes.size(), 2U);
  for (const Pass& pass : order.passes) {
    for (std::size_t i = 1; i < pass.points.size(); ++i) {
      for (double t = 0; t <= 1; t += 0.01) {
        const Vec3 p = pass.points[i - 1] + t * (pass.points[i] - pass.points[i - 1]);
        EXPECT_GE(away(p, line), 30 - 1e-6);
        EXPECT_LE(away(p, line), 30.5 + 1e-6);  // outside a bend it goes around
        EXPECT_EQ(p.z(), 90);
      }
    }
  }
  // The second pass comes back: it begins at the end of the line.
  EXPECT_GT(order.passes[1].points.front().y(), 800);
  EXPECT_LT(order.passes[1].points.back().y(), 100);
}

/// Bends to the offset's side that are sharper, or have shorter legs, than it can follow.
TEST(Follow, IsNowhereNearerThanItsOffset) {
  const char* lines[] = {"[[0, 0], [300, 0], [310, 10], [310, 25], [60, 400]]",
                         "[[0, 0], [300, 0], [0, 100]]",   // 162 degrees
                         "[[0, 0], [300, 0], [300, 12]]",  // ends within the offset
                         "[[0, 0], [300, 0], [100, 0]]",   // back along itself
                         "[[0, 0], [50, 3], [100, 0], [150, 3], [200, 0]]"};
  const Polyline corners[] = {{{0, 0, 0}, {300, 0, 0}, {310, 10, 0}, {310, 25, 0}, {60, 400, 0}},
                              {{0, 0, 0}, {300, 0, 0}, {0, 100, 0}},
                              {{0, 0, 0}, {300, 0, 0}, {300, 12, 0}},
                              {{0, 0, 0}, {300, 0, 0}, {100, 0, 0}},
                              {{0, 0, 0}, {50, 3, 0}, {100, 0, 0}, {150, 3, 0}, {200, 0, 0}}};
  for (std::size_t n = 0; n < std::size(lines); ++n) {
    for (const char* offset : {"30", "-30"}) {
      const auto task =
          testing::make_task("follow", std::string("{height_m: 90, line_m: ") + lines[n] +
                                           ", offsets_m: [" + offset + "]}");
      const TaskOrder order = task->order(copter(), {});
      ASSERT_EQ(order.passes.size(), 1U);
      const Polyline& pass = order.passes[0].points;
      EXPECT_GT(length(pass), 150) << n;
      for (std::size_t i = 1; i < pass.size(); ++i) {
        for (double t = 0; t <= 1; t += 0.002) {
          const Vec3 p = pass[i - 1] + t * (pass[i] - pass[i - 1]);
          EXPECT_GE(away(p, corners[n]), 30 - 1e-5) << n << offset << " " << p.transpose();
          EXPECT_LE(away(p, corners[n]), 30.5 + 1e-6) << n << offset << " " << p.transpose();
        }
      }
    }
  }
  // Through the neck of a loop there is no way.
  EXPECT_THROW(
      testing::make_task("follow",
                         "{height_m: 90, offsets_m: [30], line_m: [[0, 0], [200, 0], [200, "
                         "200], [100, 200], [100, 20], [0, 20], [0, 300]]}"),
      Error);
  // Nor is most of a line left out because its end comes back beside its beginning.
  EXPECT_THROW(testing::make_task("follow",
                                  "{height_m: 90, offsets_m: [30], line_m: [[-500, 0], [0, 0], "
                                  "[1000, 0], [1000, 40], [500, 40]]}"),
               Error);
}

/// A power line over hills: 30 m beside it, and within 2 m of 50 m above the ground.
TEST(Follow, KeepsItsHeightOverHills) {
  constexpr int kPosts = 12;
  std::vector<float> heights;
  for (int j = 0; j < kPosts; ++j) {
    for (int i = 0; i < kPosts; ++i) {
      heights.push_back(float(300 + 40 * std::sin(1.1 * i) * std::cos(0.7 * j)));
    }
  }
  const World world = testing::world_of(std::make_shared<testing::Posts>(
      HeightField({-100, -100}, {80, 80}, kPosts, kPosts, std::move(heights))));
  const Polyline line{{0, 0, 0}, {400, 50, 0}, {600, 300, 0}};
  const auto task = testing::make_task(
      "follow", "{line_m: [[0, 0], [400, 50], [600, 300]], offsets_m: [30], above_ground_m: 50}",
      world);
  const TaskOrder order = task->order(copter(), {});
  ASSERT_EQ(order.passes.size(), 1U);
  const Polyline& pass = order.passes[0].points;
  EXPECT_GT(pass.size(), 8U);
  for (std::size_t i = 1; i < pass.size(); ++i) {
    EXPECT_GE(world.ground_gap(pass[i - 1], pass[i]), 48 - 1e-6) << i;
    EXPECT_LE(world.ground_gap_max(pass[i - 1], pass[i]), 52 + 1e-6) << i;
    EXPECT_NEAR(away((pass[i - 1] + pass[i]) / 2, line), 30, 1) << i;
  }
}

TEST(Follow, RefusesWhatIsNoLine) {
  EXPECT_NE(testing::parameter_problems("task", "follow", "{height_m: 9}"), "");
  EXPECT_NE(testing::parameter_problems("task", "follow", "{line_m: [[0, 0]], height_m: 9}"), "");
  EXPECT_NE(testing::parameter_problems("task", "follow", "{line_m: [[0, 0], [9, 9]]}"), "");
  EXPECT_THROW(testing::make_task("follow", "{line_m: [[5, 5], [5, 5]], height_m: 9}"), Error);
  EXPECT_THROW(testing::make_task("follow", "{line_m: [[0, 0], [9, 9]], above_ground_m: 9}"),
               Error);
}
}  // namespace
}  // namespace altiplan::follow_task_test
