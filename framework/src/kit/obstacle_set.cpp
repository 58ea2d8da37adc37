// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/obstacle_set.hpp"

#include <algorithm>
#include <string>

#include "altiplan/error.hpp"

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

double outside(const Box& box, const Vec3& p) {
  return (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).norm();
}

// No shape within the box is deeper around p than the box itself.
double signed_outside(const Box& box, const Vec3& p) {
  const double deepest = (box.min - p).cwiseMax(p - box.max).maxCoeff();
  return deepest <= 0 ? deepest : outside(box, p);
}

// Whether the leg may come as near to the box as `reach`: never wrongly false.
bool may_reach(const Box& box, const Vec3& a, const Vec3& b, double reach) {
  const Box grown = box.grown(reach);
  double enter = 0;
  double leave = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double along = b[axis] - a[axis];
    const double low = grown.min[axis] - a[axis];
    const double high = grown.max[axis] - a[axis];
    if (along == 0) {
      if (low > 0 || high < 0) {
        return false;
      }
    } else {
      enter = std::max(enter, (along > 0 ? low : high) / along);
      leave = std::min(leave, (along > 0 ? high : low) / along);
    }
  }
  return enter <= leave;
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

int clamped_index(double value, int low, int high) {
  return static_cast<int>(std::clamp(value, double(low), double(high)));
}

// Blocks the cells of one row that the rule blocks. The signed distance is 1-Lipschitz, so one
// look at a centre settles many cells; only those that the grown surface may cut are looked at
// exactly.
void rasterize_row(const Shape& shape, VoxelGrid& grid, int i0, int i1, int j, int k) {
  const GridSpec& spec = grid.spec();
  const bool centre_rule = spec.rule == GridSpec::Rule::centre;
  const double by = spec.inflation + (centre_rule ? kMeets : 0);
  const double margin = centre_rule ? 0 : spec.cell.norm() / 2;
  const double width = spec.cell.x();
  for (int i = i0; i <= i1;) {
    const double distance = signed_distance(shape, spec.centre({i, j, k}));
    if (distance <= by) {
      const int run = clamped_index((by - distance) / width, 0, i1 - i);
      grid.block_run(i, i + run, j, k);
      i += run + 1;
    } else if (distance >= by + margin) {
      i += std::max(1, clamped_index((distance - by - margin) / width, 0, i1 - i + 1));
    } else {
      if (overlaps(shape, spec.cell_box({i, j, k}), by)) {
        grid.block_run(i, i, j, k);
      }
      ++i;
    }
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

void ObstacleSet::rasterize(VoxelGrid& grid) const {
  const GridSpec& spec = grid.spec();
  for (const Shape& shape : shapes_) {
    const Box box = altiplan::bounds(shape).grown(spec.inflation);
    Cell first{};
    Cell last{};
    for (int axis = 0; axis < 3; ++axis) {
      const double low = (box.min[axis] - spec.origin[axis]) / spec.cell[axis];
      const double high = (box.max[axis] - spec.origin[axis]) / spec.cell[axis];
      first[axis] = clamped_index(std::floor(low) - 1, 0, spec.counts[axis]);
      last[axis] = clamped_index(std::ceil(high) + 1, -1, spec.counts[axis] - 1);
    }
    for (int k = first[2]; k <= last[2]; ++k) {
      for (int j = first[1]; j <= last[1]; ++j) {
        rasterize_row(shape, grid, first[0], last[0], j, k);
      }
    }
  }
}
}  // namespace altiplan::kit
