// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/request.hpp"

namespace altiplan::host {

/// Flies an aeroplane toward a reference point that runs ahead of it along its route.
///
/// S. Park, J. Deyst, J. P. How: "Performance and Lyapunov Stability of a Nonlinear Path Following
/// Guidance Method", Journal of Guidance, Control, and Dynamics 30(6), 2007, doi:10.2514/1.28957.
/// The acceleration across the ground velocity that leads on a circle through the reference point:
///
///   a = 2 V² / L1 sin(eta)
///
/// V: ground speed; L1: horizontal distance of the reference point; eta: angle from the ground
/// velocity to the reference point. For small errors that is a second-order system of damping
/// 1/sqrt(2) and frequency sqrt(2) V / L1. Straight lines and circles of radius above L1 / 2 are
/// followed without a steady error in calm air, and wind is accounted for by the ground velocity.
///
/// Ours: L1 = tau V, at most half the minimum turn radius, where tau leaves time to roll from one
/// maximum bank to the other; farther from the route, a multiple of the distance to it. Beyond 90
/// degrees sin(eta) stays 1. Turns are coordinated, in the air mass: with the bank angle phi and
/// the angle delta between the velocities through the air and over the ground, a = g tan(phi)
/// cos(delta). Bank and its rate are limited. The climb rate leads to the height of the reference
/// point, within the limits on climb and sink through the air.
class WingGuidance {
 public:
  /// Limits of the vehicle's wing, and of the request if they are tighter.
  explicit WingGuidance(const Request& request);

  /// Continues from that velocity over the ground, or if it is zero, along a course; with the bank
  /// of a turn of that curvature (1/m, positive to the left).
  void take_over(const State& state, const Vec3& course, double curvature = 0);
  /// L1 on the route, at a velocity over the ground.
  double lookahead(const Vec3& velocity) const;
  /// Flies dt seconds toward a point that is `ahead` metres along the route. The wind is that at
  /// the height at which the step begins.
  State fly(const State& from, const Vec3& reference, double ahead, double dt);

  double bank() const { return bank_; }  ///< radians, positive to the left
  double max_bank() const { return max_bank_; }
  double max_turn_rate() const { return wing_.airspeed_mps / radius_; }  ///< radians/s
  Vec3 velocity(const Vec3& at, double climb_rate) const;                ///< over the ground

 private:
  /// Bank angle for an acceleration across the ground velocity.
  double bank_for(double across, const Vec3& over_ground) const;
  double bank_command(const State& from, const Vec3& reference) const;
  double climb_command(const State& from, const Vec3& reference, double ahead) const;

  Wing wing_;
  Wind wind_;
  double radius_;  ///< minimum, metres, in the air mass
  double max_bank_;
  double max_climb_;  ///< m/s
  double max_sink_;
  double heading_ = 0;  ///< through the air
  double bank_ = 0;
};
}  // namespace altiplan::host
