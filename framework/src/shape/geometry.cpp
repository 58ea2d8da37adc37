// SPDX-License-Identifier: Apache-2.0
#include "altiplan/geometry.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace altiplan {

double turn_angle_horizontal(const Vec3& before, const Vec3& after) {
  if (!has_heading(before) || !has_heading(after)) {
    return 0;
  }
  const double cross = before.x() * after.y() - before.y() * after.x();
  const double dot = before.x() * after.x() + before.y() * after.y();
  return std::atan2(std::abs(cross), dot);
}

double turn_angle_in_space(const Vec3& before, const Vec3& after) {
  if (before.isZero(0) || after.isZero(0)) {
    return 0;  // atan2(0, -0.0) would be pi
  }
  return std::atan2(before.cross(after).norm(), before.dot(after));
}

double climb_angle(const Vec3& direction) {
  return std::atan2(std::abs(direction.z()), std::hypot(direction.x(), direction.y()));
}

double radius_through(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a;
  const Vec3 v = c - b;
  const double twice_area = u.cross(v).norm();
  if (twice_area == 0) {
    return u.dot(v) < 0 ? 0 : kInfinity;  // a reversal has no circle
  }
  return u.norm() * v.norm() * (c - a).norm() / (2 * twice_area);
}

double fillet_radius(const Vec3& before, const Vec3& after) {
  const double in = before.norm();
  const double out = after.norm();
  const double sine = before.cross(after).norm();
  const double cosine = before.dot(after);
  if (sine == 0) {
    return cosine < 0 ? 0 : kInfinity;
  }
  return std::min(in, out) / 2 * (in * out + cosine) / sine;  // 1 / tan(turn / 2)
}

double point_leg_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double square = along.squaredNorm();
  const double t = square > 0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0.0;
  return (a + t * along - p).norm();
}
}  // namespace altiplan
