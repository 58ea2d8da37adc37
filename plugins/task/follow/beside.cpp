// SPDX-License-Identifier: Apache-2.0
#include "beside.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "altiplan/error.hpp"
#include "altiplan/geometry.hpp"

namespace altiplan::follow {
namespace {

constexpr double kNear = 1e-6;  // metres: less is rounding

double cross(const Vec3& a, const Vec3& b) { return a.x() * b.y() - a.y() * b.x(); }

Vec3 left_of(const Vec3& from, const Vec3& to) {
  const Vec3 way = (to - from).normalized();
  return {-way.y(), way.x(), 0};
}

Vec3 turned(const Vec3& v, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y(), 0};
}

/// Around a corner that turns by an angle away from the offset: corners of a polygon about the arc.
void go_around(const Vec3& corner, const Vec3& side, double turn, Polyline& to) {
  const double radius = side.norm();
  const double maximum = 2 * std::acos(radius / (radius + kBeyond));
  const int parts = std::max(1, int(std::ceil(std::abs(turn) / maximum)));
  const double step = turn / parts;
  for (int k = 0; k < parts; ++k) {
    to.push_back(corner + turned(side, (k + 0.5) * step) / std::cos(step / 2));
  }
}

/// Each leg moved aside, and joined to the next: it may come nearer to other legs of the line.
Polyline moved_aside(const Polyline& line, double offset) {
  constexpr double kSharp = 0.05;  // cosine of half the turn
  Polyline moved{line[0] + offset * left_of(line[0], line[1])};
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const Vec3 before = left_of(line[i - 1], line[i]);
    const Vec3 after = left_of(line[i], line[i + 1]);
    const double turn = std::atan2(cross(before, after), before.dot(after));
    const double cosine = std::cos(turn / 2);
    if (cosine < kNear) {  // back along itself: around its end
      go_around(line[i], offset * before, offset > 0 ? -kPi : kPi, moved);
    } else if (turn * offset < 0) {
      go_around(line[i], offset * before, turn, moved);
    } else if (cosine > kSharp) {
      moved.push_back(line[i] + offset / cosine * (before + after).normalized());
    } else {
      moved.push_back(line[i] + offset * before);
      moved.push_back(line[i] + offset * after);
    }
  }
  const std::size_t n = line.size();
  moved.push_back(line[n - 1] + offset * left_of(line[n - 2], line[n - 1]));
  return moved;
}

/// Where two legs cross, as shares of them; beyond 0 to 1 they do not.
struct Crossing {
  double of_first = -1;
  double of_second = -1;

  bool crosses() const {
    return of_first >= 0 && of_first <= 1 && of_second >= 0 && of_second <= 1;
  }
};
Crossing crossing(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double area = cross(b - a, d - c);
  return area == 0 ? Crossing{} : Crossing{cross(c - a, d - c) / area, cross(c - a, b - a) / area};
}

/// Of two legs, seen from above.
double leg_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return crossing(a, b, c, d).crosses()
             ? 0
             : std::min({point_leg_distance(a, c, d), point_leg_distance(b, c, d),
                         point_leg_distance(c, a, b), point_leg_distance(d, a, b)});
}

/// With a point wherever it crosses itself.
Polyline with_crossings(const Polyline& route) {
  Polyline points;
  for (std::size_t i = 1; i < route.size(); ++i) {
    const Vec3& a = route[i - 1];
    const Vec3 way = route[i] - a;
    std::vector<double> shares{0};
    for (std::size_t j = 1; j < route.size(); ++j) {
      const Crossing met = crossing(a, route[i], route[j - 1], route[j]);
      if (j != i && j != i - 1 && j != i + 1 && met.crosses()) {
        shares.push_back(met.of_first);
      }
    }
    std::sort(shares.begin(), shares.end());
    for (const double share : shares) {
      if (points.empty() || (a + share * way - points.back()).norm() > kNear) {
        points.push_back(a + share * way);
      }
    }
  }
  points.push_back(route.back());
  return points;
}
}  // namespace

Polyline beside(const Polyline& line, double offset) {
  if (offset == 0) {
    return line;
  }
  const Polyline points = with_crossings(moved_aside(line, offset));
  const auto keeps = [&](const Vec3& a, const Vec3& b) {
    for (std::size_t i = 1; i < line.size(); ++i) {
      if (leg_distance(a, b, line[i - 1], line[i]) < std::abs(offset) - kNear) {
        return false;
      }
    }
    return true;
  };
  const auto refuse = [&](const Vec3& from, const Vec3& to) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "%g m beside the line there is no way on from (%.1f, %.1f) to (%.1f, %.1f): "
                  "the line comes near itself",
                  offset, from.x(), from.y(), to.x(), to.y());
    throw Error(text);
  };
  Polyline route;
  double left_out = 0;  // since the last leg that is kept
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!keeps(points[i - 1], points[i])) {
      left_out += (points[i] - points[i - 1]).norm();
      continue;
    }
    if (route.empty() && left_out > 2 * std::abs(offset)) {
      refuse(points.front(), points[i - 1]);
    }
    left_out = 0;
    if (!route.empty() && (points[i - 1] - route.back()).norm() > 2 * kNear) {
      refuse(route.back(), points[i - 1]);
    }
    if (route.empty()) {
      route.push_back(points[i - 1]);
    } else if (route.size() > 1 &&
               point_leg_distance(route.back(), route[route.size() - 2], points[i]) < kNear) {
      route.pop_back();  // straight on
    }
    route.push_back(points[i]);
  }
  if (route.empty()) {
    char text[80];
    std::snprintf(text, sizeof text, "%g m beside the line each place is nearer to it", offset);
    throw Error(text);
  }
  if (left_out > 2 * std::abs(offset)) {
    refuse(route.back(), points.back());
  }
  return route;
}
}  // namespace altiplan::follow
