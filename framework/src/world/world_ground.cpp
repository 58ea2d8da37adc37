// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "altiplan/world.hpp"
#include "layer_answer.hpp"

namespace altiplan {
std::optional<double> World::ground(double x, double y) const {
  std::optional<double> highest;
  for (const auto& ground : grounds_) {
    if (const auto height =
            answer_of(layers_, ground, [&](const Ground& asked) { return asked.height(x, y); })) {
      highest = highest ? std::max(*highest, *height) : *height;
    }
  }
  return highest;
}

namespace {
/// Part of the leg over the horizontal extent of a box; t0 > t1 where there is none.
std::pair<double, double> part_over(const Box& box, const Vec3& a, const Vec3& b) {
  double t0 = 0;
  double t1 = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const double d = b[axis] - a[axis];
    if (d == 0) {
      if (a[axis] < box.min[axis] || a[axis] > box.max[axis]) {
        return {1, 0};
      }
      continue;
    }
    const double enter = (box.min[axis] - a[axis]) / d;
    const double leave = (box.max[axis] - a[axis]) / d;
    t0 = std::max(t0, std::min(enter, leave));
    t1 = std::min(t1, std::max(enter, leave));
  }
  return {t0, t1};
}

/// The point at t of the leg; clamped, as rounding could move it out of the box, where there is no
/// ground.
Vec3 on_leg(const Vec3& a, const Vec3& b, double t, const Box& box) {
  const Vec3 p = t <= 0 ? a : t >= 1 ? b : Vec3(a + t * (b - a));
  return {std::clamp(p.x(), box.min.x(), box.max.x()), std::clamp(p.y(), box.min.y(), box.max.y()),
          p.z()};
}
}  // namespace

double World::ground_gap(const Vec3& a, const Vec3& b, double enough) const {
  if (grounds_.empty()) {
    return kInfinity;
  }
  if (grounds_.size() == 1) {
    return answer_of(layers_, grounds_.front(),
                     [&](const Ground& asked) { return asked.gap(a, b, enough); });
  }
  // Neighbouring tiles: each answers for its part of the leg, and together they must cover it.
  double min_gap = kInfinity;
  std::vector<std::pair<double, double>> parts;
  for (const auto& ground : grounds_) {
    const Box box = layers_[ground.first].environment->bounds();
    const auto [t0, t1] = part_over(box, a, b);
    if (t0 > t1) {
      continue;
    }
    const Vec3 enter = on_leg(a, b, t0, box);
    const Vec3 leave = on_leg(a, b, t1, box);
    min_gap = std::min(min_gap, answer_of(layers_, ground, [&](const Ground& asked) {
                         return asked.gap(enter, leave, enough);
                       }));
    parts.emplace_back(t0, t1);
  }
  std::sort(parts.begin(), parts.end());
  double covered = 0;
  for (const auto& [t0, t1] : parts) {
    if (t0 > covered + 1e-12) {
      return -kInfinity;
    }
    covered = std::max(covered, t1);
  }
  return !parts.empty() && covered >= 1 ? min_gap : -kInfinity;
}

bool World::ground_below(const Vec3& a, const Vec3& b) const {
  // Any finite height is sufficient.
  return ground_gap(a, b, std::numeric_limits<double>::lowest()) > -kInfinity;
}

double World::ground_slope(const Box& box) const {
  double steepest = 0;
  bool is_covered = false;
  for (const auto& ground : grounds_) {
    const Box all = layers_[ground.first].environment->bounds();
    const Box part = all.intersected(box);
    if (part.min.x() > part.max.x() || part.min.y() > part.max.y()) {
      continue;
    }
    // Where one ground ends, another may go on at another height.
    if (part.min.head<2>() != box.min.head<2>() || part.max.head<2>() != box.max.head<2>()) {
      return kInfinity;
    }
    is_covered = true;
    steepest = std::max(steepest, answer_of(layers_, ground,
                                            [&](const Ground& asked) { return asked.slope(box); }));
  }
  return is_covered ? steepest : kInfinity;
}

double World::ground_gap_max(const Vec3& a, const Vec3& b) const {
  double max_gap = -kInfinity;
  bool covered = false;
  for (const auto& ground : grounds_) {
    const Box box = layers_[ground.first].environment->bounds();
    const auto [t0, t1] = part_over(box, a, b);
    if (t0 <= t1) {
      const Vec3 enter = on_leg(a, b, t0, box);
      const Vec3 leave = on_leg(a, b, t1, box);
      covered = true;
      max_gap = std::max(max_gap, answer_of(layers_, ground, [&](const Ground& asked) {
                           return asked.gap_max(enter, leave);
                         }));
    }
  }
  return covered ? max_gap : kInfinity;
}
}  // namespace altiplan
