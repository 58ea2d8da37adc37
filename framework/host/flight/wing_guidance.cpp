// SPDX-License-Identifier: Apache-2.0
#include "host/flight/wing_guidance.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan::host {
namespace {

constexpr double kGravity = 9.80665;
constexpr double kReaction = 0.5;     ///< seconds of tau beyond the time to roll from side to side
constexpr double kRadiusShare = 0.5;  ///< over the ground, turns into the wind are tighter

/// Signed angle between two horizontal directions, counter-clockwise.
double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.x() * b.x() + a.y() * b.y());
}
}  // namespace

WingGuidance::WingGuidance(const Request& request)
    : wing_(request.vehicle.wing.value()),
      wind_(request.wind),
      radius_(std::max(wing_.turn_radius(), request.limits.min_turn_radius)),
      max_bank_(std::atan(wing_.airspeed_mps * wing_.airspeed_mps / (kGravity * radius_))),
      max_climb_(wing_.airspeed_mps * std::tan(std::min(wing_.climb, request.limits.max_climb))),
      max_sink_(wing_.airspeed_mps * std::tan(std::min(wing_.sink, request.limits.max_descent()))) {
}

void WingGuidance::take_over(const State& state, const Vec3& course, double curvature) {
  const Vec3 wind = wind_.at(state.position);
  Vec3 air = state.velocity - wind;
  if (!has_heading(state.velocity)) {
    const double speed = ground_speed(course, wing_.airspeed_mps, wind).value_or(0);
    air = speed * Vec3(course.x(), course.y(), 0).normalized() - wind;
  }
  heading_ = std::atan2(air.y(), air.x());
  const Vec3 over_ground = velocity(state.position, 0);
  bank_ = bank_for(curvature * over_ground.squaredNorm(), over_ground);
}

double WingGuidance::lookahead(const Vec3& velocity) const {
  const double tau = kReaction + 2 * max_bank_ / wing_.roll_rate;
  return std::min(tau * velocity.head<2>().norm(), kRadiusShare * radius_);
}

Vec3 WingGuidance::velocity(const Vec3& at, double climb_rate) const {
  return wing_.airspeed_mps * unit_heading(heading_) + wind_.at(at) + Vec3(0, 0, climb_rate);
}

State WingGuidance::fly(const State& from, const Vec3& reference, double ahead, double dt) {
  const double roll = wing_.roll_rate * dt;
  const double bank = std::clamp(bank_command(from, reference), bank_ - roll, bank_ + roll);
  const double rate = kGravity * std::tan((bank_ + bank) / 2) / wing_.airspeed_mps;
  const double climb = climb_command(from, reference, ahead);
  const Vec3 drift = dt * (wind_.at(from.position) + Vec3(0, 0, climb));
  State next;
  next.time_s = from.time_s + dt;
  next.position = from.position + drift;
  if (rate == 0) {
    next.position += wing_.airspeed_mps * dt * unit_heading(heading_);
  } else {
    const double chord = 2 * wing_.airspeed_mps / rate * std::sin(rate * dt / 2);
    next.position += chord * unit_heading(heading_ + rate * dt / 2);
  }
  heading_ = std::remainder(heading_ + rate * dt, 2 * kPi);
  bank_ = bank;
  next.velocity = velocity(next.position, climb);
  return next;
}

double WingGuidance::bank_command(const State& from, const Vec3& reference) const {
  const Vec3 over_ground = velocity(from.position, 0);
  const double eta =
      std::clamp(angle_between(over_ground, reference - from.position), -kPi / 2, kPi / 2);
  const double speed = over_ground.norm();
  const double length =
      std::max((reference - from.position).head<2>().norm(), lookahead(over_ground));
  const double across = 2 * speed * speed / length * std::sin(eta);
  return bank_for(across, over_ground);
}

double WingGuidance::bank_for(double across, const Vec3& over_ground) const {
  const double drift = angle_between(over_ground, unit_heading(heading_));
  // In wind close to the airspeed a course across it leaves no acceleration across the course.
  const double share = std::max(std::cos(drift), 0.1);
  return std::clamp(std::atan(across / (kGravity * share)), -max_bank_, max_bank_);
}

double WingGuidance::climb_command(const State& from, const Vec3& reference, double ahead) const {
  const double speed = velocity(from.position, 0).norm();
  const double climb = speed * (reference.z() - from.position.z()) / ahead;
  return std::clamp(climb, -max_sink_, max_climb_);
}
}  // namespace altiplan::host
