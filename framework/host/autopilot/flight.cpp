// SPDX-License-Identifier: Apache-2.0
#include "host/autopilot/flight.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan::host {
namespace {

constexpr double kSpacing = 8;  // metres between circles of a disc
}  // namespace

FlownPart& Flight::begin(std::size_t command, std::string what) {
  FlownPart part;
  part.command = command;
  part.before = before;
  part.what = std::move(what);
  part.begin_s = mission_.time.min_s;
  mission_.parts.push_back(std::move(part));
  return mission_.parts.back();
}

void Flight::take(const TimeSpan& time) {
  mission_.time += time;
  if (!mission_.parts.empty()) {
    mission_.parts.back().time = mission_.time;
  }
}

void Flight::remark(Remark::Weight weight, const char* rule, std::size_t command,
                    std::string message, double value, double limit) {
  for (const Remark& other : mission_.remarks) {
    if (other.command == command && other.rule == rule) {
      return;  // of a leg that is flown again
    }
  }
  mission_.remarks.push_back({weight, rule, command, std::move(message), value, limit});
}

double Flight::ground(const Eigen::Vector2d& at) const {
  return world_.ground(at.x(), at.y()).value_or(home_ground);
}

void Flight::add_strip(const Vec3& from, double from_high, const Vec3& to, double to_high,
                       double reach) {
  if (repeats < 2) {
    mission_.parts.back().strips.push_back({from, to, from_high, to_high, reach});
  }
}

void Flight::add_leg(const Vec3& from, double from_high, const Vec3& to, double to_high,
                     double reach) {
  constexpr double kEarth = 6'371'000;
  const Vec3 along(to.x() - from.x(), to.y() - from.y(), 0);
  double apart = 0;
  if (world_.frame().has_position() && along.norm() > 0) {
    const double lat = world_.frame().to_lonlat(from.x(), from.y())[1];
    apart = along.squaredNorm() * std::abs(std::tan(radians(lat))) / (8 * kEarth);
  }
  const int lines = apart > kSpacing / 2 ? int(std::ceil(2 * apart / kSpacing)) : 0;
  for (int line = 0; line <= lines && lines > 0; ++line) {
    const double off = apart * (2.0 * line / lines - 1);
    const Vec3 aside = Vec3(-along.y(), along.x(), 0).normalized() * off;
    add_strip(from + aside, from_high, to + aside, to_high, std::max(reach, kSpacing / 2));
  }
  add_strip(from, from_high, to, to_high, lines > 0 ? reach : reach + apart);
}

void Flight::add_column(const Eigen::Vector2d& at, double low, double high, double reach) {
  const Vec3 foot(at.x(), at.y(), low);
  add_strip(foot, high, foot, high, reach);
}

void Flight::add_disc(const Destination& centre, double inner, double outer, double low,
                      double high) {
  const int rings = std::max(1, int(std::ceil((outer - inner) / kSpacing)));
  for (int ring = 0; ring <= rings; ++ring) {
    const double radius = inner + (outer - inner) * ring / rings;
    const int sides = std::clamp(int(std::ceil(radius / 2)), 6, 48);
    for (int side = 0; side < sides; ++side) {
      const auto corner = [&](int n) {
        // The chords' corners lie outside, so that the chords reach the circle.
        const double r = radius / std::cos(kPi / sides);
        const double angle = 2 * kPi * n / sides;
        const Eigen::Vector2d p = centre.at + r * Eigen::Vector2d(std::cos(angle), std::sin(angle));
        return Vec3(p.x(), p.y(), centre.above_ground ? ground(p) + *centre.above_ground : low);
      };
      const Vec3 from = corner(side);
      const Vec3 to = corner(side + 1);
      const double rise = centre.above_ground ? 0 : high - low;
      add_strip(from, from.z() + rise, to, to.z() + rise, kSpacing / 2);
    }
  }
}
}  // namespace altiplan::host
