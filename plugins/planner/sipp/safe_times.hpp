// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan::sipp {

/// A sphere in uniform motion, with the vehicle's own radius added.
struct Mover {
  Vec3 at_0{0, 0, 0};  ///< centre at time 0
  Vec3 velocity{0, 0, 0};
  double radius = 0;
};

/// Times between two ends, in seconds; empty if begin >= end.
struct Times {
  double begin = kInfinity;
  double end = -kInfinity;
  bool empty() const { return begin >= end; }
};

inline Times both(const Times& a, const Times& b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}
/// The interval about two, of which each may be empty.
inline Times hull(const Times& a, const Times& b) {
  return a.empty() ? b : b.empty() ? a : Times{std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

/// The times t at which |x + t v| < radius: an open interval.
inline Times within(const Vec3& x, const Vec3& v, double radius) {
  const double a = v.squaredNorm();
  const double c = x.squaredNorm() - radius * radius;
  if (a == 0) {
    return c < 0 ? Times{-kInfinity, kInfinity} : Times{};
  }
  const double b = x.dot(v);
  const double d = b * b - a * c;
  if (d <= 0) {
    return {};
  }
  const double root = std::sqrt(d);
  return {(-b - root) / a, (-b + root) / a};
}

/// The times t at which begin < x + t v < end, of numbers.
inline Times between(double x, double v, double begin, double end) {
  if (v == 0) {
    return x > begin && x < end ? Times{-kInfinity, kInfinity} : Times{};
  }
  const double t0 = (begin - x) / v;
  const double t1 = (end - x) / v;
  return {std::min(t0, t1), std::max(t0, t1)};
}

/// The times at which a vehicle at p is within the mover.
inline Times unsafe_at(const Vec3& p, const Mover& mover, double grown = 0) {
  return within(p - mover.at_0, -mover.velocity, mover.radius + grown);
}

/// The times of departure at which a vehicle that flies from p to q in `duration` seconds comes
/// within the mover. Relative to the mover, each departure flies the same segment from another
/// point of a line: the mover is met while that point lies in the capsule about the segment
/// reversed. A capsule is convex, so that is one interval: of its two balls and of its cylinder.
inline Times unsafe_departures(const Vec3& p, const Vec3& q, double duration, const Mover& mover) {
  const Vec3 x = p - mover.at_0;
  const Vec3 v = -mover.velocity;
  const Vec3 segment = -(q - p + duration * v);
  Times times = hull(within(x, v, mover.radius), within(x - segment, v, mover.radius));
  const double length = segment.norm();
  if (length > 0) {
    const Vec3 n = segment / length;
    times = hull(times, both(within(x - x.dot(n) * n, v - v.dot(n) * n, mover.radius),
                             between(x.dot(n), v.dot(n), 0, length)));
  }
  return times;
}

/// The closed intervals from `from_s` on that lie in none of the unsafe ones, ascending.
inline void safe_times(std::vector<Times>& unsafe, double from_s, std::vector<Times>& safe) {
  safe.clear();
  std::sort(unsafe.begin(), unsafe.end(),
            [](const Times& a, const Times& b) { return a.begin < b.begin; });
  double free_from = from_s;
  for (const Times& times : unsafe) {
    if (times.begin >= free_from) {
      safe.push_back({free_from, times.begin});
    }
    free_from = std::max(free_from, times.end);
  }
  if (free_from < kInfinity) {
    safe.push_back({free_from, kInfinity});
  }
}
}  // namespace altiplan::sipp
