// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/layers/obstacle_set.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <string>

#include "altiplan/error.hpp"
#include "altiplan/kit/layers/solid.hpp"
#include "altiplan/swept_volume.hpp"

#include "../../multiversion.hpp"
#include "../../shape/shape_parts.hpp"
#include "box_tree.hpp"

// A bounding box tree finds the shapes near a point or a leg, closed forms decide: see
// docs/decisions/0002-fcl.md for the measurement behind this.
namespace altiplan::kit {
namespace {

// Distances below this are rounding: the leg meets the solid.
constexpr double kMeets = 1e-9;

using shape_parts::Indexed;
using Trees = std::vector<std::unique_ptr<EdgeTree>>;

// The shapes, with edge trees for those with many edges, or boxes of cells, each converted to a
// shape on demand.
class Solids {
 public:
  Solids(const std::vector<Shape>& shapes, const Trees& trees, const CellBoxes& cells)
      : shapes_(shapes.data()), trees_(trees.empty() ? nullptr : trees.data()), cells_(cells) {}

  Indexed operator[](std::size_t n) {
    if (shapes_ == nullptr) {
      return {box_ = cells_[n], nullptr};
    }
    return {shapes_[n], trees_ == nullptr ? nullptr : trees_[n].get()};
  }

 private:
  const Shape* shapes_;
  const std::unique_ptr<EdgeTree>* trees_;
  const CellBoxes& cells_;
  Shape box_;
};

bool meets(const Indexed& shape, const Vec3& a, const Vec3& b, double r) {
  const double limit = r - kLengthTolerance;
  if (limit > kMeets) {
    return comes_within(shape, a, b, limit);
  }
  // A point (r below the tolerance) is blocked if it is inside, as touching is free.
  if (!comes_within(shape, a, b, 2 * kMeets)) {
    return false;
  }
  const double distance = leg_distance(shape, a, b);
  // leg_depth may be half of the leg's maximum depth.
  return distance < limit ||
         (distance <= kMeets && -leg_depth(shape, a, b) < r - kLengthTolerance / 2);
}

bool is_in_reach(const Vec3& p) { return p.cwiseAbs().maxCoeff() <= kTreeReach; }

// A node on the current path, with the lanes not yet visited.
struct Open {
  Keys keys;
  const BoxNode* node;
  std::uint32_t lanes;
};

// Descends to the nearest leaf first, so that few lanes are still near enough on the way back.
ALTIPLAN_CLONES double min_distance(const BoxNode* nodes, Solids& shapes, const Vec3& p) {
  std::array<Open, kMaxLevels> way;
  std::size_t depth = 0;
  const float point[3] = {float(p.x()), float(p.y()), float(p.z())};
  double minimum = kInfinity;
  std::int32_t limit = key_of(minimum);
  for (const BoxNode* node = nodes;;) {
    Open& here = way[depth];
    keys_of(*node, point, here.keys);
    const std::int32_t nearest = min_of(here.keys);
    if (nearest <= limit) {
      int lane = nearest & 15;
      here.lanes = ~(1U << lane);
      if (!node->is_leaf()) {
        here.node = node;
        ++depth;
        node = nodes + node->first + lane;
        continue;
      }
      for (std::uint32_t lanes = here.lanes;;) {
        minimum = std::min(minimum, signed_distance(shapes[std::size_t(node->box[lane])], p));
        limit = key_of(minimum);
        lanes &= lanes_within(here.keys, limit);
        if (lanes == 0) {
          break;
        }
        lane = std::countr_zero(lanes);
        lanes &= lanes - 1;
      }
    }
    for (;; --depth) {
      if (depth == 0) {
        return minimum;
      }
      Open& above = way[depth - 1];
      above.lanes &= lanes_within(above.keys, limit);
      if (above.lanes != 0) {
        node = nodes + above.node->first + std::countr_zero(above.lanes);
        above.lanes &= above.lanes - 1;
        break;
      }
    }
  }
}

/// The leaf in which a shape blocked the last leg, of whatever tree; -1 if that leg was free.
/// Searches ask for many similar legs one after the other, which the same shape blocks.
thread_local std::int32_t last_leaf = -1;

// Inlined for Clang's clones, too.
template <class Meets>
[[gnu::always_inline]] inline bool any_in_leaf(const BoxNode& leaf, const TreeLeg& leg,
                                               const Meets& meets) {
  std::uint32_t lanes = lanes_reached(leaf, leg);
  while (lanes != 0 && !meets(std::size_t(leaf.box[std::countr_zero(lanes)]))) {
    lanes &= lanes - 1;
  }
  return lanes != 0;
}

/// True if `meets`(n) for one of the shapes whose boxes the leg may reach. Looks first where
/// something blocked the last leg.
template <class Meets>
[[gnu::always_inline]] inline bool any_on(const std::vector<BoxNode>& nodes, const TreeLeg& leg,
                                          const Meets& meets) {
  const std::int32_t likely = last_leaf;
  if (std::size_t(likely) < nodes.size() && nodes[std::size_t(likely)].is_leaf() &&
      any_in_leaf(nodes[std::size_t(likely)], leg, meets)) {
    return true;
  }
  std::array<std::int32_t, kMaxOpen> open{0};
  std::size_t waiting = 1;
  while (waiting > 0) {
    const std::int32_t index = open[--waiting];
    const BoxNode& node = nodes[std::size_t(index)];
    if (node.is_leaf()) {
      if (index != likely && any_in_leaf(node, leg, meets)) {
        last_leaf = index;
        return true;
      }
      continue;
    }
    for (std::uint32_t lanes = lanes_reached(node, leg); lanes != 0; lanes &= lanes - 1) {
      open[waiting++] = node.first + std::countr_zero(lanes);
    }
  }
  last_leaf = -1;
  return false;
}

ALTIPLAN_CLONES bool any_meets(const std::vector<BoxNode>& nodes, Solids& shapes, const Vec3& a,
                               const Vec3& b, double r) {
  return any_on(nodes, TreeLeg(a, b, r), [&](std::size_t n) { return meets(shapes[n], a, b, r); });
}

ALTIPLAN_CLONES bool any_meets(const std::vector<BoxNode>& nodes, Solids& shapes,
                               const SweptVolume& volume) {
  return any_on(nodes, TreeLeg(volume.from(), volume.to(), volume.reach()),
                [&](std::size_t n) { return shape_parts::meets(shapes[n], volume); });
}

// The shapes that may be that near, in order.
std::vector<int> shapes_within(const BoxNode* nodes, const Vec3& p, double reach) {
  std::vector<int> found;
  std::array<std::int32_t, kMaxOpen> open{0};
  std::size_t waiting = 1;
  const float point[3] = {float(p.x()), float(p.y()), float(p.z())};
  const std::int32_t limit = key_of(reach);
  while (waiting > 0) {
    const BoxNode& node = nodes[open[--waiting]];
    Keys keys;
    keys_of(node, point, keys);
    for (std::uint32_t lanes = lanes_within(keys, limit); lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      if (node.is_leaf()) {
        found.push_back(node.box[lane]);
      } else {
        open[waiting++] = node.first + lane;
      }
    }
  }
  std::sort(found.begin(), found.end());  // hides the tree's order
  return found;
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

Trees trees_of(const std::vector<Shape>& shapes) {
  Trees trees;
  for (std::size_t n = 0; n < shapes.size(); ++n) {
    const auto* prism = std::get_if<Prism>(&shapes[n]);
    if (prism == nullptr) {
      continue;
    }
    std::vector<const std::vector<Point2>*> rings{&prism->outline};
    std::size_t edges = prism->outline.size();
    for (const std::vector<Point2>& hole : prism->holes) {
      rings.push_back(&hole);
      edges += hole.size();
    }
    if (edges >= kManyEdges) {
      trees.resize(shapes.size());
      trees[n] = std::make_unique<EdgeTree>(rings);
    }
  }
  return trees;
}

}  // namespace

struct ObstacleSet::Impl {
  std::vector<BoxNode> nodes;
  std::size_t count = 0;
  Trees trees;
  CellBoxes cells;

  Solids solids(const std::vector<Shape>& shapes) const { return {shapes, trees, cells}; }
};

ObstacleSet::ObstacleSet(std::vector<Shape> shapes)
    : shapes_(std::move(shapes)), bounds_(Box::empty()), impl_(std::make_unique<Impl>()) {
  std::vector<Box> boxes;
  boxes.reserve(shapes_.size());
  for (std::size_t n = 0; n < shapes_.size(); ++n) {
    check(shapes_[n], n);
    boxes.push_back(altiplan::bounds(shapes_[n]));
    bounds_ = bounds_.united(boxes.back());
  }
  impl_->nodes = box_tree(boxes);
  impl_->count = shapes_.size();
  impl_->trees = trees_of(shapes_);
}

ObstacleSet ObstacleSet::of_cells(CellBoxes boxes) {
  ObstacleSet set(std::vector<Shape>{});
  Impl& impl = *set.impl_;
  impl.cells = std::move(boxes);
  impl.count = impl.cells.boxes.size();
  impl.nodes = box_tree(impl.cells);
  for (std::size_t n = 0; n < impl.count; ++n) {
    set.bounds_ = set.bounds_.united(impl.cells[n].box);
  }
  return set;
}

ObstacleSet::~ObstacleSet() = default;
ObstacleSet::ObstacleSet(ObstacleSet&&) noexcept = default;
ObstacleSet& ObstacleSet::operator=(ObstacleSet&&) noexcept = default;

double ObstacleSet::clearance(const Vec3& p) const {
  Solids solids = impl_->solids(shapes_);
  if (impl_->count > 0 && is_in_reach(p)) {
    return min_distance(impl_->nodes.data(), solids, p);
  }
  double minimum = kInfinity;
  for (std::size_t n = 0; n < impl_->count; ++n) {
    minimum = std::min(minimum, signed_distance(solids[n], p));
  }
  return minimum;
}

bool ObstacleSet::blocked(const Vec3& a, const Vec3& b, double r) const {
  Solids solids = impl_->solids(shapes_);
  if (impl_->count > 0 && is_in_reach(a) && is_in_reach(b) && std::abs(r) <= kTreeReach) {
    return any_meets(impl_->nodes, solids, a, b, r);
  }
  bool meet = false;
  for (std::size_t n = 0; n < impl_->count && !meet; ++n) {
    meet = kit::meets(solids[n], a, b, r);
  }
  return meet;
}

bool ObstacleSet::meets(const SweptVolume& volume) const {
  Solids solids = impl_->solids(shapes_);
  if (impl_->count > 0 && is_in_reach(volume.from()) && is_in_reach(volume.to())) {
    return any_meets(impl_->nodes, solids, volume);
  }
  for (std::size_t n = 0; n < impl_->count; ++n) {
    if (shape_parts::meets(solids[n], volume)) {
      return true;
    }
  }
  return false;
}

void ObstacleSet::near(const Vec3& p, double reach, const NearSink& sink) const {
  Solids solids = impl_->solids(shapes_);
  std::vector<int> ids(impl_->count);
  if (impl_->count > 0 && is_in_reach(p) && std::abs(reach) <= kTreeReach) {
    ids = shapes_within(impl_->nodes.data(), p, reach);
  } else {
    std::iota(ids.begin(), ids.end(), 0);
  }
  for (const int id : ids) {
    const Indexed shape = solids[std::size_t(id)];
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

std::vector<Threat> threats_of(const std::vector<Shape>& shapes) {
  std::vector<Threat> threats;
  for (const Shape& shape : shapes) {
    const Box box = altiplan::bounds(shape);
    const auto size = (box.max - box.min).head<2>();
    Vec3 centre = (box.min + box.max) / 2;
    centre.z() = std::isfinite(centre.z()) ? centre.z() : 0;
    const bool round =
        std::holds_alternative<Sphere>(shape) || std::holds_alternative<Cylinder>(shape);
    if (is_finite(centre)) {
      threats.push_back({centre, round ? size.x() / 2 : size.norm() / 2, "obstacle", ""});
    }
  }
  return threats;
}

ShapeLayer::ShapeLayer(std::vector<Shape> shapes) : set_(std::move(shapes)) {
  info_.threats = threats_of(set_.shapes());
}

void ObstacleSet::rasterize(VoxelGrid& grid) const {
  Solids solids = impl_->solids(shapes_);
  for (std::size_t n = 0; n < impl_->count; ++n) {
    const Indexed solid = solids[n];
    kit::rasterize(
        grid, altiplan::bounds(solid.shape),
        [&](const Vec3& p) { return signed_distance(solid, p); },
        [&](const Box& box, double by) { return overlaps(solid, box, by); });
  }
}
}  // namespace altiplan::kit
