// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/smoothing/corners.hpp"

#include <gtest/gtest.h>

#include "support/walks.hpp"

namespace altiplan::kit::corners_test {
namespace {

using testing::open_request;

/// The corner cut off by a straight leg, at these distances one after another.
CurveOf chamfer(std::vector<double> reaches) {
  return [reaches = std::move(reaches)](const Corner& corner, int attempt) {
    return corner.turn > 0 && std::size_t(attempt) < reaches.size()
               ? std::optional(Polyline{corner.at - reaches[std::size_t(attempt)] * corner.into,
                                        corner.at + reaches[std::size_t(attempt)] * corner.out_of})
               : std::nullopt;
  };
}

TEST(Corners, TheFirstChoiceThatKeepsEveryRuleIsTaken) {
  const Polyline route = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}};
  Request request = open_request(route);
  request.limits.min_leg = 52;
  const RoundedRoute rounded = round_corners(route, request, chamfer({50, 45, 30, 20}));
  EXPECT_EQ(rounded.route, (Polyline{{0, 0, 0}, {55, 0, 0}, {100, 45, 0}, {100, 100, 0}}))
      << "50 leaves 50 m of a leg";
  EXPECT_EQ(rounded.attempts, 2);
  EXPECT_EQ(rounded.corners, 1);
  EXPECT_EQ(rounded.replaced, 1);
  EXPECT_EQ(round_corners(route, request, chamfer({90, 80})).refused, 1);
}

TEST(Corners, TellsACurveWhatItMayUse) {
  const Polyline route = {{0, 0, 0}, {100, 0, 0}, {100, 60, 0}, {100, 60, 40}};
  std::vector<Corner> seen;
  round_corners(route, open_request(route), [&](const Corner& corner, int attempt) {
    seen.push_back(corner);
    return chamfer({25})(corner, attempt);
  });
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].at, route[1]);
  EXPECT_EQ(seen[0].into, Vec3(1, 0, 0));
  EXPECT_EQ(seen[0].out_of, Vec3(0, 1, 0));
  EXPECT_NEAR(seen[0].turn, kPi / 2, 1e-12);
  EXPECT_EQ(seen[0].leg_into, 100);
  EXPECT_EQ(seen[0].fair_reach(), 30);
  EXPECT_FALSE(seen[0].last);
  EXPECT_EQ(seen[1].leg_into, 60);
  EXPECT_EQ(seen[1].room_into, 35);
  EXPECT_TRUE(seen[1].last);
}

TEST(Corners, ACornerThatStaysKeepsItsRadius) {
  // The fillet of the second corner shrinks with the leg that the first one's cut leaves it, which
  // its own cut would mend. Where it has none, the first corner takes less, or stays as well.
  const Polyline route = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {200, 100, 0}};
  Request request = open_request(route);
  request.limits.min_turn_radius = 28;
  const auto first_only = [](std::vector<double> reaches) {
    return [inner = chamfer(std::move(reaches))](const Corner& corner, int attempt) {
      return corner.last ? std::nullopt : inner(corner, attempt);
    };
  };
  EXPECT_EQ(round_corners(route, request, chamfer({50})).replaced, 2);
  EXPECT_EQ(round_corners(route, request, first_only({60})).route, route);
  EXPECT_EQ(round_corners(route, request, first_only({60})).refused, 1);
  const RoundedRoute less = round_corners(route, request, first_only({60, 50, 40}));
  EXPECT_EQ(less.replaced, 1);
  EXPECT_EQ(less.route[1].x(), 60);
  EXPECT_TRUE(check(less.route, request).ok());
}

TEST(Corners, WhatIsBrokenIsMendedOrGetsNoWorse) {
  const Polyline route = {{0, 0, 0}, {100, 0, 0}, {0, 10, 0}};
  Request request = open_request(route);
  request.limits.max_turn_space = radians(100);
  EXPECT_TRUE(check(round_corners(route, request, chamfer({30})).route, request).ok());
  request.limits.max_turn_space = radians(80);  // a cut leaves 87 and 87 of 174 degrees
  const RoundedRoute rounded = round_corners(route, request, chamfer({30}));
  EXPECT_EQ(rounded.replaced, 1);
  EXPECT_EQ(testing::grown_excess(route, rounded.route, request), "");
}

TEST(Corners, ATurnAtTheStartExcusesNoOther) {
  // The vehicle has to turn back at once, which no curve mends; the corner turns by 80 degrees, and
  // a hook in its place would turn by more.
  const Polyline route = {{0, 0, 0}, {100, 0, 0}, {117, 98, 0}};
  Request request = open_request(route);
  request.start.velocity = {-1, 0.1, 0};
  request.limits.max_turn_space = radians(100);
  EXPECT_EQ(check(route, request).violations.size(), 1u);
  const auto hook = [](const Corner&, int attempt) {
    return attempt == 0 ? std::optional(Polyline{{80, 0, 0}, {70, -20, 0}}) : std::nullopt;
  };
  EXPECT_EQ(round_corners(route, request, hook).route, route);
  EXPECT_EQ(round_corners(route, request, chamfer({30})).replaced, 1);
}

/// A rule that no leg shows: at most so many waypoints.
class AtMost final : public Constraint {
 public:
  explicit AtMost(std::size_t points) : points_(points) {}

 private:
  bool do_admits_all() const override { return true; }
  std::vector<Violation> do_violations(const Polyline& route, const Request&) const override {
    if (route.size() <= points_) {
      return {};
    }
    return {{"", 0, double(route.size()), double(points_), "too many waypoints"}};
  }
  std::size_t points_;
};

TEST(Corners, RulesOfWholeRoutesAreKeptCornerByCorner) {
  const Polyline route = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {200, 100, 0}, {200, 200, 0}};
  Request request = open_request(route);
  for (const std::size_t most : {5u, 6u, 7u, 8u, 4u}) {
    request.constraints = {{"at_most", std::make_shared<AtMost>(most)}};
    const RoundedRoute rounded = round_corners(route, request, chamfer({40}));
    EXPECT_EQ(rounded.replaced, std::int64_t(std::max<std::size_t>(most, 5) - 5)) << most;
    EXPECT_EQ(rounded.route.size(), std::max<std::size_t>(most, 5)) << most;
  }
}

TEST(Corners, OddRoutesComeBackAndBudgetsHold) {
  const Vec3 p(1, 2, 3);
  for (const Polyline& route :
       {Polyline{p, p, p}, Polyline{{0, 0, 0}, {9, 0, 0}, {3, 0, 0}},
        Polyline{{0, 0, 0}, {3, 0, 0}, {9, 0, 0}}, Polyline{p, {4, 4, 4}}}) {
    const RoundedRoute rounded = round_corners(route, open_request(route), chamfer({1}));
    EXPECT_EQ(rounded.route, route);
    EXPECT_EQ(rounded.replaced, 0);
  }
  const Polyline bent = {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}};
  Request request = open_request(bent);
  request.budget.max_iterations = 1;
  const RoundedRoute rounded = round_corners(bent, request, chamfer({1}));
  EXPECT_TRUE(rounded.budget_hit);
  EXPECT_EQ(rounded.replaced, 1);
}

TEST(Corners, NoRuleGetsWorseWhateverTheCurves) {
  int replaced = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    RandomStream random(seed);
    const auto limits = [&](Limits& l) {
      l.min_clearance = seed % 2 == 0 ? 2 : 0;
      l.min_turn_radius = seed % 3 == 0 ? 15 : 0;
      l.max_climb = seed % 5 == 0 ? radians(40) : kPi / 2;
      l.min_leg = seed % 7 == 0 ? 4 : 0;
      l.max_turn_space = seed % 11 == 0 ? radians(100) : kPi;
    };
    testing::Walk walk = testing::random_walk(random.sub("walk"), 8, seed % 4 != 0, limits);
    if (walk.route.size() < 3) {
      continue;
    }
    // Curves of any shape, choices of any length.
    const RoundedRoute rounded =
        round_corners(walk.route.waypoints(), walk.request, [&](const Corner& corner, int attempt) {
          Polyline curve;
          for (std::int64_t n = random.integer(0, 4); n > 0; --n) {
            const double reach = random.uniform() * corner.leg_into;
            curve.push_back(corner.at - reach * corner.into +
                            random.in({Vec3::Constant(-5), Vec3::Constant(5)}));
          }
          return attempt < 4 ? std::optional(curve) : std::nullopt;
        });
    ASSERT_EQ(testing::grown_excess(walk.route, rounded.route, walk.request), "") << seed;
    replaced += rounded.replaced > 0;
  }
  EXPECT_GT(replaced, 100);
}
}  // namespace
}  // namespace altiplan::kit::corners_test
