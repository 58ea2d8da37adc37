// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/obstacle_set.hpp"

#include <algorithm>
#include <string>

#include "altiplan/error.hpp"
#include "altiplan/kit/solid.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wpedantic"
#include <fcl/broadphase/detail/hierarchy_tree.h>
#include <fcl/math/bv/AABB.h>
#pragma GCC diagnostic pop

// FCL's dynamic AABB tree finds the shapes near a point or a leg, closed forms decide: see
// docs/decisions/0002-fcl.md for the measurement behind this.
namespace altiplan::kit {
namespace {

using Tree = fcl::detail::HierarchyTree<fcl::AABB<double>>;

// The tree takes middles of boxes, so infinite sides are cut here: far beyond any world.
constexpr double kFar = 1e12;
// Distances below this are rounding: the leg meets the solid.
constexpr double kMeets = 1e-9;

Box box_of(const Tree::NodeType& node) { return {node.bv.min_, node.bv.max_}; }

// No shape within the box is deeper around p than the box itself.
double signed_outside(const Box& box, const Vec3& p) {
  const double deepest = (box.min - p).cwiseMax(p - box.max).maxCoeff();
  return deepest <= 0 ? deepest : outside(box, p);
}

bool meets(const Shape& shape, const Vec3& a, const Vec3& b, double r) {
  const double limit = r - kLengthTolerance;
  const double distance = leg_distance(shape, a, b);
  // A point (r below the tolerance) is blocked where it gets inside, as touching is free.
  return distance < limit ||
         (limit <= kMeets && distance <= kMeets && -leg_depth(shape, a, b) < limit);
}

void check(const Shape& shape, std::size_t index) {
  const Box box = bounds(shape);
  std::string wrong;
  if (const auto* prism = std::get_if<Prism>(&shape)) {
    const auto is_short = [](const auto& ring) { return ring.size() < 3; };
    if (is_short(prism->outline) ||
        std::any_of(prism->holes.begin(), prism->holes.end(), is_short)) {
      wrong = "a polygon needs at least three corners";
    }
  }
  const auto* sphere = std::get_if<Sphere>(&shape);
  const auto* cylinder = std::get_if<Cylinder>(&shape);
  const double radius = sphere ? sphere->radius : cylinder ? cylinder->radius : 0;
  if (!(radius >= 0) || !std::isfinite(radius)) {
    wrong = "its radius must be finite and not negative, found " + std::to_string(radius);
  } else if (wrong.empty() && !(box.min.array() <= box.max.array()).all()) {
    wrong = "its floor must not lie above its ceiling and its coordinates must be numbers";
  }
  if (!wrong.empty()) {
    throw Error("shape " + std::to_string(index) + ": " + wrong);
  }
}

}  // namespace

struct ObstacleSet::Impl {
  Tree tree;
  std::vector<int> ids;  // a leaf's data points to the id of its shape

  // Calls visit(id) for the leaves under nodes that enter() admits, until it returns false.
  template <class Enter, class Visit>
  static bool walk(const Tree::NodeType* node, const Enter& enter, const Visit& visit) {
    if (!enter(box_of(*node))) {
      return true;
    }
    if (node->isLeaf()) {
      return visit(*static_cast<const int*>(node->data));
    }
    return walk(node->children[0], enter, visit) && walk(node->children[1], enter, visit);
  }

  void nearest(const Tree::NodeType* node, const std::vector<Shape>& shapes, const Vec3& p,
               double& least) const {
    if (node->isLeaf()) {
      least = std::min(least, signed_distance(shapes[*static_cast<const int*>(node->data)], p));
      return;
    }
    const Tree::NodeType* first = node->children[0];
    const Tree::NodeType* second = node->children[1];
    double to_first = signed_outside(box_of(*first), p);
    double to_second = signed_outside(box_of(*second), p);
    if (to_second < to_first) {
      std::swap(first, second);
      std::swap(to_first, to_second);
    }
    if (to_first < least) {
      nearest(first, shapes, p, least);
    }
    if (to_second < least) {
      nearest(second, shapes, p, least);
    }
  }
};

ObstacleSet::ObstacleSet(std::vector<Shape> shapes)
    : shapes_(std::move(shapes)), bounds_(Box::empty()), impl_(std::make_unique<Impl>()) {
  std::vector<Tree::NodeType*> leaves;  // the tree will own them
  impl_->ids.resize(shapes_.size());
  for (std::size_t n = 0; n < shapes_.size(); ++n) {
    check(shapes_[n], n);
  }
  for (std::size_t n = 0; n < shapes_.size(); ++n) {
    const Box box = altiplan::bounds(shapes_[n]);
    bounds_ = bounds_.united(box);
    impl_->ids[n] = static_cast<int>(n);
    auto* leaf = new Tree::NodeType;
    leaf->bv.min_ = box.min.cwiseMax(-kFar);
    leaf->bv.max_ = box.max.cwiseMin(kFar);
    leaf->parent = nullptr;
    leaf->children[1] = nullptr;
    leaf->data = &impl_->ids[n];
    leaves.push_back(leaf);
  }
  if (!leaves.empty()) {
    impl_->tree.init(leaves);
  }
}

ObstacleSet::~ObstacleSet() = default;
ObstacleSet::ObstacleSet(ObstacleSet&&) noexcept = default;
ObstacleSet& ObstacleSet::operator=(ObstacleSet&&) noexcept = default;

double ObstacleSet::clearance(const Vec3& p) const {
  double least = kInfinity;
  if (!shapes_.empty()) {
    impl_->nearest(impl_->tree.getRoot(), shapes_, p, least);
  }
  return least;
}

bool ObstacleSet::blocked(const Vec3& a, const Vec3& b, double r) const {
  return !shapes_.empty() &&
         !Impl::walk(
             impl_->tree.getRoot(), [&](const Box& box) { return may_reach(box, a, b, r); },
             [&](int id) { return !meets(shapes_[std::size_t(id)], a, b, r); });
}

void ObstacleSet::near(const Vec3& p, double reach, const NearSink& sink) const {
  if (shapes_.empty()) {
    return;
  }
  std::vector<int> ids;
  Impl::walk(
      impl_->tree.getRoot(), [&](const Box& box) { return signed_outside(box, p) <= reach; },
      [&](int id) {
        ids.push_back(id);
        return true;
      });
  std::sort(ids.begin(), ids.end());  // the tree's order is nobody's business
  for (const int id : ids) {
    const Shape& shape = shapes_[std::size_t(id)];
    const double distance = signed_distance(shape, p);
    if (distance > reach) {
      continue;
    }
    const Vec3 point = nearest_surface_point(shape, p);
    Vec3 normal = distance < 0 ? Vec3(point - p) : Vec3(p - point);
    if (!(std::abs(distance) > kMeets)) {  // on the surface: by the distance's gradient
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = 1e-3 * Vec3::Unit(axis);
        normal[axis] = signed_distance(shape, p + step) - signed_distance(shape, p - step);
      }
    }
    const double length = normal.norm();
    sink({point, distance, length > 0 ? Vec3(normal / length) : Vec3(0, 0, 1), id});
  }
}

Drawing drawing_of(const std::vector<Shape>& shapes, Drawn::Role role) {
  Drawing drawing;
  drawing.shapes.reserve(shapes.size());
  for (const Shape& shape : shapes) {
    drawing.shapes.push_back({shape, role, {}});
  }
  return drawing;
}

void ObstacleSet::rasterize(VoxelGrid& grid) const {
  for (const Shape& shape : shapes_) {
    kit::rasterize(
        grid, altiplan::bounds(shape), [&](const Vec3& p) { return signed_distance(shape, p); },
        [&](const Box& box, double by) { return overlaps(shape, box, by); });
  }
}
}  // namespace altiplan::kit
