// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// A position with a heading: the angle of the horizontal direction of motion through the air,
/// counter-clockwise from east, radians.
struct Pose {
  Vec3 position{0, 0, 0};
  double heading = 0;
};

/// Unit vector of a heading.
inline Vec3 unit_heading(double heading) { return {std::cos(heading), std::sin(heading), 0}; }

/// A leg of a route: straight, a wait in one place, or a turn of constant radius and sense. A turn
/// is a circle in the air mass, and its height is linear in time: without wind an arc (of a helix,
/// if it climbs), in wind a trochoid. All kinds share one parameter t in [0, 1], the fraction of
/// the leg's time:
///   p(t) = from + circle(t) + t (drift + climb),  |p''(t)| = radius turn².
struct ALTIPLAN_API Leg {
  enum class Kind { straight, arc, trochoid };

  Vec3 from{0, 0, 0};
  Vec3 to{0, 0, 0};
  double turn = 0;      ///< radians in the air mass, positive to the left, any size; 0: straight
  double radius = 0;    ///< metres, of the circle in the air mass; > 0 if the leg turns
  double heading = 0;   ///< radians, in the air mass at `from`; of a turn alone
  Vec3 drift{0, 0, 0};  ///< horizontal displacement of the air mass during a turn, metres
  double hold_s = 0;    ///< seconds for which the vehicle waits at `from`, which is then `to`

  static Leg straight(const Vec3& from, const Vec3& to) { return {from, to}; }
  static Leg hold(const Vec3& at, double seconds) { return {at, at, 0, 0, 0, {0, 0, 0}, seconds}; }
  /// The turn that begins at a pose and changes the height by `climb`.
  static Leg turning(const Pose& from, double turn, double radius, double climb,
                     const Vec3& drift = Vec3::Zero());

  Kind kind() const {
    return turn == 0 ? Kind::straight : drift.isZero(0) ? Kind::arc : Kind::trochoid;
  }
  bool turns() const { return turn != 0; }
  bool waits() const { return hold_s != 0; }
  /// Position at a fraction of the leg's time; exactly `from` at 0 and `to` at 1.
  Vec3 at(double t) const;
  /// Derivative of the position by t: the displacement over the ground at that rate for a whole
  /// leg; its horizontal part has the direction of the track.
  Vec3 rate(double t) const;
  /// The same direction with a heading even where a turn stands still in the wind; the displacement
  /// of a leg without one.
  Vec3 track(double t) const;
  /// False of a leg so short that what it says of a heading is rounding, or may be anything.
  bool has_heading() const {
    return turns() ? air_length() >= kLengthTolerance : altiplan::has_heading(to - from);
  }
  /// Length of the path over the ground, metres.
  double length() const;
  /// Length of the horizontal path through the air, metres (of a straight leg: over the ground).
  double air_length() const;
  /// Smallest axis-aligned box around the leg.
  Box box() const;
  /// The part between two fractions of time.
  Leg piece(double begin, double end) const;
  /// Bound on the distance between points of the leg and of its chord at equal t: radius turn² / 8.
  double sagitta() const { return radius * turn * turn / 8; }
  /// Points from `from` to `to` whose chords lie at most `tolerance` metres from the leg.
  std::vector<Vec3> chords(double tolerance) const;
  /// The same path flown backwards, in the reversed wind.
  Leg reversed() const;

  bool operator==(const Leg&) const = default;
};

/// A horizontal circle that is flown over the ground to wait; its centre is kept beside it.
struct ALTIPLAN_API Loiter {
  double radius = 0;  ///< metres, positive
  int sense = 1;      ///< 1: to the left (counter-clockwise from above), -1: to the right

  /// True if p lies on the circle.
  bool passes(const Vec3& centre, const Vec3& p) const;
  /// The direction over the ground at a point of the circle, of any length.
  Vec3 course(const Vec3& centre, const Vec3& p) const {
    return sense * Vec3(centre.y() - p.y(), p.x() - centre.x(), 0);
  }
  /// The whole circle.
  Leg circle(const Vec3& centre) const {
    return Leg::turning({centre + Vec3(radius, 0, 0), sense * kPi / 2}, sense * 2 * kPi, radius, 0);
  }
  bool operator==(const Loiter&) const = default;
};
}  // namespace altiplan
