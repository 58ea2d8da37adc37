// SPDX-License-Identifier: Apache-2.0
// Each limit on a turn, kept and just violated.
#include <gtest/gtest.h>

#include <algorithm>

#include "altiplan/check.hpp"
#include "altiplan/ground.hpp"
#include "support/support.hpp"

namespace altiplan::turn_check_test {
namespace {

using testing::request_in;
using testing::world_of;

constexpr double kBig = 1e4;
const Box kVolume{{-kBig, -kBig, -kBig}, {kBig, kBig, kBig}};
constexpr double kRadius = 80;
constexpr double kLength = kPi * kRadius;  ///< of half a circle
const Pose kEast{{0, 0, 100}, 0};

/// Half a circle to the left, whose easternmost point is (80, 80).
Leg half_circle(double climb = 0, const Vec3& drift = Vec3::Zero()) {
  return Leg::turning(kEast, kPi, kRadius, climb, drift);
}

/// Ground that rises eastward by half a metre per metre, up to where it ends.
class Slope final : public Environment, public Ground {
 public:
  explicit Slope(double end) : end_(end) {}

 private:
  Box do_bounds() const override { return {{-kBig, -kBig, -kBig}, {end_, kBig, kBig}}; }
  double do_clearance(const Vec3& p) const override {
    return (p.z() - 0.5 * std::min(p.x(), end_)) / std::hypot(1, 0.5);
  }
  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double x, double) const override {
    return x <= end_ ? std::optional(0.5 * x) : std::nullopt;
  }
  bool is_below(const Vec3& a, const Vec3& b) const { return std::max(a.x(), b.x()) <= end_; }
  double do_gap(const Vec3& a, const Vec3& b, double) const override {
    return is_below(a, b) ? std::min(a.z() - 0.5 * a.x(), b.z() - 0.5 * b.x()) : -kInfinity;
  }
  double do_gap_max(const Vec3& a, const Vec3& b) const override {
    return is_below(a, b) ? std::max(a.z() - 0.5 * a.x(), b.z() - 0.5 * b.x()) : kInfinity;
  }
  // As an elevation model does: of the ground that there is.
  double do_slope(const Box& box) const override { return box.min.x() <= end_ ? 0.5 : 0; }

  double end_;
};

class TurnCheck : public ::testing::Test {
 protected:
  /// The violations of a route of these legs.
  std::string rules(const std::vector<Leg>& legs) {
    Route route;
    for (const Leg& leg : legs) {
      route.push_back(leg);
    }
    request_.start.position = route.front();
    request_.goal.position = route.back();
    result_ = check(route, request_);
    std::string text;
    for (const Violation& violation : result_.violations) {
      text += violation.constraint + "@" + std::to_string(violation.at) + " ";
    }
    return text;
  }
  void over(double end) {
    request_.world = std::make_shared<World>(world_of(std::make_shared<Slope>(end)));
  }

  Request request_ = request_in(World(), {0, 0, 100}, {0, 160, 100}, kVolume);
  Limits& limits_ = request_.limits;
  CheckResult result_;
};

TEST_F(TurnCheck, Volume) {
  request_.volume.max.x() = 80;
  EXPECT_EQ(rules({half_circle()}), "");
  request_.volume.max.x() = 79.99;
  EXPECT_EQ(rules({half_circle()}), "volume@0 ");
  EXPECT_EQ(result_.violations.at(0).message, "the turn leaves the volume by 0.01 m");
}

TEST_F(TurnCheck, RadiusAndLength) {
  limits_.min_turn_radius = 80;
  limits_.max_leg = kLength;
  limits_.min_leg = kLength;
  EXPECT_EQ(rules({half_circle()}), "");
  limits_.min_turn_radius += 1e-3;
  EXPECT_EQ(rules({half_circle()}), "turn_radius@0 ");
  limits_.min_turn_radius = 0;
  limits_.max_leg -= 1e-3;
  EXPECT_EQ(rules({half_circle()}), "leg_length@0 ");
}

TEST_F(TurnCheck, ClimbAndSinkThroughTheAir) {
  limits_.max_climb = radians(10);
  limits_.max_sink = radians(5);
  const double rise = kLength * std::tan(radians(10));
  const double fall = kLength * std::tan(radians(5));
  EXPECT_EQ(rules({half_circle(rise)}), "");
  EXPECT_EQ(rules({half_circle(rise + 1e-3)}), "climb_angle@0 ");
  EXPECT_EQ(rules({half_circle(-fall)}), "");
  EXPECT_EQ(rules({half_circle(-fall - 1e-3)}), "climb_angle@0 ");
  // Against the wind a straight leg takes longer, and climbs less steeply through the air.
  request_.vehicle.speed_mps = 20;
  const auto straight = [&](double z) { return Leg::straight({0, 0, 100}, {1000, 0, 100 + z}); };
  request_.wind.layers = {{-kInfinity, {-10, 0, 0}}};
  EXPECT_EQ(rules({straight(2000 * std::tan(radians(10)))}), "");
  EXPECT_EQ(rules({straight(2000 * std::tan(radians(10)) + 0.1)}), "climb_angle@0 ");
}

TEST_F(TurnCheck, DriftIsThatOfTheWind) {
  request_.vehicle.speed_mps = 20;
  const Vec3 wind(5, -3, 0);
  request_.wind.layers = {{-kInfinity, wind}, {200, {0, 8, 0}}};
  const Vec3 drift = kLength / 20 * wind;
  EXPECT_EQ(rules({half_circle(0, drift)}), "");
  EXPECT_EQ(rules({half_circle(90, drift)}), "");
  EXPECT_EQ(rules({half_circle(0)}), "wind@0 ");
  EXPECT_EQ(rules({half_circle(0, drift + Vec3(0, 1e-3, 0))}), "wind@0 ");
  EXPECT_EQ(rules({half_circle(120, drift)}), "wind@0 ") << "into the layer above";
}

TEST_F(TurnCheck, ACourseThatTheWindDoesNotAllow) {
  request_.vehicle.speed_mps = 20;
  const Leg north = Leg::straight({0, 0, 100}, {0, 500, 100});
  request_.wind.layers = {{-kInfinity, {19, 0, 0}}};
  EXPECT_EQ(rules({north}), "");
  request_.wind.layers = {{-kInfinity, {21, 0, 0}}};
  EXPECT_EQ(rules({north}), "wind@0 ");
  EXPECT_EQ(result_.violations.at(0).message,
            "the leg cannot be flown: an airspeed of 20.00 m/s does not hold its course in a wind "
            "of 21.00 m/s");
}

TEST_F(TurnCheck, NeighboursJoinTangentially) {
  limits_.min_turn_radius = 50;
  const Leg turn = half_circle();
  const auto approach = [&](double heading) {
    return Leg::straight(turn.from - 300 * unit_heading(heading), turn.from);
  };
  const auto leave = [&](double heading) {
    return Leg::straight(turn.to, turn.to + 300 * unit_heading(heading));
  };
  EXPECT_EQ(rules({approach(0), turn, leave(kPi)}), "");
  EXPECT_EQ(rules({approach(radians(0.1)), turn, leave(kPi)}), "turn_radius@1 ");
  EXPECT_EQ(rules({approach(0), turn, leave(radians(179.9))}), "turn_radius@2 ");
}

TEST_F(TurnCheck, HeadingAtTheGoal) {
  request_.goal.heading = kPi;
  EXPECT_EQ(rules({half_circle()}), "");
  request_.goal.heading = radians(179.9);
  EXPECT_EQ(rules({half_circle()}), "goal_heading@1 ");
}

TEST_F(TurnCheck, HeightAboveGroundIsLeastInTheMiddle) {
  over(kBig);
  limits_.min_ground_clearance = 60;
  EXPECT_EQ(rules({half_circle()}), "");
  limits_.min_ground_clearance = 60.001;
  EXPECT_EQ(rules({half_circle()}), "ground_clearance@0 ");
  EXPECT_NEAR(result_.violations.at(0).value, 60, 0.01);
  limits_.min_ground_clearance.reset();
  const auto band = [&](double min, double max) {
    limits_.altitude = {{AltitudeBand::Datum::ground, min, max}};
  };
  band(60, 100);
  EXPECT_EQ(rules({half_circle()}), "");
  band(60.001, 100);
  EXPECT_EQ(rules({half_circle()}), "altitude@0 ");
  band(60, 99.999);
  EXPECT_EQ(rules({half_circle()}), "altitude@0 ");
}

TEST_F(TurnCheck, GroundThatEndsBelowTheTurn) {
  over(80.001);
  EXPECT_EQ(rules({half_circle()}), "");
  over(60);
  EXPECT_EQ(rules({half_circle()}), "ground@0 ");
  // 80 sin t = 60, and y = 80 (1 - cos t).
  EXPECT_EQ(result_.violations.at(0).message,
            "there is no ground of known height below (60.00, 27.08, 100.00), a point of the leg");
  over(-1);
  EXPECT_EQ(rules({half_circle()}), "ground@0 ");
}

/// Admits what stays west of a line.
class West final : public Constraint {
 public:
  explicit West(double x) : x_(x) {}

 private:
  bool do_admits(const Motion& leg) const override {
    return std::max(leg.from.x(), leg.to.x()) <= x_;
  }
  std::vector<Violation> do_violations(const Polyline& route, const Request&) const override {
    for (std::size_t i = 0; i < route.size(); ++i) {
      if (route[i].x() > x_ + 10) {
        return {{"", i, route[i].x(), x_, "far east"}};
      }
    }
    return {};
  }
  double x_;
};

TEST_F(TurnCheck, ConstraintsSeeChordsAndNameLegs) {
  const Leg first = Leg::straight({-300, 0, 100}, {0, 0, 100});
  const auto west = [&](double x) { request_.constraints = {{"west", std::make_shared<West>(x)}}; };
  west(80);
  EXPECT_EQ(rules({first, half_circle()}), "");
  west(79);
  EXPECT_EQ(rules({first, half_circle()}).substr(0, 7), "west@1 ");
  west(60);  // also by its `violations`, whose points are those of the chords
  EXPECT_EQ(rules({first, half_circle()}).substr(0, 7), "west@1 ");
  const auto& all = result_.violations;
  const auto by_points = std::find_if(all.begin(), all.end(),
                                      [](const Violation& v) { return v.message == "far east"; });
  ASSERT_NE(by_points, all.end());
  EXPECT_EQ(by_points->at, 1u);
}
}  // namespace
}  // namespace altiplan::turn_check_test
