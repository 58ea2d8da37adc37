// SPDX-License-Identifier: Apache-2.0
// Bodies that turn at waypoints and along arcs, against an oracle that follows them from moment to
// moment.
#include <gtest/gtest.h>

#include "altiplan/check.hpp"
#include "reference/body_motion.hpp"
#include "reference/body_tally.hpp"
#include "support/support.hpp"

namespace altiplan::oracle::body_turns_test {
namespace {

constexpr double kScales[] = {1, 10, 100};  // metres, of obstacles and radii

/// A way into a leg and the leg, moved as one.
struct Flight {
  std::optional<Vec3> before;
  Leg leg;
  double speed_mps = 10;

  void move(const Vec3& by) {
    leg.from += by;
    leg.to += by;
    if (before) {
      *before += by;
    }
  }
};

Vec3 drawn_course(Draw& draw, double length) {
  const double yaw = draw(-kPi, kPi);
  const double pitch = draw.below(2) == 0 ? 0 : draw(-1.2, 1.2);
  return length *
         Vec3(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch));
}

Flight drawn_corner(Draw& draw, double scale) {
  const Vec3 in = drawn_course(draw, scale);
  Vec3 out = drawn_course(draw, scale * draw(0.1, 1));
  if (draw.below(6) == 0) {  // back again
    out = {-in.x(), -in.y(), in.z()};
  }
  return {Vec3(-in), Leg::straight({0, 0, 0}, out)};
}

Flight drawn_arc(Draw& draw, double scale) {
  const double radius = scale * draw(0.2, 2);
  const double turn = (draw.below(2) == 0 ? 1 : -1) * draw(0.05, 5);
  const double rise = draw.below(2) == 0 ? 0 : draw(-0.3, 0.3) * radius * std::abs(turn);
  const double speed = std::sqrt(9.80665 * radius * std::tan(draw(0.05, 1)));
  return {{}, Leg::turning({{0, 0, 0}, draw(-kPi, kPi)}, turn, radius, rise), speed};
}

Gap gap_of(const Obstacles& obstacles, const RandomBody& body, const Flight& flight) {
  const Leg& leg = flight.leg;
  Gap least;
  if (leg.turns()) {
    for (const Motion& motion : on_arc(body, leg, flight.speed_mps)) {
      least = nearer(least, gap_on(obstacles, body, motion));
    }
    return least;
  }
  const Matrix first = axes_along(*body.body, *flight.before, leg.from);
  const Matrix then = axes_along(*body.body, leg.from, leg.to);
  for (const Convex& part : body.parts) {
    least = nearer(least, obstacles.gap(swept(part, then, leg.from, leg.to)));
  }
  // Half a turn on the level may go either way.
  const bool reverses = (first * then.transpose()).trace() < -1 + 1e-9L;
  return nearer(least, gap_on(obstacles, body,
                              reverses ? turning_round(body, first, leg.from)
                                       : rotating(body, first, then, leg.from)));
}

std::string text(const Flight& flight, const RandomBody& body) {
  std::ostringstream out;
  out.precision(17);
  const Leg& leg = flight.leg;
  out << "leg " << leg.from.transpose() << " -> " << leg.to.transpose() << ", turn " << leg.turn
      << ", radius " << leg.radius << ", heading " << leg.heading << ", speed " << flight.speed_mps
      << ", pitches " << body.body->pitches << ", yaw " << body.body->yaw.value_or(kInfinity);
  if (flight.before) {
    out << ", from " << flight.before->transpose();
  }
  return out.str();
}

void place_near(Draw& draw, Flight& flight, const Obstacles& obstacles, const RandomBody& body,
                double scale) {
  flight.move(draw.within(obstacles.box.min, obstacles.box.max) - flight.leg.at(draw(0, 1)));
  Gap gap = gap_of(obstacles, body, flight);
  const Vec3 out = draw.point(1).normalized();
  for (double by = 0.1 * scale; gap.low <= 0; by *= 1.5) {
    flight.move(by * out);
    gap = gap_of(obstacles, body, flight);
  }
  flight.move((double(gap.high) - drawn_gap(draw)) * gap.direction.cast<double>());
}

template <class Drawn>
void compare(const char* name, int worlds, std::uint64_t seed, const Drawn& drawn) {
  constexpr int kQueries = 4;  // of each body in each world
  for (const double scale : kScales) {
    Draw draw(seed + std::uint64_t(scale));
    Tally tally;
    for (int world = 0; world < worlds; ++world) {
      const Obstacles obstacles = shapes_of(Kind(world % 5), draw, scale);
      const RandomBody body = random_body(draw);
      Request request =
          testing::request_in(testing::world_of(obstacles.layer), {0, 0, 0}, {0, 0, 0}, Box{});
      request.vehicle.body = body.body;
      request.vehicle.radius_m = body.body->inner_m();
      for (int n = 0; n < kQueries; ++n) {
        Flight flight = drawn(draw, scale);
        place_near(draw, flight, obstacles, body, scale);
        request.vehicle.speed_mps = flight.speed_mps;
        const Gap gap = gap_of(obstacles, body, flight);
        const std::optional<Approach> before =
            flight.before ? std::optional<Approach>(*flight.before) : std::nullopt;
        const bool met = body_meets(before, flight.leg, request) != nullptr;
        EXPECT_TRUE(count(tally, gap, met))
            << name << ", scale " << scale << ", world " << world << ", query " << n << ": met "
            << met << ", gap " << double(gap.low) << " to " << double(gap.high) << '\n'
            << text(flight, body);
      }
    }
    print(name, scale, tally);
    EXPECT_GT(tally.near, tally.answers / 10);
    EXPECT_GT(tally.met, tally.answers / 5);
  }
}

TEST(BodyTurns, AtWaypointsMeetWhatTheOracleFinds) { compare("corner", 4, 1, drawn_corner); }
TEST(NightlyBodyTurns, AtWaypointsMeetWhatTheOracleFinds) {
  compare("corner", 300, 3, drawn_corner);
}
TEST(NightlyBodyTurns, AlongArcsMeetWhatTheOracleFinds) { compare("arc", 100, 4, drawn_arc); }
}  // namespace
}  // namespace altiplan::oracle::body_turns_test
