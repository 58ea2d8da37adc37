// SPDX-License-Identifier: Apache-2.0
#include "surface.hpp"

#include <algorithm>

#include "altiplan/kit/layers/solid.hpp"

namespace altiplan::mesh {
namespace {

constexpr std::uint32_t kLeafTriangles = 4;

double between(const Box& a, const Box& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).norm();
}

struct Crossing {
  double x;
  double z;
  bool up;  ///< the edge runs toward greater y
};

/// Position where the edge from–to, which crosses that y, does; never outside its ends' box.
Crossing at_level(const Vec3& from, const Vec3& to, double y) {
  const bool up = from.y() < to.y();
  const Vec3& low = up ? from : to;
  const Vec3& high = up ? to : from;
  const double share = (y - low.y()) / (high.y() - low.y());
  const auto mix = [&](int axis) {
    const auto [minimum, maximum] = std::minmax(low[axis], high[axis]);
    return std::clamp(low[axis] + share * (high[axis] - low[axis]), minimum, maximum);
  };
  return {mix(0), mix(2), up};
}

/// 1 if the triangle is above p and faces up, -1 if it faces down, else 0.
int winding_of(const Triangle& t, const Vec3& p) {
  std::array<Crossing, 2> at{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& from = t[i];
    const Vec3& to = t[(i + 1) % 3];
    if ((from.y() <= p.y()) != (to.y() <= p.y())) {
      at[count++] = at_level(from, to, p.y());
    }
  }
  if (count == 0 || (p.x() < at[0].x) == (p.x() < at[1].x)) {
    return 0;
  }
  const double share = (p.x() - at[0].x) / (at[1].x - at[0].x);
  if (at[0].z + share * (at[1].z - at[0].z) <= p.z()) {
    return 0;
  }
  const Crossing& east = p.x() < at[0].x ? at[0] : at[1];
  return east.up ? 1 : -1;
}
}  // namespace

Surface::Surface(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
  nodes_.reserve(triangles_.size());
  build(0, std::uint32_t(triangles_.size()));
}

/// Splits the triangles at their median along the longest side of their box.
std::uint32_t Surface::build(std::uint32_t first, std::uint32_t count) {
  const auto number = std::uint32_t(nodes_.size());
  nodes_.emplace_back();
  Node node;
  node.first = first;
  node.count = count;
  for (std::uint32_t i = first; i < first + count; ++i) {
    for (const Vec3& corner : triangles_[i]) {
      node.box = node.box.with(corner);
    }
  }
  if (count > kLeafTriangles) {
    int axis = 0;
    (node.box.max - node.box.min).maxCoeff(&axis);
    const auto begin = triangles_.begin() + first;
    std::nth_element(
        begin, begin + count / 2, begin + count, [axis](const Triangle& a, const Triangle& b) {
          return a[0][axis] + a[1][axis] + a[2][axis] < b[0][axis] + b[1][axis] + b[2][axis];
        });
    build(first, count / 2);
    node.right = build(first + count / 2, count - count / 2);
  }
  nodes_[number] = node;
  return number;
}

template <class Enter, class Visit>
bool Surface::any(const Node& node, const Enter& enter, const Visit& visit) const {
  if (!enter(node.box)) {
    return false;
  }
  if (node.right != 0) {
    return any(*(&node + 1), enter, visit) || any(nodes_[node.right], enter, visit);
  }
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
    if (visit(triangles_[i])) {
      return true;
    }
  }
  return false;
}

void Surface::find_nearest(const Node& node, const Vec3& p, Nearest& best) const {
  if (node.right == 0) {
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const Vec3 point = nearest_point(triangles_[i], p);
      const double distance = (point - p).norm();
      if (distance < best.distance) {
        best = {point, distance, &triangles_[i]};
      }
    }
    return;
  }
  const Node* near = &node + 1;
  const Node* far = &nodes_[node.right];
  double to_near = kit::outside(near->box, p);
  double to_far = kit::outside(far->box, p);
  if (to_far < to_near) {
    std::swap(near, far);
    std::swap(to_near, to_far);
  }
  if (to_near < best.distance) {
    find_nearest(*near, p, best);
  }
  if (to_far < best.distance) {
    find_nearest(*far, p, best);
  }
}

Surface::Nearest Surface::nearest(const Vec3& p) const {
  const Vec3 corner = triangles_.front()[0];
  Nearest best{corner, (corner - p).norm(), &triangles_.front()};
  find_nearest(nodes_.front(), p, best);
  return best;
}

bool Surface::leg_is_nearer(const Vec3& a, const Vec3& b, double distance) const {
  return any(
      nodes_.front(), [&](const Box& box) { return kit::may_reach(box, a, b, distance); },
      [&](const Triangle& t) { return leg_distance(t, a, b) < distance; });
}

bool Surface::box_is_nearer(const Box& box, double distance) const {
  return any(
      nodes_.front(), [&](const Box& node) { return between(node, box) <= distance; },
      [&](const Triangle& t) { return box_distance(t, box) < distance; });
}

bool Surface::meets(const SweptVolume& volume) const {
  return any(
      nodes_.front(),
      [&](const Box& box) {
        return box.overlaps(volume.box()) &&
               kit::may_reach(box, volume.from(), volume.to(), volume.reach());
      },
      [&](const Triangle& t) { return volume.meets(t); });
}

std::vector<double> Surface::meetings(const Vec3& a, const Vec3& b, double distance) const {
  std::vector<double> places;
  any(
      nodes_.front(), [&](const Box& box) { return kit::may_reach(box, a, b, distance); },
      [&](const Triangle& t) {
        add_meetings(t, a, b, distance, places);
        return false;
      });
  std::sort(places.begin(), places.end());
  return places;
}

int Surface::winding(const Vec3& p) const {
  int turns = 0;
  any(
      nodes_.front(),
      [&](const Box& box) {
        return p.x() >= box.min.x() && p.x() <= box.max.x() && p.y() >= box.min.y() &&
               p.y() <= box.max.y() && p.z() <= box.max.z();
      },
      [&](const Triangle& t) {
        turns += winding_of(t, p);
        return false;
      });
  return turns;
}
}  // namespace altiplan::mesh
