// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/over_ground.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"

namespace altiplan::kit {
namespace {

constexpr double kShortest = 0.1;  // metres

class OverGround {
 public:
  OverGround(const World& world, double above_m, double tolerance_m)
      : world_(world), above_m_(above_m), tolerance_m_(tolerance_m) {}

  Vec3 at(const Vec3& p) const {
    const std::optional<double> ground = world_.ground(p.x(), p.y());
    if (!ground) {
      throw Error("there is no ground below (" + std::to_string(p.x()) + ", " +
                  std::to_string(p.y()) + ")");
    }
    return {p.x(), p.y(), *ground + above_m_};
  }

  /// Adds the waypoints of a leg, but its first.
  void add(const Vec3& a, const Vec3& b, Polyline& to) const {
    const double length = (b - a).head<2>().norm();
    if (length < kShortest || keeps(a, b)) {
      to.push_back(b);
      return;
    }
    const Vec3 middle = at(farthest_off(a, b, length));
    add(a, middle, to);
    add(middle, b, to);
  }

 private:
  bool keeps(const Vec3& a, const Vec3& b) const {
    return world_.ground_gap(a, b) >= above_m_ - tolerance_m_ &&
           world_.ground_gap_max(a, b) <= above_m_ + tolerance_m_;
  }

  /// Of samples; the middle, where none of them is off.
  Vec3 farthest_off(const Vec3& a, const Vec3& b, double length) const {
    const int parts = std::clamp(int(length / std::max(1.0, above_m_ / 10)), 2, 4096);
    Vec3 worst = (a + b) / 2;
    double off = tolerance_m_;
    for (int k = 1; k < parts; ++k) {
      const Vec3 p = a + double(k) / parts * (b - a);
      if (const double there = std::abs(at(p).z() - p.z()); there > off) {
        off = there;
        worst = p;
      }
    }
    return worst;
  }

  const World& world_;
  double above_m_;
  double tolerance_m_;
};
}  // namespace

Polyline over_ground(const Polyline& line, const World& world, double above_m, double tolerance_m) {
  const OverGround over(world, above_m, tolerance_m);
  Polyline high;
  for (const Vec3& p : line) {
    if (high.empty()) {
      high.push_back(over.at(p));
    } else {
      over.add(high.back(), over.at(p), high);
    }
  }
  return high;
}
}  // namespace altiplan::kit
