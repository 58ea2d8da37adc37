// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/sampling/sampling.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace altiplan::kit {
namespace {

constexpr int kTries = 64;            ///< samples before falling back to the box
constexpr double kWithin = 1 - 1e-9;  ///< keeps a bent leg off its limit

double horizontal(const Vec3& v) { return std::hypot(v.x(), v.y()); }

/// Rotated about the vertical until its angle with `incoming` is at most `maximum`.
Vec3 turned_level(const Vec3& incoming, const Vec3& way, double maximum) {
  const double run = horizontal(way);
  if (turn_angle_horizontal(incoming, way) <= maximum) {
    return way;
  }
  const double before = std::atan2(incoming.y(), incoming.x());
  const double turn = std::remainder(std::atan2(way.y(), way.x()) - before, 2 * kPi);
  const double heading = before + std::copysign(maximum * kWithin, turn);
  return {run * std::cos(heading), run * std::sin(heading), way.z()};
}

/// Rotated in the plane of both until its angle with `incoming` is at most `maximum`.
Vec3 turned_in_space(const Vec3& incoming, const Vec3& way, double maximum) {
  if (turn_angle_in_space(incoming, way) <= maximum) {
    return way;
  }
  const Vec3 ahead = incoming.normalized();
  const Vec3 across = way - way.dot(ahead) * ahead;
  if (across.squaredNorm() == 0) {
    return way;
  }
  const double angle = maximum * kWithin;
  return way.norm() * (std::cos(angle) * ahead + std::sin(angle) * across.normalized());
}

Vec3 levelled(const Vec3& way, double maximum) {
  const double rise = horizontal(way) * std::tan(maximum) * kWithin;
  return {way.x(), way.y(), std::clamp(way.z(), -rise, rise)};
}
}  // namespace

Vec3 bent(const std::optional<Approach>& before, const Vec3& at, const Vec3& wanted, double range,
          const Limits& limits) {
  Vec3 way = wanted;
  if (before) {
    const Vec3 incoming = at - before->from;
    way = turned_level(before->heading_at(at), way, limits.max_turn_horizontal);
    double maximum = limits.max_turn_space;
    if (limits.min_turn_radius > 0) {
      const double leg = std::min({wanted.norm(), range, incoming.norm()});
      maximum = std::min(maximum, 2 * std::atan(leg / (2 * limits.min_turn_radius)));
    }
    if (maximum < kPi && !incoming.isZero(0)) {
      way = turned_in_space(incoming, way, maximum);
    }
  }
  return limits.max_slope() < kPi / 2 ? levelled(way, limits.max_slope()) : way;
}

InformedSet::InformedSet(const Vec3& start, const Vec3& goal, const Box& box)
    : start_(start),
      goal_(goal),
      box_(box),
      box_measure_(measure_of(box)),
      flat_(box.max.z() <= box.min.z()),
      middle_((start + goal) / 2) {
  set_length(kInfinity);
}

void InformedSet::set_length(double length) {
  length_ = length;
  if (length == kInfinity) {
    return;
  }
  const Vec3 apart = goal_ - start_;
  const double distance = apart.norm();
  const double across = std::sqrt(std::max(0.0, length * length - distance * distance)) / 2;
  const Vec3 ahead = distance > 0 ? Vec3(apart / distance) : Vec3(1, 0, 0);
  // Any two directions at right angles to it and to each other; the second points up on a level.
  const Vec3 aside = std::abs(ahead.z()) < 0.9 ? Vec3(-ahead.y(), ahead.x(), 0).normalized()
                                               : Vec3(1, 0, 0).cross(ahead).normalized();
  long_ = ahead * (length / 2);
  across_ = aside * across;
  beside_ = ahead.cross(aside) * (flat_ ? 0.0 : across);
  own_measure_ = flat_ ? kPi * length / 2 * across : 4 * kPi / 3 * length / 2 * across * across;
}

Vec3 InformedSet::draw(RandomStream& random) const {
  const bool from_box = own_measure_ >= box_measure_;
  for (int n = 0; n < kTries && length_ < kInfinity; ++n) {
    if (from_box) {
      const Vec3 p = random.in(box_);
      if (contains(p)) {
        return p;
      }
      continue;
    }
    // A point of the unit ball (or disc), by rejection sampling in its bounding cube.
    const double x = random.uniform(-1, 1);
    const double y = random.uniform(-1, 1);
    const double z = flat_ ? 0.0 : random.uniform(-1, 1);
    if (x * x + y * y + z * z > 1) {
      continue;
    }
    Vec3 p = middle_ + x * long_ + y * across_ + z * beside_;
    if (flat_) {
      p.z() = box_.min.z();
    }
    if (box_.contains(p)) {
      return p;
    }
  }
  return random.in(box_);
}
}  // namespace altiplan::kit
