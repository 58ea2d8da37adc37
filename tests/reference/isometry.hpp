// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reference/random_problem.hpp"

// The same problem seen from elsewhere: mirrored, turned by right angles, moved, scaled.
namespace altiplan::reference {

/// p ↦ scale · (p with x and y swapped and axes flipped) + shift.
struct Isometry {
  bool swap = false;
  Vec3 sign{1, 1, 1};
  double scale = 1;
  Vec3 shift{0, 0, 0};

  Vec3 direction(const Vec3& v) const {
    const Vec3 turned = swap ? Vec3(v.y(), v.x(), v.z()) : v;
    return scale * turned.cwiseProduct(sign);
  }
  Vec3 point(const Vec3& p) const { return direction(p) + shift; }
  Box box(const Box& b) const {
    Box out = Box::empty();
    for (int axis = 0; axis < 3; ++axis) {
      const int from = swap && axis < 2 ? 1 - axis : axis;
      const double u = scale * sign[axis] * b.min[from] + shift[axis];
      const double v = scale * sign[axis] * b.max[from] + shift[axis];
      out.min[axis] = std::min(u, v);
      out.max[axis] = std::max(u, v);
    }
    return out;
  }
  /// An interval of heights.
  std::array<double, 2> heights(double low, double high) const {
    const double u = scale * sign.z() * low + shift.z();
    const double v = scale * sign.z() * high + shift.z();
    return {std::min(u, v), std::max(u, v)};
  }
};

inline Shape mapped(const Shape& shape, const Isometry& by) {
  if (const auto* s = std::get_if<Sphere>(&shape)) {
    return Sphere{by.point(s->centre), by.scale * s->radius};
  }
  if (const auto* c = std::get_if<Cylinder>(&shape)) {
    const Vec3 axis = by.point({c->x, c->y, 0});
    const auto [floor, ceiling] = by.heights(c->floor, c->ceiling);
    return Cylinder{axis.x(), axis.y(), by.scale * c->radius, floor, ceiling};
  }
  if (const auto* b = std::get_if<BoxShape>(&shape)) {
    return BoxShape{by.box(b->box)};
  }
  Prism prism = std::get<Prism>(shape);
  const auto [floor, ceiling] = by.heights(prism.floor, prism.ceiling);
  prism.floor = floor;
  prism.ceiling = ceiling;
  const auto map_ring = [&](std::vector<std::array<double, 2>>& ring) {
    for (auto& corner : ring) {
      const Vec3 p = by.point({corner[0], corner[1], 0});
      corner = {p.x(), p.y()};
    }
  };
  map_ring(prism.outline);
  std::for_each(prism.holes.begin(), prism.holes.end(), map_ring);
  return prism;
}

/// Solids keep no triangles: what is mapped is for the framework, not for the oracle.
inline Scene mapped(const Scene& scene, const Isometry& by) {
  Scene out;
  for (const oracle::Solid& solid : scene.solids) {
    out.solids.push_back({mapped(solid.shape, by), {}});
  }
  if (scene.ground) {
    Plane plane = *scene.ground;
    const Vec3 slope = by.direction({plane.slope[0], plane.slope[1], 0}) / by.scale;
    plane.slope = {slope.x(), slope.y()};
    plane.height = by.scale * plane.height + by.shift.z() - slope.dot(by.shift);
    out.ground = plane;
  }
  return out;
}

inline Limits mapped(Limits limits, const Isometry& by) {
  limits.min_clearance *= by.scale;
  limits.min_leg *= by.scale;
  limits.max_leg *= by.scale;
  limits.min_turn_radius *= by.scale;
  limits.max_route_length *= by.scale;
  if (limits.min_ground_clearance) {
    *limits.min_ground_clearance *= by.scale;
  }
  for (AltitudeBand& band : limits.altitude) {
    if (band.datum == AltitudeBand::Datum::sea) {
      const auto [low, high] = by.heights(band.min, band.max);
      band.min = low;
      band.max = high;
    } else {
      band.min *= by.scale;
      band.max *= by.scale;
    }
  }
  return limits;
}

inline Polyline mapped(Polyline route, const Isometry& by) {
  for (Vec3& p : route) {
    p = by.point(p);
  }
  return route;
}

inline Problem mapped(const Problem& problem, const Isometry& by) {
  Problem out = problem;
  out.scene = mapped(problem.scene, by);
  out.lattice.cell = by.direction(problem.lattice.cell).cwiseAbs();
  Request& request = out.request;
  request.world = std::make_shared<const World>(world_of(out.scene));
  request.start.position = by.point(request.start.position);
  request.start.velocity = by.direction(request.start.velocity);
  request.goal.position = by.point(request.goal.position);
  request.goal.tolerance_m *= by.scale;
  request.vehicle.radius_m *= by.scale;
  request.volume = by.box(request.volume);
  request.limits = mapped(request.limits, by);
  if (request.level_m) {
    request.level_m = request.start.position.z();
    request.goal.position.z() = request.start.position.z();
  }
  return out;
}

struct NamedIsometry {
  const char* name;
  Isometry by;
};
/// All that leave a problem what it is; upside down only where there is no ground.
inline std::vector<NamedIsometry> isometries(bool ground) {
  std::vector<NamedIsometry> all = {
      {"mirrored in x", {false, {-1, 1, 1}, 1, {0, 0, 0}}},
      {"mirrored in y", {false, {1, -1, 1}, 1, {0, 0, 0}}},
      {"x and y swapped", {true, {1, 1, 1}, 1, {0, 0, 0}}},
      {"turned left", {true, {-1, 1, 1}, 1, {0, 0, 0}}},
      {"turned right", {true, {1, -1, 1}, 1, {0, 0, 0}}},
      {"turned round", {false, {-1, -1, 1}, 1, {0, 0, 0}}},
      {"moved by whole metres", {false, {1, 1, 1}, 1, {130, -450, 33}}},
      {"moved by any offset", {false, {1, 1, 1}, 1, {1234.5678, 98.7654321, -3.1415926}}},
      {"twice as large", {false, {1, 1, 1}, 2, {0, 0, 0}}},
      {"all at once", {true, {-1, 1, 1}, 3.7, {-77.7, 1010.101, 12.34}}},
  };
  if (!ground) {
    all.push_back({"upside down", {false, {1, 1, -1}, 1, {0, 0, 0}}});
  }
  return all;
}
}  // namespace altiplan::reference
