// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>

#include "support/posts.hpp"
#include "support/support.hpp"

namespace altiplan::testing::photos_test {
namespace {

const std::string kCamera = "sensor_mm: [23.5, 15.6], image_px: [6000, 4000], focal_mm: 16, ";
// At 100 m a pixel shows 2.447917 cm, a photo 97.5 m along the flight.

/// 100 m above the sea, with a ridge of 30 m in the middle.
Request problem(const std::string& more, AppliesTo to = AppliesTo::route) {
  constexpr int kPosts = 11;
  std::vector<float> heights(kPosts * kPosts, 100);
  for (int j = 0; j < kPosts; ++j) {
    heights[std::size_t(j * kPosts + 5)] = 130;
  }
  const World world = world_of(
      std::make_shared<Posts>(HeightField({0, 0}, {100, 100}, kPosts, kPosts, std::move(heights))));
  Request request =
      request_in(world, {10, 500, 200}, {990, 500, 200}, {{0, 0, 0}, {1000, 1000, 1000}});
  apply_constraints(request, {{"photos", make_constraint("photos", "{" + kCamera + more + "}")}},
                    to);
  return request;
}

CheckResult judged(const std::string& more, const Route& route) {
  return check(route, problem(more));
}

const Route kLevel{{10, 500, 200}, {990, 500, 200}};
const Route kFollowing{
    {10, 500, 200}, {400, 500, 200}, {500, 500, 230}, {600, 500, 200}, {990, 500, 200}};

TEST(Photos, RefusesWrongParameters) {
  const auto problems = [](const std::string& yaml) {
    return parameter_problems("constraint", "photos", "{" + yaml + "}");
  };
  EXPECT_EQ(problems(kCamera + "max_gsd_cm: 2"), "");
  EXPECT_NE(problems(kCamera + "min_overlap: 0.5"), "");
  EXPECT_NE(problems(kCamera + "min_sidelap: 0.5"), "");
  EXPECT_EQ(problems(kCamera + "spacing_m: 5"), "");
  EXPECT_NE(problems(kCamera + "max_gsd_cm: 2, min_sidelap: 0.8").find("min_sidelap"),
            std::string::npos);
  EXPECT_NE(problems(kCamera + "spacing_m: 5, min_overlap: 0.8").find("min_overlap"),
            std::string::npos);
  EXPECT_NE(problems(kCamera + "max_gsd_cm: 2, min_gsd_cm: 2"), "");
  EXPECT_NE(problems("sensor_mm: [0, 1], image_px: [9, 9], focal_mm: 9, max_gsd_cm: 2"), "");
  EXPECT_NE(problems("max_gsd_cm: 2"), "");
}

TEST(Photos, JudgesTheScaleOverTheWholeLeg) {
  EXPECT_TRUE(judged("max_gsd_cm: 2.45, min_gsd_cm: 2.44", kFollowing).ok());
  const CheckResult near = judged("min_gsd_cm: 2.4", kLevel);  // over the ridge, between waypoints
  ASSERT_FALSE(near.ok());
  EXPECT_NEAR(near.violations.back().value, 0.7 * 2.447917, 1e-5);
  EXPECT_EQ(near.violations.back().unit, "cm");
  EXPECT_TRUE(judged("min_gsd_cm: 1.713", kLevel).ok());
  const CheckResult far = judged("max_gsd_cm: 2.4", kFollowing);
  ASSERT_FALSE(far.ok());
  EXPECT_NEAR(far.violations.back().value, 2.447917, 1e-5);
  EXPECT_NE(far.violations.back().message.find("a pixel shows 2.448 cm; at most 2.400 cm"),
            std::string::npos);
}

TEST(Photos, JudgesTheOverlapOfTheGroundBelow) {
  EXPECT_TRUE(judged("trigger_m: 24.375, min_overlap: 0.75", kFollowing).ok());
  EXPECT_FALSE(judged("trigger_m: 24.4, min_overlap: 0.75", kFollowing).ok());
  const CheckResult near = judged("trigger_m: 24.375", kLevel);
  ASSERT_FALSE(near.ok());
  EXPECT_NEAR(near.violations.back().value, 1 - 24.375 / 68.25, 1e-6);
  EXPECT_NE(near.violations.back().message.find("an overlap of 0.643; at least 0.750"),
            std::string::npos);
}

/// At 100 m a photo shows 146.875 m across the flight.
TEST(Photos, JudgesTheSideOverlapOfTheGroundBelow) {
  EXPECT_TRUE(judged("spacing_m: 44.0625, min_sidelap: 0.7", kFollowing).ok());
  EXPECT_FALSE(judged("spacing_m: 44.1, min_sidelap: 0.7", kFollowing).ok());
  const CheckResult near = judged("spacing_m: 44.0625", kLevel);  // 70 m over the ridge
  ASSERT_FALSE(near.ok());
  EXPECT_NEAR(near.violations.back().value, 1 - 44.0625 / (0.7 * 146.875), 1e-6);
  EXPECT_NE(near.violations.back().message.find("a side overlap of 0.571; at least 0.700"),
            std::string::npos);
  EXPECT_TRUE(judged("spacing_m: 44.0625, min_sidelap: 0.571", kLevel).ok());
  const Request request = problem("spacing_m: 44.0625");
  const auto photos = make_constraint("photos", "{" + kCamera + "spacing_m: 44.0625}");
  EXPECT_FALSE(photos->admits({std::nullopt, kLevel[0], kLevel[1], request.world.get()}));
  EXPECT_TRUE(photos->admits({std::nullopt, kFollowing[0], kFollowing[1], request.world.get()}));
  EXPECT_FALSE(judged("spacing_m: 20, trigger_m: 24.375", kLevel).ok());  // along it has less
}

TEST(Photos, NeedsGround) {
  const auto photos = make_constraint("photos", "{" + kCamera + "min_gsd_cm: 1}");
  const World none;
  EXPECT_FALSE(photos->admits({std::nullopt, {0, 0, 500}, {9, 0, 500}, &none}));
  EXPECT_FALSE(photos->admits({std::nullopt, {0, 0, 500}, {9, 0, 500}, nullptr}));
  EXPECT_FALSE(judged("min_gsd_cm: 1", {{10, 500, 200}, {2000, 500, 200}}).ok());
}

TEST(Photos, MayHoldForRoutesAlone) {
  EXPECT_EQ(problem("max_gsd_cm: 3, applies_to: route").constraints.size(), 1U);
  EXPECT_TRUE(problem("max_gsd_cm: 3, applies_to: route", AppliesTo::track).constraints.empty());
}
}  // namespace
}  // namespace altiplan::testing::photos_test
