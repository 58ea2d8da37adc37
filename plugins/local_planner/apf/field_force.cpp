// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "altiplan/world.hpp"
#include "field_pilot.hpp"

namespace apf {

Vec3 FieldPilot::wished_direction(const Observation& seen) {
  to_target_ = seen.local_target - here_;
  if (to_target_.norm() == 0) {
    to_target_ = to_goal_;
  }
  if (p_.side == Side::predicted) {
    to_target_ = way_around(seen);
  }
  sum_up(seen);
  if (steep_goal_) {  // on and up, or down, until the path back is no steeper than the limit
    force_ = heading_ * step_ + Vec3(0, 0, to_goal_.z());
  }
  if (!(force_.norm() > 1e-9)) {
    force_ = to_target_;  // everything cancels: the lack of progress will show
  }
  return within_climb(force_, max_climb(), heading_);
}

void FieldPilot::sum_up(const Observation& seen) {
  const double pull_m = std::min(to_target_.norm(), target_);
  const double k_a =
      p_.attraction * (p_.stronger_goal && to_goal_.norm() <= goal_zone_ ? p_.goal_factor : 1);
  force_ = to_target_.normalized() * (k_a * pull_m / unit_);
  seen.world->near(here_, p_.influence_m + required_,
                   ground_influence_ + std::max(room_of_ground(), required_),
                   [this](const Layer& layer, const Nearby& nearby) { add(layer, nearby); });
  for (const Mover& mover : outlook_.movers()) {
    add(mover);
  }
  if (request_.level_m) {
    force_.z() = 0;
  }
}

void FieldPilot::add(const Layer& layer, const Nearby& nearby) {
  if (layer.environment->ground() != nullptr) {
    // Scaled, so that the gains that hold at d_0 also hold here.
    const double room = nearby.distance - std::max(room_of_ground(), required_);
    repel(nearby.normal, room * (p_.influence_m / ground_influence_));
  } else {
    repel(nearby.normal, nearby.distance - required_);
  }
}

void FieldPilot::add(const Mover& mover) {
  const Vec3 r = here_ - mover.position;
  const double now = r.norm() - mover.radius;
  if (now > p_.influence_m) {
    return;
  }
  const Vec3 w = heading_ * speed_ - mover.velocity;
  const double horizon = std::max(p_.reaction_s, 1e-9);
  const double closing = w.squaredNorm();
  const double t = closing > 0 ? std::clamp(-r.dot(w) / closing, 0.0, horizon) : 0;
  const Vec3 closest = r + w * t;
  const double then = closest.norm() - mover.radius;
  Vec3 away = closest.norm() > 1e-6 ? closest : r;
  if (const Vec3& v = mover.velocity; v.squaredNorm() > 0) {
    // Out of its path, never along it: a mover as fast as the vehicle would push it along forever.
    const Vec3 aside = away - v * (std::max(0.0, away.dot(v)) / v.squaredNorm());
    away = aside.norm() > 0.01 * away.norm() ? aside : away;
  }
  if (away.norm() > 0) {
    repel(away.normalized(), then + (now - then) * (t / horizon));
  }
}

void FieldPilot::repel(Vec3 away, double room) {
  const double d0 = p_.influence_m / unit_;
  const double d = std::max(room, 1e-3 * p_.influence_m) / unit_;
  double size = repulsion(p_.repulsion, d, d0);
  if (size == 0) {
    return;
  }
  if (p_.variant == Variant::modified) {
    // Minus the gradient of k_r / 2 (1/d - 1/d0)^2 rho^m, rho = to goal / start to goal.
    const double m = p_.goal_exponent;
    const double rho = to_goal_.norm() / start_to_goal_;
    const double gap = 1 / d - 1 / d0;
    size *= std::pow(rho, m);
    force_ += to_goal_.normalized() *
              (m / 2 * p_.repulsion * gap * gap * std::pow(rho, m - 1) / (start_to_goal_ / unit_));
  }
  if (p_.turned_repulsion) {
    const Vec3 to_obstacle = -away;
    const double b1_less_b2 = bearing_change(to_target_, to_obstacle);
    if (std::abs(b1_less_b2) < radians(p_.small_angle_deg)) {
      constexpr double kHalfRoot = 0.70710678118654752440;
      away = turned_left(away, kHalfRoot, b1_less_b2 < 0 ? -kHalfRoot : kHalfRoot);
    }
  }
  force_ += away * size;
}
}  // namespace apf
