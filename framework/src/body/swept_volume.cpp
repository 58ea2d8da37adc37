// SPDX-License-Identifier: Apache-2.0
#include "altiplan/swept_volume.hpp"

#include <algorithm>
#include <array>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wextra"
#include <fcl/narrowphase/detail/convexity_based_algorithm/gjk_libccd.h>
#pragma GCC diagnostic pop

#include "../shape/shape_parts.hpp"

// Compiled here: FCL's library would load OctoMap at every start of the program.
template bool fcl::detail::GJKCollide<double>(void*, ccd_support_fn, ccd_center_fn, void*,
                                              ccd_support_fn, ccd_center_fn, unsigned, double,
                                              fcl::Vector3d*, double*, fcl::Vector3d*);

namespace altiplan {
namespace {

/// Far more than the error of FCL's test, far less than kBodyTolerance: the volume is grown by it.
constexpr double kDoubt = 1e-5;
/// Obstacles are cut off this far beyond the volume's box.
constexpr double kSurroundings = 1;

/// An obstacle for FCL: its farthest point in a direction, and a point inside, from the volume's
/// origin.
template <class Support>
struct Obstacle {
  Vec3 centre;
  Support support;
};

Vec3 vector_of(const ccd_vec3_t* v) { return {v->v[0], v->v[1], v->v[2]}; }
void set(ccd_vec3_t* v, const Vec3& p) { ccdVec3Set(v, p.x(), p.y(), p.z()); }

template <class Support>
bool fcl_meets(const SweptVolume& volume, const Obstacle<Support>& obstacle) {
  constexpr unsigned kMaxIterations = 500;
  constexpr double kTolerance = 1e-7;  // metres
  // The library's own functions do not change the objects.
  auto* ours = const_cast<SweptVolume*>(&volume);           // NOLINT(*-const-cast)
  auto* other = const_cast<Obstacle<Support>*>(&obstacle);  // NOLINT(*-const-cast)
  return fcl::detail::GJKCollide<double>(
      ours,
      [](const void* object, const ccd_vec3_t* direction, ccd_vec3_t* result) {
        set(result, static_cast<const SweptVolume*>(object)->support(vector_of(direction)));
      },
      [](const void* object, ccd_vec3_t* result) {
        set(result, static_cast<const SweptVolume*>(object)->support_centre());
      },
      other,
      [](const void* object, const ccd_vec3_t* direction, ccd_vec3_t* result) {
        set(result, static_cast<const Obstacle<Support>*>(object)->support(vector_of(direction)));
      },
      [](const void* object, ccd_vec3_t* result) {
        set(result, static_cast<const Obstacle<Support>*>(object)->centre);
      },
      kMaxIterations, kTolerance, nullptr, nullptr, nullptr);
}

/// The farthest of some points.
const Vec3& farthest(std::span<const Vec3> points, const Vec3& direction) {
  std::size_t best = 0;
  double max_along = -kInfinity;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double along = points[i].dot(direction);
    if (along > max_along) {
      max_along = along;
      best = i;
    }
  }
  return points[best];
}

Vec3 mean_of(std::span<const Vec3> points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) {
    sum += p;
  }
  return sum / double(points.size());
}

bool hull_meets(const SweptVolume& volume, std::span<const Vec3> from_origin) {
  const auto support = [&](const Vec3& direction) { return farthest(from_origin, direction); };
  return fcl_meets(volume, Obstacle<decltype(support)>{mean_of(from_origin), support});
}

bool ball_meets(const SweptVolume& volume, const Sphere& ball) {
  const Vec3 centre = ball.centre - volume.support_origin();
  const auto support = [&](const Vec3& direction) -> Vec3 {
    return centre + ball.radius * direction.normalized();
  };
  return fcl_meets(volume, Obstacle<decltype(support)>{centre, support});
}

bool cylinder_meets(const SweptVolume& volume, const Cylinder& cylinder, double floor,
                    double ceiling) {
  const Vec3& origin = volume.support_origin();
  const Vec3 centre(cylinder.x - origin.x(), cylinder.y - origin.y(),
                    (floor + ceiling) / 2 - origin.z());
  const auto support = [&, half = (ceiling - floor) / 2](const Vec3& direction) -> Vec3 {
    const double flat = direction.head<2>().norm();
    const double out = flat > 0 ? cylinder.radius / flat : 0;
    return centre +
           Vec3(out * direction.x(), out * direction.y(), direction.z() < 0 ? -half : half);
  };
  return fcl_meets(volume, Obstacle<decltype(support)>{centre, support});
}

/// The part of an edge within the horizontal extent of a box; false if there is none.
bool clip(Point2& e, Point2& f, const Box& box) {
  double begin = 0;
  double end = 1;
  const Point2 way{f[0] - e[0], f[1] - e[1]};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double low = box.min[int(axis)] - e[axis];
    const double high = box.max[int(axis)] - e[axis];
    if (way[axis] == 0) {
      if (low > 0 || high < 0) {
        return false;
      }
      continue;
    }
    begin = std::max(begin, (way[axis] > 0 ? low : high) / way[axis]);
    end = std::min(end, (way[axis] > 0 ? high : low) / way[axis]);
  }
  if (begin > end) {
    return false;
  }
  const Point2 from = e;
  e = {from[0] + begin * way[0], from[1] + begin * way[1]};
  f = {from[0] + end * way[0], from[1] + end * way[1]};
  return true;
}

/// A volume that meets no wall lies, at the prism's heights, wholly inside or wholly outside.
template <class Edges>
bool prism_meets(const SweptVolume& volume, const Edges& edges, double floor, double ceiling) {
  const Vec3& origin = volume.support_origin();
  const Box around = volume.box().grown(kSurroundings);
  const auto gap = [&](const EdgeTree::Rectangle& box) {
    return std::max({box.min[0] - around.max.x(), around.min.x() - box.max[0],
                     box.min[1] - around.max.y(), around.min.y() - box.max[1], 0.0});
  };
  bool meets = false;
  edges.visit(
      gap, [&] { return meets ? -1.0 : 0.0; },
      [&](Point2 e, Point2 f) {
        if (meets || !clip(e, f, around)) {
          return;
        }
        const std::array<Vec3, 4> wall{
            Vec3(e[0], e[1], floor) - origin, Vec3(f[0], f[1], floor) - origin,
            Vec3(f[0], f[1], ceiling) - origin, Vec3(e[0], e[1], ceiling) - origin};
        meets = hull_meets(volume, wall);
      });
  if (meets) {
    return true;
  }
  const Vec3 low = volume.lowest();
  const Vec3 up = volume.highest() - low;
  const double z = std::clamp(low.z(), floor, ceiling);
  const Vec3 at = low + std::clamp((z - low.z()) / up.z(), 0.0, 1.0) * up;
  return edges.covers(at.x(), at.y());
}
}  // namespace

SweptVolume::SweptVolume(const BodyPart& part, double outer, std::span<const Placement> placements,
                         double grown)
    : from_(placements.front().at),
      to_(placements.back().at),
      // The grown volume is one of cubes, which reach farther than spheres.
      reach_(outer + 3 * (grown + kDoubt)),
      origin_((from_ + to_) / 2),
      rounding_(part.rounding),
      grown_(grown + kDoubt),
      box_(Box::empty()) {
  points_.reserve(part.corners.size() * placements.size());
  for (const Placement& placement : placements) {
    const Vec3 at = placement.at - origin_;
    for (const Vec3& corner : part.corners) {
      points_.emplace_back(at + placement.rotation * corner);
      box_ = box_.with(points_.back());
    }
  }
  centre_ = mean_of(points_);
  box_ = box_.grown(rounding_ + grown_);
  box_ = {box_.min + origin_, box_.max + origin_};
}

Vec3 SweptVolume::support(const Vec3& direction) const {
  Vec3 point = farthest(points_, direction);
  if (rounding_ > 0) {
    point += rounding_ * direction.normalized();
  }
  return point + grown_ * direction.cwiseSign();
}

bool SweptVolume::meets(std::span<const Vec3> corners) const {
  std::vector<Vec3> from_origin(corners.begin(), corners.end());
  for (Vec3& corner : from_origin) {
    corner -= origin_;
  }
  return hull_meets(*this, from_origin);
}

bool SweptVolume::meets(const Box& box) const {
  const Box near = box.intersected(box_.grown(kSurroundings));
  if (!near.overlaps(box_) || near.is_empty()) {
    return false;
  }
  const Vec3 half = (near.max - near.min) / 2;
  const Vec3 centre = near.min + half - origin_;
  const auto support = [&](const Vec3& direction) -> Vec3 {
    return centre +
           half.cwiseProduct(direction.unaryExpr([](double d) { return d < 0 ? -1.0 : 1.0; }));
  };
  return fcl_meets(*this, Obstacle<decltype(support)>{centre, support});
}

bool SweptVolume::meets(const Shape& shape) const {
  return shape_parts::meets({shape, nullptr}, *this);
}

bool shape_parts::meets(const Indexed& solid, const SweptVolume& volume) {
  const Box& box = volume.box();
  if (!bounds(solid.shape).overlaps(box)) {
    return false;
  }
  const auto cut = [&](double z) {
    return std::clamp(z, box.min.z() - kSurroundings, box.max.z() + kSurroundings);
  };
  return std::visit(Overloaded{[&](const Sphere& s) { return ball_meets(volume, s); },
                               [&](const Cylinder& s) {
                                 return cylinder_meets(volume, s, cut(s.floor), cut(s.ceiling));
                               },
                               [&](const BoxShape& s) { return volume.meets(s.box); },
                               [&](const Prism& s) {
                                 return with_edges(s, solid.tree, [&](const auto& edges) {
                                   return prism_meets(volume, edges, cut(s.floor), cut(s.ceiling));
                                 });
                               }},
                    solid.shape);
}

bool meets_by_clearance(const SweptVolume& volume,
                        const std::function<double(const Vec3&)>& clearance, double tolerance) {
  // Finer boxes would not pay: there are as many as the square of their number along an edge.
  constexpr double kFinest = 1.0 / 64;
  tolerance = std::max(tolerance, kFinest * (volume.box().max - volume.box().min).maxCoeff());
  std::vector<Box> open{volume.box()};
  while (!open.empty()) {
    const Box box = open.back();
    open.pop_back();
    const Vec3 size = box.max - box.min;
    const Vec3 middle = box.min + size / 2;
    const double half = size.norm() / 2;
    const double distance = clearance(middle);
    if (distance >= half) {
      continue;
    }
    if (2 * half <= tolerance || (distance <= 0 && volume.meets(Box{middle, middle}))) {
      return true;
    }
    int axis = 0;
    size.maxCoeff(&axis);
    for (const bool is_low : {true, false}) {
      Box part = box;
      (is_low ? part.max : part.min)[axis] = middle[axis];
      if (volume.meets(part)) {
        open.push_back(part);
      }
    }
  }
  return false;
}
}  // namespace altiplan
