// SPDX-License-Identifier: Apache-2.0
#include "triangles.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "altiplan/kit/layers/solid.hpp"

namespace altiplan::mesh {
namespace {

/// A triangle whose height is less than this fraction of its length is treated as its edges.
constexpr double kThin = 1e-10;

Vec3 normal_of(const Triangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]); }

bool is_thin(const Triangle& t, const Vec3& normal) {
  const double longest = std::max(
      {(t[1] - t[0]).squaredNorm(), (t[2] - t[1]).squaredNorm(), (t[0] - t[2]).squaredNorm()});
  return !(normal.norm() > kThin * longest);
}

/// True if q, a point of the triangle's plane, lies within its edges.
bool is_within(const Triangle& t, const Vec3& normal, const Vec3& q) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& from = t[i];
    if (normal.dot((t[(i + 1) % 3] - from).cross(q - from)) < 0) {
      return false;
    }
  }
  return true;
}

Vec3 nearest_on_segment(const Vec3& from, const Vec3& to, const Vec3& p) {
  const Vec3 way = to - from;
  const double length = way.squaredNorm();
  const double along = length > 0 ? std::clamp((p - from).dot(way) / length, 0.0, 1.0) : 0;
  return from + along * way;
}

struct Approach {
  double along;  ///< position on the leg
  double distance;
};

/// Nearest approach of the leg a–b to the segment c–d.
Approach approach(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 leg = b - a;
  const Vec3 edge = d - c;
  const double leg_leg = leg.squaredNorm();
  const double leg_edge = leg.dot(edge);
  const double edge_edge = edge.squaredNorm();
  const double denominator = leg_leg * edge_edge - leg_edge * leg_edge;
  Approach best{0, kInfinity};
  const auto consider = [&](double along, const Vec3& on_edge) {
    const double distance = (a + along * leg - on_edge).norm();
    if (distance < best.distance) {
      best = {along, distance};
    }
  };
  if (denominator > 0) {
    const double along = (leg_edge * edge.dot(a - c) - edge_edge * leg.dot(a - c)) / denominator;
    if (along >= 0 && along <= 1) {
      consider(along, nearest_on_segment(c, d, a + along * leg));
    }
  }
  // Parallel segments, and those that are nearest at an end.
  consider(0, nearest_on_segment(c, d, a));
  consider(1, nearest_on_segment(c, d, b));
  for (const Vec3& end : {c, d}) {
    const double along = leg_leg > 0 ? std::clamp((end - a).dot(leg) / leg_leg, 0.0, 1.0) : 0;
    consider(along, end);
  }
  return best;
}

/// Position where the leg crosses the triangle's inside, or a value below 0.
double crossing(const Triangle& t, const Vec3& normal, const Vec3& a, const Vec3& b) {
  const double above = normal.dot(a - t[0]);
  const double below = normal.dot(b - t[0]);
  if (above == below || (above > 0) == (below > 0)) {
    return -1;
  }
  const double along = above / (above - below);
  return is_within(t, normal, a + along * (b - a)) ? along : -1;
}
}  // namespace

Vec3 nearest_point(const Triangle& triangle, const Vec3& p) {
  const Vec3 normal = normal_of(triangle);
  if (!is_thin(triangle, normal)) {
    const Vec3 foot = p - normal * (normal.dot(p - triangle[0]) / normal.squaredNorm());
    if (is_within(triangle, normal, foot)) {
      return foot;
    }
  }
  Vec3 best = triangle[0];
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 on = nearest_on_segment(triangle[i], triangle[(i + 1) % 3], p);
    if ((on - p).squaredNorm() < (best - p).squaredNorm()) {
      best = on;
    }
  }
  return best;
}

double leg_distance(const Triangle& triangle, const Vec3& a, const Vec3& b) {
  const Vec3 normal = normal_of(triangle);
  if (!is_thin(triangle, normal) && crossing(triangle, normal, a, b) >= 0) {
    return 0;
  }
  double minimum =
      std::min((nearest_point(triangle, a) - a).norm(), (nearest_point(triangle, b) - b).norm());
  for (std::size_t i = 0; i < 3; ++i) {
    minimum = std::min(minimum, approach(a, b, triangle[i], triangle[(i + 1) % 3]).distance);
  }
  return minimum;
}

double box_distance(const Triangle& triangle, const Box& box) {
  double minimum = kInfinity;
  for (std::size_t i = 0; i < 3; ++i) {
    minimum = std::min(minimum, kit::outside(box, triangle[i]));
    if (kit::may_reach(box, triangle[i], triangle[(i + 1) % 3], 0)) {
      return 0;
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 4; ++side) {
      Vec3 from = box.min;
      from[(axis + 1) % 3] = (side & 1) != 0 ? box.max[(axis + 1) % 3] : from[(axis + 1) % 3];
      from[(axis + 2) % 3] = (side & 2) != 0 ? box.max[(axis + 2) % 3] : from[(axis + 2) % 3];
      Vec3 to = from;
      to[axis] = box.max[axis];
      minimum = std::min(minimum, leg_distance(triangle, from, to));
    }
  }
  return minimum;
}

void add_meetings(const Triangle& triangle, const Vec3& a, const Vec3& b, double distance,
                  std::vector<double>& places) {
  const Vec3 normal = normal_of(triangle);
  if (const double along = is_thin(triangle, normal) ? -1 : crossing(triangle, normal, a, b);
      along >= 0) {
    places.push_back(along);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Approach edge = approach(a, b, triangle[i], triangle[(i + 1) % 3]);
    if (edge.distance <= distance) {
      places.push_back(edge.along);
    }
  }
}
}  // namespace altiplan::mesh
