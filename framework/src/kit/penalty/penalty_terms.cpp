// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/penalty/penalty_terms.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace altiplan::kit {

double plane_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double dx = b.x() - a.x();
  const double dy = b.y() - a.y();
  const double square = dx * dx + dy * dy;
  const double t =
      square == 0 ? 0
                  : std::clamp(((p.x() - a.x()) * dx + (p.y() - a.y()) * dy) / square, 0.0, 1.0);
  return std::hypot(p.x() - (a.x() + t * dx), p.y() - (a.y() + t * dy));
}

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double DiscFees::sum(std::span<const Vec3> points) const {
  double all = 0;
  for (const Threat& disc : discs) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      all += fee(disc, plane_distance(disc.centre, points[i], points[i + 1]));
    }
  }
  return all;
}

bool DiscFees::collides(std::span<const Vec3> points) const { return std::isinf(sum(points)); }

std::optional<PenaltyNodes> penalty_nodes(const Route& route, const Request& request) {
  if (!route.is_straight()) {
    return std::nullopt;
  }
  PenaltyNodes nodes;
  nodes.points.reserve(route.size());
  nodes.above_ground.reserve(route.size());
  const World& world = *request.world;
  for (const Vec3& p : route.waypoints()) {
    double z = p.z();
    float post = 0;
    if (world.has_ground()) {
      const std::optional<double> below = world.ground(p.x(), p.y());
      const std::optional<double> nearest = world.ground(std::round(p.x()), std::round(p.y()));
      if (!below || !nearest) {
        return std::nullopt;
      }
      z -= *below;
      post = float(*nearest);
    }
    nodes.points.emplace_back(p.x(), p.y(), double(float(z) + post));
    nodes.above_ground.push_back(z);
  }
  return nodes;
}
}  // namespace altiplan::kit
