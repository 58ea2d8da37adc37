// SPDX-License-Identifier: Apache-2.0
#include "altiplan/body.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <string>

#include "altiplan/error.hpp"
#include "altiplan/swept_volume.hpp"
#include "altiplan/vehicle.hpp"

namespace altiplan {
namespace {

/// Unit vectors that leave no direction farther than `kBetween` radians from one of them.
constexpr int kDirections = 2000;
constexpr double kBetween = 0.06;
constexpr double kThinnest = 1e-3;  // metres

Vec3 direction(int n) {
  // A Fibonacci lattice on the sphere.
  const double z = 1 - (2 * n + 1.0) / kDirections;
  const double turn = n * kPi * (3 - std::sqrt(5.0));
  const double flat = std::sqrt(1 - z * z);
  return {flat * std::cos(turn), flat * std::sin(turn), z};
}

std::size_t farthest_index(const std::vector<Vec3>& points, const Vec3& along) {
  return std::size_t(
      std::max_element(points.begin(), points.end(),
                       [&](const Vec3& p, const Vec3& q) { return p.dot(along) < q.dot(along); }) -
      points.begin());
}

/// Width across the plane that fits the points best; 0 if there are none.
double width_of(const std::vector<Vec3>& points) {
  if (points.empty()) {
    return 0;
  }
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points) {
    mean += p / double(points.size());
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& p : points) {
    spread += (p - mean) * (p - mean).transpose();
  }
  const Vec3 across = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
  return (points[farthest_index(points, across)] - points[farthest_index(points, -across)])
      .dot(across);
}

double outer_of(const std::vector<Vec3>& corners) {
  double max_norm = 0;
  for (const Vec3& corner : corners) {
    max_norm = std::max(max_norm, corner.norm());
  }
  return max_norm;
}
}  // namespace

BodyPart box_part(const Vec3& size_m, const Vec3& offset_m) {
  BodyPart part;
  for (int n = 0; n < 8; ++n) {
    const Vec3 side((n & 1) != 0 ? 0.5 : -0.5, (n & 2) != 0 ? 0.5 : -0.5,
                    (n & 4) != 0 ? 0.5 : -0.5);
    part.corners.emplace_back(offset_m + size_m.cwiseProduct(side));
  }
  part.inner_m = std::max(0.0, (size_m / 2 - offset_m.cwiseAbs()).minCoeff());
  part.outer_m = outer_of(part.corners);
  return part;
}

BodyPart cylinder_part(double radius_m, double height_m, const Vec3& offset_m) {
  constexpr int kSides = 32;
  const double around = radius_m / std::cos(kPi / kSides);
  BodyPart part;
  for (int n = 0; n < kSides; ++n) {
    const Vec3 out =
        around * Vec3(std::cos(2 * kPi * n / kSides), std::sin(2 * kPi * n / kSides), 0);
    part.corners.emplace_back(offset_m + out + Vec3(0, 0, height_m / 2));
    part.corners.emplace_back(offset_m + out - Vec3(0, 0, height_m / 2));
  }
  part.inner_m = std::max(
      0.0, std::min(radius_m - offset_m.head<2>().norm(), height_m / 2 - std::abs(offset_m.z())));
  part.outer_m = outer_of(part.corners);
  return part;
}

BodyPart capsule_part(double radius_m, double length_m, const Vec3& offset_m) {
  if (length_m < 2 * radius_m) {
    throw Error("a capsule is at least as long as wide: expected length_m of at least " +
                std::to_string(2 * radius_m) + ", found " + std::to_string(length_m));
  }
  const Vec3 half(length_m / 2 - radius_m, 0, 0);
  BodyPart part{{offset_m - half, offset_m + half}, radius_m, 0, 0};
  part.inner_m =
      std::max(0.0, radius_m - point_leg_distance(Vec3::Zero(), part.corners[0], part.corners[1]));
  part.outer_m = outer_of(part.corners) + radius_m;
  return part;
}

BodyPart hull_part(const std::vector<Vec3>& points) {
  if (!(width_of(points) >= kThinnest)) {
    throw Error("it has no volume: its points lie within 1 mm of a plane");
  }
  // The points farthest in many directions, then those that their hull does not contain.
  std::vector<bool> is_corner(points.size(), false);
  double min_support = kInfinity;
  for (int n = 0; n < kDirections; ++n) {
    const Vec3 along = direction(n);
    const std::size_t first = farthest_index(points, along);
    const std::size_t last = farthest_index(points, -along);
    is_corner[first] = is_corner[last] = true;
    min_support = std::min(min_support, points[first].dot(along));
  }
  const double outer = outer_of(points);
  BodyPart part;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_corner[i]) {
      part.corners.push_back(points[i]);
    }
  }
  const Placement here;
  for (std::size_t i = 0; i < points.size() && part.corners.size() <= kMaxCorners; ++i) {
    const SweptVolume hull(part, outer, {&here, 1}, 0);
    for (; i < points.size() && (is_corner[i] || hull.meets(std::span(&points[i], 1))); ++i) {
    }
    if (i < points.size()) {
      part.corners.push_back(points[i]);
    }
  }
  if (part.corners.size() > kMaxCorners) {
    throw Error("its convex hull has more than " + std::to_string(kMaxCorners) +
                " corners: simplify it");
  }
  part.inner_m = std::max(0.0, min_support - kBetween * outer);
  part.outer_m = outer;
  return part;
}

double Body::inner_m() const {
  double max_inner = 0;
  for (const BodyPart& part : parts) {
    max_inner = std::max(max_inner, part.inner_m);
  }
  return max_inner;
}

double Body::outer_m() const {
  double max_outer = 0;
  for (const BodyPart& part : parts) {
    max_outer = std::max(max_outer, part.outer_m);
  }
  return max_outer;
}
}  // namespace altiplan
