// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "altiplan/objective.hpp"
#include "altiplan/request.hpp"

/// \file Parts of the penalty costs by which swarms plan routes in the literature: they look at the
/// waypoints of a route, at its distance from discs in the plane, and at its corners.
namespace altiplan::kit {

/// Discs, infinitely high, to be kept away from: the threats of a scenario's layers, for a vehicle
/// with a size.
struct ALTIPLAN_API DiscFees {
  std::vector<Threat> discs;
  double size = 1;     ///< radius of the vehicle
  double danger = 10;  ///< width of the ring in which a fee is due

  double collision(const Threat& disc) const { return disc.radius + size; }
  double free(const Threat& disc) const { return disc.radius + size + danger; }
  /// What a leg owes a disc at a distance: how far it reaches into the ring; infinite beyond it.
  double fee(const Threat& disc, double distance) const {
    return distance > free(disc)        ? 0
           : distance < collision(disc) ? kInfinity
                                        : free(disc) - distance;
  }
  /// Sum over all discs and legs of the points, each of which pays separately.
  double sum(std::span<const Vec3> points) const;
  /// True if any of the points' legs collides with a disc.
  bool collides(std::span<const Vec3> points) const;
};

/// The waypoints of a route as these costs see them. A height above the sea is that of the nearest
/// post of the ground (coordinates rounded to whole numbers, half away from zero) plus the height
/// above ground, both and their sum in single precision: published programs keep their terrain as
/// such numbers, and without this costs are off by up to 5e-7 of them.
struct PenaltyNodes {
  std::vector<Vec3> points;          ///< z above the sea
  std::vector<double> above_ground;  ///< one for each point
};

/// None if a part of the route has no ground below it, or a leg is not straight: such a route has
/// no price. In a world without ground heights are above 0.
ALTIPLAN_API std::optional<PenaltyNodes> penalty_nodes(const Route& route, const Request& request);

/// Distance in the plane of a point and a leg.
ALTIPLAN_API double plane_distance(const Vec3& p, const Vec3& a, const Vec3& b);

/// Angle between two vectors, in [0, pi]; 0 if one has no length.
ALTIPLAN_API double angle_between(const Vec3& a, const Vec3& b);

/// Calls corner(i, into, out) for each inner point: the vectors of the legs into and out of point
/// i + 1, or of the nearest earlier and later ones that are not zero; zero where there is none.
template <class Corner>
void for_each_corner(std::span<const Vec3> points, const Corner& corner) {
  const auto leg = [&](std::size_t i) { return Vec3(points[i + 1] - points[i]); };
  for (std::size_t i = 0; i + 2 < points.size(); ++i) {
    std::size_t before = i;
    while (before > 0 && leg(before).isZero(0)) {
      --before;
    }
    std::size_t after = i + 1;
    while (after + 2 < points.size() && leg(after).isZero(0)) {
      ++after;
    }
    corner(i, leg(before), leg(after));
  }
}
}  // namespace altiplan::kit
