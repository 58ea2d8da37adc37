// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "altiplan/measures.hpp"
#include "support/support.hpp"
#include "support/walks.hpp"

namespace altiplan::hermite_test {
namespace {

using testing::counter;
using testing::make_smoother;

Polyline smoothed(const Polyline& route, const std::string& yaml) {
  return make_smoother("hermite", yaml)
      ->smooth(route, testing::open_request(route))
      .route.waypoints();
}

const Polyline kBends = {{0, 0, 0}, {100, 20, 5}, {130, 90, 10}, {300, 80, 40}};

/// Barry and Goldman's pyramid: the cubic between the inner two of four points, each of which it
/// passes at its parameter.
Vec3 pyramid(const std::vector<Vec3>& p, const std::vector<double>& t, double at) {
  const auto mixed = [&](const Vec3& a, const Vec3& b, std::size_t i, std::size_t j) -> Vec3 {
    return ((t[j] - at) * a + (at - t[i]) * b) / (t[j] - t[i]);
  };
  const Vec3 first = mixed(mixed(p[0], p[1], 0, 1), mixed(p[1], p[2], 1, 2), 0, 2);
  const Vec3 last = mixed(mixed(p[1], p[2], 1, 2), mixed(p[2], p[3], 2, 3), 1, 3);
  return mixed(first, last, 1, 2);
}

TEST(Hermite, HasTheTangentsOfChordLength) {
  const Polyline smooth = smoothed(kBends, "{samples: 10}");
  ASSERT_EQ(smooth.size(), 31u);
  std::vector<double> t = {0};
  for (std::size_t i = 1; i < kBends.size(); ++i) {
    t.push_back(t.back() + (kBends[i] - kBends[i - 1]).norm());
  }
  for (std::size_t k = 0; k <= 10; ++k) {
    const double at = t[1] + double(k) / 10 * (t[2] - t[1]);
    EXPECT_LT((smooth[10 + k] - pyramid(kBends, t, at)).norm(), 1e-9) << k;
  }
  // Along the chord of the neighbours: by the four Hermite polynomials.
  const Polyline near = smoothed(kBends, "{samples: 10, tangents: chord}");
  const double h = t[2] - t[1];
  const Vec3 m1 = (kBends[2] - kBends[0]) / (t[2] - t[0]);
  const Vec3 m2 = (kBends[3] - kBends[1]) / (t[3] - t[1]);
  for (std::size_t k = 0; k <= 10; ++k) {
    const double u = double(k) / 10;
    const Vec3 p = (2 * u * u * u - 3 * u * u + 1) * kBends[1] +
                   (u * u * u - 2 * u * u + u) * h * m1 + (3 * u * u - 2 * u * u * u) * kBends[2] +
                   (u * u * u - u * u) * h * m2;
    EXPECT_LT((near[10 + k] - p).norm(), 1e-9) << k;
  }
  EXPECT_LT(length(near), length(smooth));
}

bool crosses_itself(const Polyline& route) {
  const auto side = [](const Vec3& a, const Vec3& b, const Vec3& p) {
    return (b - a).cross(p - a).z() > 0;
  };
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    for (std::size_t j = i + 2; j + 1 < route.size(); ++j) {
      if (side(route[i], route[i + 1], route[j]) != side(route[i], route[i + 1], route[j + 1]) &&
          side(route[j], route[j + 1], route[i]) != side(route[j], route[j + 1], route[i + 1])) {
        return true;
      }
    }
  }
  return false;
}

TEST(Hermite, DoesNotLoopWhereAUniformParameterDoes) {
  // A short leg between two long ones.
  const Polyline route = {{0, 0, 0}, {100, 0, 0}, {101, 2, 0}, {10, 60, 0}};
  Polyline uniform;
  for (int k = 0; k <= 40; ++k) {
    uniform.push_back(pyramid(route, {0, 1, 2, 3}, 1 + double(k) / 40));
  }
  EXPECT_TRUE(crosses_itself(uniform));
  for (const char* yaml : {"{samples: 40}", "{samples: 40, tangents: chord}"}) {
    EXPECT_FALSE(crosses_itself(smoothed(route, yaml)));
  }
}

/// True if these points are among those of the route, in their order.
bool passes(const Polyline& route, const Polyline& points) {
  auto at = route.begin();
  return std::all_of(points.begin(), points.end(), [&](const Vec3& p) {
    at = std::find(at, route.end(), p);
    return at != route.end();
  });
}

double largest_turn(const Polyline& route) {
  double maximum = 0;
  for (std::size_t i = 1; i + 1 < route.size(); ++i) {
    maximum =
        std::max(maximum, turn_angle_in_space(route[i] - route[i - 1], route[i + 1] - route[i]));
  }
  return maximum;
}

TEST(Hermite, PassesAllWaypointsWithoutAKink) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    RandomStream random(seed);
    Polyline route = {random.in({{0, 0, 0}, {10, 10, 10}})};
    for (int i = 0; i < 7; ++i) {
      // Turns of up to 90 degrees: at sharper ones the curve is too short to be fine at any step.
      const Vec3 step = random.in({{1, -1, -1}, {9, 1, 1}});
      route.push_back(route.back() + random.uniform(0.1, 10) * step);
    }
    const std::string tangents = seed % 2 == 0 ? "chord" : "parabola";
    const auto turn_at = [&](int samples) {
      const Polyline smooth =
          smoothed(route, "{samples: " + std::to_string(samples) + ", tangents: " + tangents + "}");
      EXPECT_EQ(smooth.size(), std::size_t(7 * samples + 1));
      EXPECT_TRUE(passes(smooth, route));
      return largest_turn(smooth);
    };
    const double coarse = turn_at(250);
    EXPECT_LT(coarse, radians(20)) << seed;
    EXPECT_NEAR(turn_at(1000), coarse / 4, 0.05 * coarse) << seed;
  }
}

TEST(Hermite, TellsTheLeastRadiusOfTheCurveAndTheStep) {
  const Request request = testing::open_request(kBends);
  const auto smooth = [&](const char* yaml) {
    return make_smoother("hermite", yaml)->smooth(kBends, request);
  };
  const PlanResult fine = smooth("{samples: 1000}");
  double radius = kInfinity;
  for (std::size_t i = 2; i < fine.route.size(); ++i) {
    radius = std::min(radius, radius_through(fine.route[i - 2], fine.route[i - 1], fine.route[i]));
  }
  EXPECT_NEAR(double(counter(fine, "min_radius_cm")) / 100, radius, 0.01 * radius);
  const PlanResult coarse = smooth("{samples: 3}");
  EXPECT_EQ(counter(coarse, "min_radius_cm"), counter(fine, "min_radius_cm"));
  EXPECT_EQ(counter(coarse, "spans"), 3);
  EXPECT_EQ(counter(coarse, "inserted"), 0);
  const PlanResult stepped = smooth("{step_m: 5}");
  EXPECT_EQ(stepped.route.size(), 21u + 16u + 35u + 1u);  // legs of 102, 76.3 and 173 m
  EXPECT_EQ(stepped.message.rfind("2 of 2 corners are rounded by a curve of at least ", 0), 0u);
  EXPECT_NE(stepped.message.find(" m of radius, in legs of up to 5."), std::string::npos)
      << stepped.message;
}

TEST(Hermite, InsertsNodesWhereTheCurveWouldHitAndElseTheCornerStays) {
  // After the second corner the curve runs outside the leg, where the ball is.
  Polyline route = {{0, 0, 0}, {100, 0, 0}, {150, 100, 0}, {250, 100, 0}};
  for (int i = 1; i < 20; ++i) {
    route.emplace_back(250 + 100 * i, i % 2 == 0 ? 100 : 150, 0);
  }
  Request request = testing::open_request(route);
  const auto smoother = make_smoother("hermite");
  const PlanResult open = smoother->smooth(route, request);
  request.world =
      std::make_shared<const World>(testing::world_of({Shape{Sphere{{190, 108, 0}, 7}}}));
  ASSERT_TRUE(check(route, request).ok());
  ASSERT_FALSE(check(open.route, request).ok());
  const PlanResult mended = smoother->smooth(route, request);
  EXPECT_TRUE(check(mended.route, request).ok());
  EXPECT_TRUE(passes(mended.route.waypoints(), route));
  EXPECT_GE(counter(mended, "inserted"), 1);
  EXPECT_EQ(counter(mended, "rounded"), counter(mended, "corners"));
  // Only spans next to the new nodes are rechecked.
  EXPECT_LE(counter(mended, "expanded"),
            counter(open, "expanded") + 5 * 16 * counter(mended, "inserted"));
  // No leg can be halved: the two corners next to the ball are left sharp, and so is the leg
  // between them.
  const PlanResult stays = make_smoother("hermite", "{min_leg_m: 60}")->smooth(route, request);
  EXPECT_TRUE(check(stays.route, request).ok());
  EXPECT_EQ(counter(stays, "inserted"), 0);
  EXPECT_LT(counter(stays, "rounded"), counter(stays, "corners"));
  EXPECT_TRUE(passes(stays.route.waypoints(), {route[2], route[3]}));
  EXPECT_NE(stays.message.find(" left sharp"), std::string::npos);
}

void some_limits(Limits& limits, std::uint64_t seed) {
  limits.min_clearance = seed % 3 == 0 ? 2 : 0;
  limits.min_turn_radius = seed % 2 == 0 ? double(seed % 40) : 0;
  limits.max_turn_space = seed % 5 == 0 ? radians(120) : kPi;
  limits.max_climb = seed % 7 == 0 ? radians(50) : kPi / 2;
  limits.min_leg = seed % 11 == 0 ? 4 : 0;
  limits.max_route_length = seed % 13 == 0 ? 420 : kInfinity;
}

TEST(Hermite, NoRuleOfRandomRoutesGetsWorse) {
  const auto parabola = make_smoother("hermite", "{samples: 6}");
  const auto chord = make_smoother("hermite", "{tangents: chord, step_m: 4, min_leg_m: 8}");
  int changed = 0;
  int changed_unsound = 0;
  int with_nodes = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    const auto [request, route] = testing::random_walk(
        RandomStream(seed), 8, seed % 4 != 0, [&](Limits& limits) { some_limits(limits, seed); });
    if (route.size() < 3) {
      continue;
    }
    const bool sound = check(route, request).ok();
    const PlanResult result = (seed % 2 == 0 ? parabola : chord)->smooth(route, request);
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    ASSERT_EQ(testing::grown_excess(route, result.route, request), "") << seed;
    ASSERT_TRUE(!sound || check(result.route, request).ok()) << seed;
    ASSERT_TRUE(passes(result.route.waypoints(), route.waypoints())) << seed;
    EXPECT_GE(length(result.route), length(route) - 1e-9);
    EXPECT_EQ(result.route != route, counter(result, "rounded") > 0);
    (sound ? changed : changed_unsound) += result.route != route;
    with_nodes += counter(result, "inserted") > 0;
  }
  EXPECT_GT(changed, 300);
  EXPECT_GT(changed_unsound, 25);
  EXPECT_GT(with_nodes, 150);
}

TEST(Hermite, UnderATurnRadiusOnlyCurvesOfThatRadius) {
  const Polyline route = {{0, 0, 0}, {200, 0, 0}, {400, 100, 0}, {410, 110, 0}, {410, 300, 0}};
  Request request = testing::open_request(route);
  request.limits.min_turn_radius = 5;
  ASSERT_TRUE(check(route, request).ok());
  const PlanResult result = make_smoother("hermite")->smooth(route, request);
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_GE(counter(result, "rounded"), 1);
  request.limits.min_turn_radius = 0;
  EXPECT_EQ(counter(make_smoother("hermite")->smooth(route, request), "rounded"), 3);
}

TEST(Hermite, KeepsTheLevelAndTheLengthOfARoute) {
  Polyline route = {{0, 0, 50}, {100, 0, 50}, {100, 100, 50}, {250, 170, 50}};
  Request request = testing::open_request(route);
  request.level_m = 50;
  const auto smoother = make_smoother("hermite");
  const Route level = smoother->smooth(route, request).route;
  EXPECT_TRUE(std::all_of(level.begin(), level.end(), [](const Vec3& p) { return p.z() == 50; }));
  request.limits.max_route_length = (length(level) + 9 * length(route)) / 10;
  const PlanResult shorter = smoother->smooth(route, request);
  EXPECT_TRUE(check(shorter.route, request).ok());
  EXPECT_GT(counter(shorter, "inserted"), 0);
  EXPECT_GT(counter(shorter, "rounded"), 0);
  request.limits.max_route_length = length(route);
  EXPECT_EQ(smoother->smooth(route, request).route, route);
}

TEST(Hermite, OddRoutesAndBudgets) {
  const Vec3 p(3, 4, 5);
  EXPECT_EQ(smoothed({p, p, p}, "{}"), Polyline(3, p));
  EXPECT_EQ(smoothed({p, {9, 9, 9}}, "{}").size(), 2u);
  const Polyline back = {{0, 0, 0}, {50, 0, 0}, {20, 0, 0}};
  EXPECT_EQ(smoothed(back, "{}"), back);
  const Polyline straight = {{0, 0, 0}, {30, 0, 0}, {90, 0, 0}, {91, 0, 0}};
  EXPECT_EQ(smoothed(straight, "{}"), straight);
  // A repeated point hides no corner.
  const Polyline corner = {{0, 0, 0}, {50, 0, 0}, {50, 50, 0}};
  EXPECT_EQ(smoothed({corner[0], corner[1], corner[1], corner[2]}, "{}"), smoothed(corner, "{}"));
  EXPECT_EQ(smoothed(corner, "{step_m: 1e-9}").size(), 20'001u);
  Request request = testing::open_request(kBends);
  request.budget.max_iterations = 20;
  const PlanResult cut = make_smoother("hermite")->smooth(kBends, request);
  EXPECT_EQ(cut.route, kBends);
  EXPECT_TRUE(cut.budget_hit);
  EXPECT_EQ(counter(cut, "expanded"), 20);
  EXPECT_NE(testing::parameter_problems("smoother", "hermite", "{samples: 1}"), "");
  EXPECT_NE(testing::parameter_problems("smoother", "hermite", "{tangents: uniform}"), "");
}
}  // namespace
}  // namespace altiplan::hermite_test
