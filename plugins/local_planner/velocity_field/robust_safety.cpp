// SPDX-License-Identifier: Apache-2.0
#include "robust_safety.hpp"

namespace velocity_field {
namespace {
/// Distance kept from the edge of a threat, so that rounding never decides.
constexpr double kRounding = 1e-6;
/// The same for a circle, which may be flown many times.
constexpr double kDrift = 1e-3;
}  // namespace

Steps::Steps(double length_m, double min_radius_m, double max_turn)
    : length_m_(length_m),
      radius_m_(std::max(min_radius_m, length_m / (2 * std::sin(std::min(max_turn, kPi / 2) / 2)))),
      limit_(velocity_field::max_turn(length_m, radius_m_)),
      half_(limit_.maximum() / 2) {}

Pose Steps::turned(const Pose& pose, int side) const {
  return after(pose.at, limit_.held(pose.course, side * left_of(pose.course)));
}

Vec2 Steps::circle_centre(const Pose& pose, int side) const {
  const Vec2 tangent = half_.held(pose.course, side * left_of(pose.course));
  return pose.at + side * radius_m_ * left_of(tangent);
}

bool Freedom::is_leg_free(const Vec2& a, const Vec2& b) const {
  for (const std::uint32_t n : threats_->near(a)) {
    const Disc& disc = threats_->all()[n];
    const double room = disc.radius + kRounding;
    if (square_to_leg(disc.centre, a, b) < room * room) {
      return false;
    }
  }
  return true;
}

bool Freedom::is_circle_free(const Pose& pose, int side) const {
  const Vec2 centre = steps_.circle_centre(pose, side);
  for (const std::uint32_t n : threats_->near(pose.at)) {
    const Disc& disc = threats_->all()[n];
    const double room = disc.radius + steps_.radius_m() + kDrift;
    if ((disc.centre - centre).squaredNorm() < room * room) {
      return false;
    }
  }
  return true;
}

int Freedom::free_circle(const Pose& pose, const Vec2& target) const {
  const int side = cross(pose.course, target - pose.at) >= 0 ? 1 : -1;
  if (is_circle_free(pose, side)) {
    return side;
  }
  return is_circle_free(pose, -side) ? -side : 0;
}

bool WayOut::is_free(const Freedom& freedom, const Pose& from) const {
  Pose pose = from;
  for (auto course = courses.rbegin(); course != courses.rend(); ++course) {
    const Pose next = freedom.steps().after(pose.at, *course);
    if (!freedom.is_leg_free(pose.at, next.at)) {
      return false;
    }
    pose = next;
  }
  return circle == 0 || freedom.is_circle_free(pose, circle);
}

Vec2 WayOut::end(const Steps& steps, const Vec2& from) const {
  Vec2 at = from;
  for (auto course = courses.rbegin(); course != courses.rend(); ++course) {
    at = steps.after(at, *course).at;
  }
  return at;
}
}  // namespace velocity_field
