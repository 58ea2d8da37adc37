// SPDX-License-Identifier: Apache-2.0
// Lengths of Dubins paths by ruler and compass: circles, their intersections and tangents, as
// points in the plane.
#pragma once

#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <complex>
#include <vector>

#include "altiplan/leg.hpp"
#include "altiplan/random.hpp"

namespace altiplan::dubins_oracle {

using Point = std::complex<double>;

struct Place {
  Point at;
  double heading;
};

inline Place place(const Pose& pose) {
  return {{pose.position.x(), pose.position.y()}, pose.heading};
}
inline Point direction(double heading) { return std::polar(1.0, heading); }
inline Point left_of(Point u) { return {-u.imag(), u.real()}; }
inline double dot(Point a, Point b) { return (std::conj(a) * b).real(); }

/// Angle from a to b, both seen from a centre, turning to the left (sense 1) or right (-1).
inline double swept(Point a, Point b, int sense) {
  const double angle = sense * std::arg(b / a);
  return angle < 0 ? angle + 2 * kPi : angle;
}

/// The points that two circles share.
inline std::vector<Point> shared(Point a, double ra, Point b, double rb) {
  const double d = std::abs(b - a);
  const double along = (d * d + ra * ra - rb * rb) / (2 * d);
  const double square = ra * ra - along * along;
  if (square < 0) {
    return {};
  }
  const Point u = (b - a) / d;
  return {a + along * u + std::sqrt(square) * left_of(u),
          a + along * u - std::sqrt(square) * left_of(u)};
}

struct Parts {
  double t = kInfinity;
  double p = kInfinity;  ///< metres if straight
  double q = kInfinity;
  double length = kInfinity;
};

/// Turn `a`, straight, turn `b` (1 left, -1 right).
inline Parts with_straight(const Place& from, const Place& to, double r, int a, int b) {
  const Point c0 = from.at + a * r * left_of(direction(from.heading));
  const Point c1 = to.at + b * r * left_of(direction(to.heading));
  std::vector<Point> leaves;
  if (a == b) {
    const Point u = (c1 - c0) / std::abs(c1 - c0);
    leaves = {c0 - a * r * left_of(u)};
  } else {
    // The tangent passes the middle; its point of contact lies on Thales' circle.
    const Point middle = (c0 + c1) / 2.0;
    leaves = shared(c0, r, (c0 + middle) / 2.0, std::abs(middle - c0) / 2);
  }
  for (const Point& leave : leaves) {
    const Point arrive = a == b ? leave + (c1 - c0) : c0 + c1 - leave;
    const Point u = -left_of(leave - c0) * double(-a);
    if (dot(u, arrive - leave) >= 0) {
      Parts parts{swept(from.at - c0, leave - c0, a), std::abs(arrive - leave),
                  swept(arrive - c1, to.at - c1, b)};
      parts.length = r * (parts.t + parts.q) + parts.p;
      return parts;
    }
  }
  return {};
}

/// Three turns, the outer ones with sense `a`; the middle one is at least a half circle, or else
/// less.
inline Parts with_turns(const Place& from, const Place& to, double r, int a, bool half = true) {
  const Point c0 = from.at + a * r * left_of(direction(from.heading));
  const Point c1 = to.at + a * r * left_of(direction(to.heading));
  for (const Point& c : shared(c0, 2 * r, c1, 2 * r)) {
    const Point leave = (c0 + c) / 2.0;
    const Point arrive = (c1 + c) / 2.0;
    Parts parts{swept(from.at - c0, leave - c0, a), swept(leave - c, arrive - c, -a),
                swept(arrive - c1, to.at - c1, a)};
    parts.length = r * (parts.t + parts.p + parts.q);
    if ((parts.p >= kPi) == half) {
      return parts;
    }
  }
  return {};
}

/// LSL, RSR, RSL, LSR, LRL, RLR.
inline std::array<double, 6> lengths(const Place& from, const Place& to, double r) {
  return {with_straight(from, to, r, 1, 1).length,  with_straight(from, to, r, -1, -1).length,
          with_straight(from, to, r, -1, 1).length, with_straight(from, to, r, 1, -1).length,
          with_turns(from, to, r, 1).length,        with_turns(from, to, r, -1).length};
}

inline Pose random_pose(RandomStream& random, double within) {
  const double x = random.uniform(-within, within) / 2;
  const double y = random.uniform(-within, within) / 2;
  return {{x, y, 0}, random.uniform(-kPi, kPi)};
}

inline Pose mirrored(const Pose& pose) {
  const Vec3& p = pose.position;
  return {{p.x(), -p.y(), p.z()}, -pose.heading};
}
inline Pose turned_round(const Pose& pose) { return {pose.position, pose.heading + kPi}; }

/// Legs join, turn without kinks, climb at one gradient, and lead from pose to pose, on their own
/// arithmetic. Returns their horizontal length.
inline double expect_flyable(const std::vector<Leg>& legs, const Pose& from, const Pose& to) {
  const Vec3 apart = to.position - from.position;
  double length = 0;
  for (const Leg& leg : legs) {
    length += leg.air_length();
  }
  const double slack = 1e-9 * (length + apart.norm() + 1);
  Vec3 at = from.position;
  double heading = from.heading;
  for (const Leg& leg : legs) {
    EXPECT_EQ(leg.from, at);
    EXPECT_NEAR(leg.to.z() - leg.from.z(), apart.z() * (leg.air_length() / length), slack);
    if (leg.turns()) {
      EXPECT_NEAR(std::remainder(leg.heading - heading, 2 * kPi), 0, 1e-9);
      heading = leg.heading + leg.turn;
      const Leg again = Leg::turning({leg.from, leg.heading}, leg.turn, leg.radius, 0);
      EXPECT_LT((again.to - leg.to).head<2>().norm(), slack);
    } else {
      const Vec3 along = leg.air_length() * unit_heading(heading);
      EXPECT_LT((leg.from + along - leg.to).head<2>().norm(), slack);
    }
    at = leg.to;
  }
  EXPECT_EQ(at, to.position);
  EXPECT_NEAR(std::remainder(heading - to.heading, 2 * kPi), 0, 1e-9);
  return length;
}
}  // namespace altiplan::dubins_oracle
