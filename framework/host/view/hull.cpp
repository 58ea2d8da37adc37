// SPDX-License-Identifier: Apache-2.0
#include "host/view/hull.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <set>

#include "altiplan/random.hpp"

// Beneath-beyond: points are added one by one; the faces that a point sees are replaced by a cone
// from their rim to it. O(n²). The points are moved at random by less than the accuracy, so that
// rounding decides nothing where four lie in a plane, as the corners of a box do.

namespace altiplan::host {
namespace {

using Triangle = std::array<std::size_t, 3>;

constexpr double kMoved = 1e-7;  // of the extent
constexpr double kFlat = 1e-6;

Vec3 normal_of(const std::vector<Vec3>& points, const Triangle& t) {
  return (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
}

/// Index of the point with the greatest value.
template <class Value>
std::size_t farthest(const std::vector<Vec3>& points, const Value& value) {
  return std::size_t(
      std::max_element(points.begin(), points.end(),
                       [&](const Vec3& p, const Vec3& q) { return value(p) < value(q); }) -
      points.begin());
}

/// Four points far apart, the last below the triangle of the others; none if they have no volume.
std::optional<std::array<std::size_t, 4>> first_corners(const std::vector<Vec3>& points,
                                                        double extent) {
  const std::size_t a = farthest(points, [](const Vec3& p) { return p.x(); });
  const std::size_t b = farthest(points, [&](const Vec3& p) { return (p - points[a]).norm(); });
  const Vec3 along = (points[b] - points[a]).normalized();
  std::size_t c =
      farthest(points, [&](const Vec3& p) { return (p - points[a]).cross(along).norm(); });
  const Vec3 across = along.cross(points[c] - points[a]).normalized();
  const std::size_t d =
      farthest(points, [&](const Vec3& p) { return std::abs((p - points[a]).dot(across)); });
  const double height = (points[d] - points[a]).dot(across);
  if (!(std::abs(height) > kFlat * extent)) {
    return std::nullopt;
  }
  return height < 0 ? std::array{a, b, c, d} : std::array{a, c, b, d};
}

class Hull {
 public:
  Hull(const std::vector<Vec3>& points, const std::array<std::size_t, 4>& first) : points_(points) {
    const auto [a, b, c, d] = first;
    faces_ = {{a, b, c}, {a, d, b}, {b, d, c}, {c, d, a}};
    for (std::size_t n = 0; n < points_.size(); ++n) {
      if (std::find(first.begin(), first.end(), n) == first.end()) {
        add(n);
      }
    }
  }
  const std::vector<Triangle>& faces() const { return faces_; }

 private:
  void add(std::size_t n) {
    std::set<std::array<std::size_t, 2>> edges;  // of the faces seen
    const auto unseen = std::partition(faces_.begin(), faces_.end(), [&](const Triangle& face) {
      return normal_of(points_, face).dot(points_[n] - points_[face[0]]) <= 0;
    });
    for (auto face = unseen; face != faces_.end(); ++face) {
      for (std::size_t side = 0; side < 3; ++side) {
        edges.insert({(*face)[side], (*face)[(side + 1) % 3]});
      }
    }
    faces_.erase(unseen, faces_.end());
    for (const auto& edge : edges) {
      if (!edges.contains({edge[1], edge[0]})) {
        faces_.push_back({edge[0], edge[1], n});
      }
    }
  }

  const std::vector<Vec3>& points_;
  std::vector<Triangle> faces_;
};
}  // namespace

std::vector<std::array<std::size_t, 3>> hull_triangles(const std::vector<Vec3>& points) {
  Box box = Box::empty();
  for (const Vec3& p : points) {
    box = box.with(p);
  }
  const double extent = points.empty() ? 0 : (box.max - box.min).norm();
  std::vector<Vec3> moved = points;
  RandomStream random(1);
  for (Vec3& p : moved) {
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] += kMoved * extent * (random.uniform() - 0.5);
    }
  }
  const auto first = points.size() < 4 ? std::nullopt : first_corners(moved, extent);
  return first ? Hull(moved, *first).faces() : std::vector<Triangle>{};
}
}  // namespace altiplan::host
