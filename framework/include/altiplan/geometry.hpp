// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "altiplan/api.hpp"

namespace altiplan {

/// A point or vector: x east, y north, z up, metres; z of a point is metres above sea level.
using Vec3 = Eigen::Vector3d;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kPi = std::numbers::pi;

/// The two tolerances of every exact check: metres, and radians.
inline constexpr double kLengthTolerance = 1e-6;
inline constexpr double kAngleTolerance = 1e-8;

constexpr double radians(double degrees) { return degrees * (kPi / 180); }
constexpr double degrees(double radians) { return radians * (180 / kPi); }

inline bool is_finite(const Vec3& p) {
  return std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z());
}

/// Axis-aligned closed box; a default box is all of space, an empty one has min > max.
struct Box {
  Vec3 min{-kInfinity, -kInfinity, -kInfinity};
  Vec3 max{kInfinity, kInfinity, kInfinity};

  static Box empty() {
    return {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  }
  bool is_empty() const { return (min.array() > max.array()).any(); }
  bool is_bounded() const { return is_finite(min) && is_finite(max); }
  /// True if p lies inside or at most `tolerance` metres outside on each axis.
  bool contains(const Vec3& p, double tolerance = 0) const {
    return (p.array() >= min.array() - tolerance).all() &&
           (p.array() <= max.array() + tolerance).all();
  }
  bool overlaps(const Box& other) const {
    return (min.array() <= other.max.array()).all() && (max.array() >= other.min.array()).all();
  }
  Box grown(double by) const { return {min.array() - by, max.array() + by}; }
  Box with(const Vec3& p) const { return {min.cwiseMin(p), max.cwiseMax(p)}; }
  Box united(const Box& other) const { return {min.cwiseMin(other.min), max.cwiseMax(other.max)}; }
  Box intersected(const Box& other) const {
    return {min.cwiseMax(other.min), max.cwiseMin(other.max)};
  }
};

/// Bounding box of the leg a–b.
inline Box leg_box(const Vec3& a, const Vec3& b) { return {a.cwiseMin(b), a.cwiseMax(b)}; }

/// True if a leg with this displacement has a heading: its horizontal length is at least
/// kLengthTolerance.
inline bool has_heading(const Vec3& leg) {
  return leg.head<2>().squaredNorm() >= kLengthTolerance * kLengthTolerance;
}

/// Angle between the headings of two legs, in [0, pi]; 0 where one of them has none.
ALTIPLAN_API double turn_angle_horizontal(const Vec3& before, const Vec3& after);

/// Angle between two directions in 3-D, in [0, pi]; 0 where one has no length.
ALTIPLAN_API double turn_angle_in_space(const Vec3& before, const Vec3& after);

/// Climb angle of a direction, atan2(|dz|, horizontal length), in [0, pi/2].
ALTIPLAN_API double climb_angle(const Vec3& direction);

/// Radius of the circle through three points; infinite where they are collinear.
ALTIPLAN_API double radius_through(const Vec3& a, const Vec3& b, const Vec3& c);

/// Radius of the largest circular fillet between two legs that uses at most half of each; infinite
/// where they continue straight or one has no length, 0 where they reverse.
ALTIPLAN_API double fillet_radius(const Vec3& before, const Vec3& after);

/// Minimum distance between the point p and the leg a–b.
ALTIPLAN_API double point_leg_distance(const Vec3& p, const Vec3& a, const Vec3& b);
}  // namespace altiplan
