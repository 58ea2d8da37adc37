// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/measures.hpp"
#include "support/support.hpp"
#include "support/walks.hpp"

namespace altiplan {
namespace {

using testing::counter;
using testing::make_smoother;
using testing::open_request;

/// The route's arcs of this radius, without obstacles.
PlanResult arcs(const Polyline& route, double radius, const std::string& more = "") {
  Request request = open_request(route);
  request.limits.min_turn_radius = radius;
  return make_smoother("arc", "{" + more + "}")->smooth(route, request);
}

TEST(Arc, IsACircumscribedPolygonOfItsCircle) {
  const Polyline route = {{0, 0, 0}, {1000, 0, 0}, {1000, 1000, 0}};
  const PlanResult result = arcs(route, 200);
  ASSERT_EQ(result.status, PlanStatus::solved);
  EXPECT_EQ(result.message, "1 of 1 corners are arcs of 200 m");
  EXPECT_EQ(counter(result, "filleted"), 1);
  ASSERT_EQ(result.route.size(), 2u + 6u) << "six turns of 15 degrees";
  const Measures measures = measure(result.route, open_request(route));
  const double radius = *measures.min_radius_m;
  EXPECT_GE(radius, 200);
  EXPECT_LE(radius, 201) << "the margin for an autopilot's digits";
  EXPECT_NEAR(*measures.max_turn_deg, 15, 1e-6);
  const Vec3 centre(1000 - radius, radius, 0);
  for (std::size_t i = 0; i + 1 < result.route.size(); ++i) {
    // The first and last legs are the route's own.
    EXPECT_NEAR(point_leg_distance(centre, result.route[i], result.route[i + 1]), radius, 1e-6);
  }
}

TEST(Arc, TangentsKeepTheSag) {
  const Polyline route = {{0, 0, 0}, {1000, 0, 0}, {1000, 1000, 0}};
  for (const double sag : {0.1, 1.0, 30.0}) {
    const Route arc = arcs(route, 400, "sag_m: " + std::to_string(sag)).route;
    const double radius = *measure(arc, open_request(arc)).min_radius_m;
    double most = 0;
    for (std::size_t i = 1; i + 1 < arc.size(); ++i) {
      most = std::max(most, (arc[i] - Vec3(1000 - radius, radius, 0)).norm() - radius);
    }
    EXPECT_LE(most, 1.05 * sag);
    EXPECT_GT(most, sag / 8);
  }
}

/// The route as an autopilot stores it: in 1e-7 degree and centimetres, at the worst latitude.
Polyline as_written(const Polyline& route, RandomStream& random) {
  const double metres_per_degree = 111'320;
  Polyline written;
  for (const Vec3& p : route) {
    const auto moved = [&](double quantum) { return random.uniform(-0.5, 0.5) * quantum; };
    written.push_back(
        p + Vec3(moved(1e-7 * metres_per_degree), moved(1e-7 * metres_per_degree), moved(0.01)));
  }
  return written;
}

TEST(Arc, TheRadiusHoldsForEveryRouteWhoseCornersAllHaveArcs) {
  // In 3-D, as the judge measures it: includes joints of arcs in different planes.
  int whole = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    RandomStream random(seed);
    Polyline route = {{0, 0, 0}};
    while (route.size() < 7) {
      route.push_back(route.back() + random.in({Vec3::Constant(-3000), Vec3::Constant(3000)}));
    }
    // The largest radius whose arcs fit on the legs.
    double radius = kInfinity;
    std::vector<double> tangents = {0};
    for (std::size_t i = 1; i + 1 < route.size(); ++i) {
      tangents.push_back(
          std::tan(turn_angle_in_space(route[i] - route[i - 1], route[i + 1] - route[i]) / 2));
    }
    tangents.push_back(0);
    for (std::size_t i = 0; i + 1 < route.size(); ++i) {
      radius = std::min(radius, (route[i + 1] - route[i]).norm() / (tangents[i] + tangents[i + 1]));
    }
    for (const double share : {0.4, 0.7, 0.95, 1.00001}) {
      const PlanResult result = arcs(route, share * radius);
      const bool all = counter(result, "filleted") == 5;
      EXPECT_TRUE(share > 0.4 || all) << seed << ": " << result.message;
      EXPECT_TRUE(share < 1 || !all) << seed << ": " << result.message;
      Request request = open_request(route);
      request.limits.min_turn_radius = share * radius;
      if (all) {
        EXPECT_TRUE(check(result.route, request).ok()) << seed;
        if (share * radius > 100) {
          EXPECT_GE(*measure(as_written(result.route.waypoints(), random), request).min_radius_m,
                    share * radius)
              << seed;
        }
      }
      EXPECT_EQ(testing::grown_excess(route, result.route, request), "") << seed;
      EXPECT_LE(length(result.route), length(route) + 1e-9);
      whole += all;
    }
  }
  EXPECT_GT(whole, 700);
}

TEST(Arc, NoRuleOfRandomRoutesGetsWorse) {
  int filleted = 0;
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    const bool sound = seed % 4 != 0;
    const auto [request, route] =
        testing::random_walk(RandomStream(seed).sub("arc"), 8, sound, [&](Limits& limits) {
          limits.min_turn_radius = seed % 2 == 0 ? double(seed % 20) : 0;
          limits.min_clearance = seed % 3 == 0 ? 2 : 0;
          limits.max_turn_horizontal = seed % 5 == 0 ? radians(110) : kPi;
          limits.max_climb = seed % 7 == 0 ? radians(50) : kPi / 2;
          limits.min_leg = seed % 11 == 0 ? 4 : 0;
        });
    if (route.size() < 3) {
      continue;
    }
    const PlanResult result = make_smoother("arc", "{radius_m: 8}")->smooth(route, request);
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    ASSERT_EQ(testing::grown_excess(route, result.route, request), "") << seed;
    ASSERT_TRUE(!sound || check(result.route, request).ok()) << seed;
    EXPECT_LE(length(result.route), length(route) + 1e-9);
    filleted += counter(result, "filleted") > 0;
    refused += counter(result, "refused") > 0;
  }
  EXPECT_GT(filleted, 300);
  EXPECT_GT(refused, 50);
}

TEST(Arc, MendsWhatTheJudgeFoundTooTight) {
  // Half of each leg allows 500 m; an arc of several turns may use more of them.
  const Polyline route = {{0, 0, 0}, {1000, 0, 0}, {1000, 1000, 0}};
  Request request = open_request(route);
  request.limits.min_turn_radius = 800;
  EXPECT_FALSE(check(route, request).ok());
  EXPECT_TRUE(check(arcs(route, 800).route, request).ok());
}

TEST(Arc, LeavesShortLegsAndObstacles) {
  const Polyline route = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {130, 100, 0}};
  const PlanResult tight =
      make_smoother("arc", "{radius_m: 40}")->smooth(route, open_request(route));
  EXPECT_EQ(tight.message, "1 of 2 corners are arcs of 40 m; the legs of 1 are too short for it");
  EXPECT_EQ(tight.route.back(), route.back());
  Request request = open_request(route);
  // The point where the middle of the first arc would pass.
  const Vec3 middle = Vec3(60, 40, 0) + 40.3 * std::sqrt(0.5) * Vec3(1, -1, 0);
  request.world = std::make_shared<const World>(testing::world_of({Shape{Sphere{middle, 3}}}));
  const PlanResult refused = make_smoother("arc", "{radius_m: 40}")->smooth(route, request);
  EXPECT_EQ(refused.route, route);
  EXPECT_EQ(refused.message,
            "0 of 2 corners are arcs of 40 m; the legs of 1 are too short for it; 1 would violate "
            "a constraint");
}

TEST(Arc, TangentsKeepTheLimitsOnLegsAndTurns) {
  const Polyline route = {{0, 0, 0}, {1000, 0, 0}, {1000, 1000, 0}};
  Request request = open_request(route);
  request.limits.min_leg = 100;
  request.limits.max_turn_space = radians(20);
  request.limits.min_turn_radius = 200;
  EXPECT_FALSE(check(route, request).ok());
  const Route coarse = make_smoother("arc")->smooth(route, request).route;
  EXPECT_EQ(coarse.size(), 2u + 3u) << "three turns of 30 degrees: tangents of 107 m";
  EXPECT_EQ(testing::grown_excess(route, coarse, request), "");
  request.limits.min_leg = 40;
  const Route fine = make_smoother("arc", "{sag_m: 30}")->smooth(route, request).route;
  EXPECT_EQ(fine.size(), 2u + 5u) << "five turns of 18 degrees: tangents of 63 m";
  EXPECT_TRUE(check(fine, request).ok());
}

TEST(Arc, StraightStretchesAreOneLeg) {
  const Polyline route = {{0, 0, 0},    {40, 0, 0},   {80, 0, 0},  {100, 0, 0},
                          {100, 20, 0}, {100, 50, 0}, {100, 99, 0}};
  EXPECT_EQ(arcs(route, 60).message, "1 of 1 corners are arcs of 60 m");
}

TEST(Arc, OddRoutesAndNoRadius) {
  const Vec3 p(3, 4, 5);
  EXPECT_EQ(arcs({p, p, p}, 5).route, Polyline(3, p));
  EXPECT_EQ(arcs({p, {9, 9, 9}}, 5).route.size(), 2u);
  const Polyline back = {{0, 0, 0}, {50, 0, 0}, {20, 0, 0}};
  EXPECT_EQ(arcs(back, 5).route, back);
  EXPECT_GT(arcs({{0, 0, 0}, {50, 0, 0}, {50, 0, 0}, {50, 50, 0}}, 5).route.size(), 7u);
  EXPECT_GT(arcs({{0, 0, 0}, {0, 0, 50}, {50, 0, 50}}, 5).route.size(), 7u) << "straight up first";

  const Polyline bent = {{0, 0, 0}, {50, 0, 0}, {50, 50, 0}};
  const PlanResult none = make_smoother("arc")->smooth(bent, open_request(bent));
  EXPECT_EQ(none.status, PlanStatus::invalid_problem);
  EXPECT_NE(none.message.find("radius_m"), std::string::npos);
  // The parameter may only tighten the limit.
  Request request = open_request(bent);
  request.limits.min_turn_radius = 30;
  const PlanResult limited = make_smoother("arc", "{radius_m: 10}")->smooth(bent, request);
  const double radius = *measure(limited.route, request).min_radius_m;
  EXPECT_GE(radius, 30);
  EXPECT_LE(radius, 31.5);
  request.budget.max_iterations = 0;
  const PlanResult spent = make_smoother("arc")->smooth(bent, request);
  EXPECT_EQ(spent.route, bent);
  EXPECT_TRUE(spent.budget_hit);
  EXPECT_NE(testing::parameter_problems("smoother", "arc", "{radius_m: 0}"), "");
  EXPECT_NE(testing::parameter_problems("smoother", "arc", "{sag_m: 0}"), "");
}
}  // namespace
}  // namespace altiplan
