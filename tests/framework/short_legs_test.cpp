// SPDX-License-Identifier: Apache-2.0
// Legs too short to have a heading: it lasts through any number of them, turns or straight.
#include <gtest/gtest.h>

#include "altiplan/check.hpp"
#include "altiplan/measures.hpp"
#include "support/support.hpp"

namespace altiplan::short_legs_test {
namespace {

using Rules = std::vector<std::string>;

constexpr double kRadius = 300;
const Vec3 kStart{0, 0, 100};

/// A chain of legs, each from the end of the last one.
struct Chain {
  std::vector<Leg> legs;

  Vec3 end() const { return legs.empty() ? kStart : legs.back().to; }
  Chain& straight(double heading, double length) {
    legs.push_back(Leg::straight(end(), end() + length * unit_heading(heading)));
    return *this;
  }
  Chain& turn(double heading, double turn, double radius, double climb = 0) {
    legs.push_back(Leg::turning({end(), heading}, turn, radius, climb));
    return *this;
  }
  Chain& up(double climb) {
    legs.push_back(Leg::straight(end(), end() + Vec3(0, 0, climb)));
    return *this;
  }
  Route route() const {
    Route route{kStart};
    for (const Leg& leg : legs) {
      route.push_back(leg);
    }
    return route;
  }
};

Request request_for(const Route& route, double max_turn, double radius) {
  Request request =
      testing::request_in(World(), route.front(), route.back(), {{-1e4, -1e4, 0}, {1e4, 1e4, 1e3}});
  request.limits.max_turn_horizontal = max_turn;
  request.limits.min_turn_radius = radius;
  return request;
}

Rules violated(const Route& route, const Request& request) {
  Rules rules;
  for (const Violation& violation : check(route, request).violations) {
    rules.push_back(violation.constraint + "@" + std::to_string(violation.at));
  }
  return rules;
}
/// By a limit on corners, on radii, and by both.
Rules by_corners(const Chain& chain) {
  return violated(chain.route(), request_for(chain.route(), radians(30), 0));
}
Rules by_radius(const Chain& chain) {
  return violated(chain.route(), request_for(chain.route(), kPi, kRadius));
}

TEST(ShortTurns, HideNoCornerAndNoReversal) {
  for (const double length : {1e-13, 1e-9, 1e-7, 9e-7}) {
    for (const int count : {1, 2, 7}) {
      for (const double corner : {radians(31), kPi / 2, kPi, -kPi / 2}) {
        Chain chain;
        chain.straight(0, 200);
        for (int i = 0; i < count; ++i) {
          chain.turn(corner * (i + 1) / (count + 1), length / kRadius, kRadius);
        }
        chain.straight(corner, 200);
        const std::string at = "@" + std::to_string(count + 1);
        EXPECT_EQ(by_corners(chain), Rules{"turn_angle" + at}) << length << ' ' << count;
        EXPECT_EQ(by_radius(chain), (corner == radians(31) ? Rules{} : Rules{"turn_radius" + at}))
            << length << ' ' << count;
        const Route route = chain.route();
        EXPECT_NEAR(measure(route, request_for(route, kPi, 0)).max_turn_deg.value(),
                    degrees(std::abs(corner)), 1e-5);
      }
    }
  }
}

TEST(ShortTurns, HideNoCornerInSpace) {
  Chain chain;
  chain.straight(0, 200).turn(radians(45), 1e-9, kRadius).straight(kPi / 2, 200);
  Request request = request_for(chain.route(), kPi, 0);
  request.limits.max_turn_space = radians(50);
  EXPECT_EQ(violated(chain.route(), request), Rules{"turn_angle@2"});
}

TEST(ShortTurns, HideNoCornerBesideClimbsAndRepeatedPoints) {
  for (const double climb : {0.0, 1e-9, 1e-3, 30.0}) {
    Chain chain;
    chain.straight(0, 200).turn(0.5, 1e-9, kRadius).up(climb).turn(1, 1e-9, kRadius, climb);
    chain.straight(kPi / 2, 200);
    EXPECT_EQ(by_corners(chain), Rules{"turn_angle@4"}) << climb;
  }
}

TEST(ShortTurns, OfWhichManyAddUpToACornerHideItToo) {
  Chain chain;
  chain.straight(0, 200);
  constexpr int kCount = 9000;
  const double each = kPi / 2 / kCount;
  for (int i = 0; i < kCount; ++i) {
    chain.turn(i * each, each, 9e-7 / each);
  }
  chain.straight(kPi / 2, 200);
  EXPECT_EQ(by_corners(chain), Rules{"turn_angle@" + std::to_string(kCount + 1)});
}

TEST(ShortTurns, HideNoHeadingOfStartAndGoal) {
  Chain chain;
  chain.turn(kPi / 4, 1e-9, kRadius).straight(kPi / 2, 200);
  Request request = request_for(chain.route(), radians(50), kRadius);
  request.start.velocity = {20, 0, 0};
  EXPECT_EQ(violated(chain.route(), request), (Rules{"turn_angle@1", "turn_radius@1"}));
  for (const double length : {1e-9, 9e-7, 2e-6, 1e-4}) {
    Chain last;
    last.straight(0, 200).turn(0.005 / length * 1e-6, length / kRadius, kRadius);
    request = request_for(last.route(), kPi, 0);
    request.goal.heading = last.legs.back().heading + last.legs.back().turn;
    EXPECT_EQ(violated(last.route(), request), length < 1e-6 ? Rules{"goal_heading@2"} : Rules{});
    request.goal.heading = 0.1 / length * 1e-6;
    EXPECT_EQ(violated(last.route(), request), Rules{"goal_heading@2"}) << length;
  }
}

TEST(ShortTurns, HideNoLoiterCircle) {
  for (const double length : {1e-9, 9e-7, 2e-6}) {
    Chain chain;
    chain.turn(0, length / kRadius, kRadius).straight(kPi / 2, 200);
    Request request = request_for(chain.route(), kPi, 0);
    request.start.position = kStart + Vec3(0, kRadius, 0);
    request.start.loiter = Loiter{kRadius, 1};
    EXPECT_EQ(violated(chain.route(), request), length < 1e-6 ? Rules{"start_heading@1"} : Rules{});
  }
}

TEST(ShortTurns, ALittleLongerOnesAreTangentialTooWhereARadiusIsAskedFor) {
  for (const double length : {1.1e-6, 2e-6, 1e-5, 1e-3}) {
    Chain chain;
    chain.straight(0, 200);
    const double corner = 0.9e-6 / length;  // times its length within the tolerance
    const int count = int(kPi / 2 / corner) + 1;
    for (int i = 0; i < count; ++i) {
      chain.turn(kPi / 2 * (i + 1) / (count + 1), length / kRadius, kRadius);
    }
    chain.straight(kPi / 2, 200);
    EXPECT_EQ(by_radius(chain).size(), std::size_t(count + 1)) << length;
  }
}

TEST(ShortStraightLegs, BetweenTurnsAreTangentialToo) {
  for (const double length : {1e-9, 2e-6, 1e-5, 1e-3}) {
    Chain chain;
    chain.straight(0, 200);
    const double corner = 0.9e-6 / std::max(length, 2e-6);
    const int count = std::min(int(kPi / 4 / corner) + 1, 50);
    for (int i = 0; i < count; ++i) {
      const double heading = 2 * (i + 1) * corner;
      chain.turn(heading, 2e-6 / kRadius, kRadius).straight(heading + corner, length);
    }
    EXPECT_GT(by_radius(chain).size(), std::size_t(count - 1)) << length;
  }
}

TEST(ShortLegs, DoNotSpoilARouteThatIsTangential) {
  for (const double length : {1e-13, 1e-9, 1e-7, 9e-7, 1.1e-6, 1e-5}) {
    const double part = length / (kRadius * kPi / 2);
    const Leg turn = Leg::turning({kStart + Vec3(900, 0, 0), 0}, kPi / 2, kRadius, 0);
    Chain chain;
    chain.straight(0, 900);
    for (const auto& [begin, end] :
         {std::pair(0.0, part), std::pair(part, 0.5), std::pair(0.5, 0.5 + part),
          std::pair(0.5 + part, 1 - part), std::pair(1 - part, 1.0)}) {
      chain.legs.push_back(turn.piece(begin, end));
    }
    chain.straight(kPi / 2, 900);
    EXPECT_EQ(by_radius(chain), Rules{}) << length;
  }
}

TEST(ShortTurns, ThatHardlyMoveOverTheGroundHaveItsHeading) {
  // In a wind of the airspeed the turn begins standing still over the ground.
  for (const double share : {0.5, 0.999, 1.0}) {
    Request request = request_for({kStart, kStart + Vec3(0, 200, 0)}, radians(30), 0);
    request.vehicle.speed_mps = 20;
    request.wind.layers = {{-kInfinity, {20 * share, 0, 0}}};
    const double turn = 1.2e-6 / kRadius;
    const Leg slow =
        Leg::turning({kStart + Vec3(200, 0, 0), kPi}, turn, kRadius, 0, {1.2e-6 * share, 0, 0});
    Route route{kStart};
    route.push_back(Leg::straight(kStart, slow.from));
    route.push_back(slow);
    request.goal.position = route.back();
    EXPECT_EQ(violated(route, request), Rules{"turn_angle@1"}) << share;
  }
}
}  // namespace
}  // namespace altiplan::short_legs_test
