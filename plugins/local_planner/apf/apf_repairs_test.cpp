// SPDX-License-Identifier: Apache-2.0
// Each of the four repairs on its own, compared with the field without repairs.
#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan::testing::apf_repairs_test {
namespace {

constexpr const char* kNone =
    "side: field, turned_repulsion: false, stronger_goal: false, two_steps: false, "
    "turn_limit: false";

/// The default field with the one repair, or none, and further parameters.
std::string with_only(const std::string& repair, const std::string& more = "") {
  std::string yaml = kNone;
  if (const std::size_t at = yaml.find(repair); !repair.empty() && at != yaml.npos) {
    yaml.replace(at + repair.size() + 2, 5, "true");
  }
  return "{" + yaml + more + "}";
}

/// One step east from (5000, 15000, 500) at 30 m/s in a world of shapes.
struct Once {
  Request request;
  Observation seen;

  explicit Once(std::vector<Shape> shapes, const Vec3& goal = {28000, 15000, 500})
      : request(request_in(world_of(std::move(shapes)), {2000, 15000, 500}, goal,
                           {{0, 0, 0}, {30e3, 30e3, 4000}})) {
    request.vehicle.speed_mps = 30;
    request.vehicle.radius_m = 2;
    request.limits.min_clearance = 2;
    request.limits.max_climb = radians(15);
    seen.state = {0, {5000, 15000, 500}, {30, 0, 0}};
    seen.goal = request.goal;
    seen.local_target = {7000, 15000, 500};
    seen.max_dt_s = 1;
  }
  Vec3 step(const std::string& yaml) {
    seen.world = request.world.get();
    const auto planner = make_local_planner("apf", yaml);
    return planner->begin(request)->step(seen).next.position - seen.state.position;
  }
};

double bearing_deg(const Vec3& way) { return degrees(std::atan2(way.y(), way.x())); }

TEST(ApfRepairs, TurnedRepulsionPushesAsideAndToTheSideOfTheTarget) {
  for (const double side : {-1.0, 1.0}) {
    Once once({Cylinder{6000, 15000 + side * 50, 500}});
    EXPECT_LT(std::abs(bearing_deg(once.step(with_only("")))), 5);
    const double turned = bearing_deg(once.step(with_only("turned_repulsion")));
    EXPECT_GT(-side * turned, 5) << turned;
    // An obstacle well off the bearing to the target is not rotated.
    Once off({Cylinder{6500, 15000 + side * 700, 500}});
    EXPECT_EQ(off.step(with_only("turned_repulsion")), off.step(with_only("")));
  }
}

TEST(ApfRepairs, StrongerGoalHoldsTheCourseNearTheGoalOnly) {
  const std::vector<Shape> beside{Cylinder{5700, 15700, 500}};
  Once near(beside, {7000, 15000, 500});
  const double plain = bearing_deg(near.step(with_only("")));
  const double strong = bearing_deg(near.step(with_only("stronger_goal")));
  EXPECT_LT(plain, -1);  // pushed away, to the south
  EXPECT_GT(strong, plain + 1);
  EXPECT_LT(strong, 0);
  Once far(beside);
  EXPECT_EQ(far.step(with_only("stronger_goal")), far.step(with_only("")));
}

TEST(ApfRepairs, TwoStepsAreLongOnlyAwayFromWhatIsNear) {
  const std::string lengths = ", step_far_m: 60, step_near_m: 20";
  Once open({Cylinder{5600, 16500, 500}});  // its edge more than 10 s of flight away
  open.seen.max_dt_s = 10;
  EXPECT_NEAR(open.step(with_only("two_steps", lengths)).norm(), 60, 1e-6);
  EXPECT_NEAR(open.step(with_only("", lengths)).norm(), 20, 1e-6);
  Once close({Cylinder{5000, 15700, 500}});
  close.seen.max_dt_s = 10;
  EXPECT_NEAR(close.step(with_only("two_steps", lengths)).norm(), 20, 1e-6);
}

TEST(ApfRepairs, TurnLimitHoldsTheTurn) {
  Once once({Cylinder{25000, 25000, 500}});
  once.seen.local_target = {5000, 17000, 500};  // abeam
  once.seen.goal.position = {5000, 28000, 500};
  EXPECT_NEAR(bearing_deg(once.step(with_only(""))), 90, 1e-6);
  EXPECT_NEAR(bearing_deg(once.step(with_only("turn_limit"))), 30, 1e-6);
  EXPECT_NEAR(bearing_deg(once.step(with_only("turn_limit", ", max_turn_deg: 12"))), 12, 1e-6);
}

TEST(ApfRepairs, NoneOfThemIsInThePlainVariant) {
  Once once({Cylinder{6500, 15050, 500}});
  EXPECT_EQ(once.step("{variant: plain}"), once.step(with_only("")));
  EXPECT_NE(once.step("{}"), once.step(with_only("")));
}
}  // namespace
}  // namespace altiplan::testing::apf_repairs_test
