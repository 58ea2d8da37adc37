// SPDX-License-Identifier: Apache-2.0
#include "box_tree.hpp"

#include <algorithm>
#include <numeric>

namespace altiplan::kit {
namespace {

/// A box in floats.
struct FloatBox {
  float min[3];
  float max[3];
};

constexpr float kMax = std::numeric_limits<float>::max();
constexpr FloatBox kNothing{{kMax, kMax, kMax}, {-kMax, -kMax, -kMax}};

FloatBox grown(const Box& box) {
  double maximum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {box.min[axis], box.max[axis]}) {
      maximum = std::abs(side) <= kTreeReach ? std::max(maximum, std::abs(side)) : maximum;
    }
  }
  FloatBox result{};
  for (int axis = 0; axis < 3; ++axis) {
    const double min = box.min[axis] - kTreeGrowth * maximum;
    const double max = box.max[axis] + kTreeGrowth * maximum;
    result.min[axis] =
        min >= -kTreeReach ? rounded_down(std::min(min, kTreeReach)) : -float(kInfinity);
    result.max[axis] =
        max <= kTreeReach ? rounded_up(std::max(max, -kTreeReach)) : float(kInfinity);
  }
  return result;
}

/// Boxes as stored in the tree, and their sort keys.
class SolidBoxes {
 public:
  explicit SolidBoxes(const std::vector<Box>& boxes) : boxes_(boxes.size()) {
    std::transform(boxes.begin(), boxes.end(), boxes_.begin(), grown);
  }
  std::size_t count() const { return boxes_.size(); }
  FloatBox box(std::int32_t index) const { return boxes_[std::size_t(index)]; }
  float twice_middle(std::int32_t index, int axis) const {
    constexpr float kFar = 2e15F;  // keeps the sum of two infinite sides a number
    const FloatBox& box = boxes_[std::size_t(index)];
    return std::clamp(box.min[axis], -kFar, kFar) + std::clamp(box.max[axis], -kFar, kFar);
  }

 private:
  std::vector<FloatBox> boxes_;
};

/// The same for cells, without further data per cell.
class BoxesOfCells {
 public:
  explicit BoxesOfCells(const CellBoxes& boxes)
      : boxes_(boxes), edge_(boxes.spec.cell.cast<float>()) {}
  std::size_t count() const { return boxes_.boxes.size(); }
  FloatBox box(std::int32_t index) const { return grown(boxes_[std::size_t(index)].box); }
  float twice_middle(std::int32_t index, int axis) const {
    const CellBox& box = boxes_.boxes[std::size_t(index)];
    return float(box.first[std::size_t(axis)] + box.last[std::size_t(axis)]) * edge_[axis];
  }

 private:
  const CellBoxes& boxes_;
  Eigen::Vector3f edge_;
};

template <class Boxes>
struct Builder {
  const Boxes boxes;
  std::vector<std::int32_t> order;  // indices of boxes, contiguous for each node
  std::vector<BoxNode> nodes;

  using Range = std::array<std::size_t, 2>;

  explicit Builder(const auto& of) : boxes(of), order(boxes.count()) {
    std::iota(order.begin(), order.end(), 0);
    nodes.reserve(order.size() / (BoxNode::kWidth - 2) + std::bit_width(order.size()));
    if (!order.empty()) {
      nodes.resize(1);
      make(0, {0, order.size()});
    }
  }

  float twice_middle(std::int32_t index, int axis) const { return boxes.twice_middle(index, axis); }

  // Bounds of twice the centres of a range.
  struct Extent {
    float low[3];
    float high[3];

    int longest_axis() const {
      int longest = 0;
      for (const int axis : {1, 2}) {
        if (high[axis] - low[axis] > high[longest] - low[longest]) {
          longest = axis;
        }
      }
      return longest;
    }
  };

  Extent extent(const Range& range) const {
    Extent result{{kMax, kMax, kMax}, {-kMax, -kMax, -kMax}};
    for (std::size_t n = range[0]; n < range[1]; ++n) {
      for (int axis = 0; axis < 3; ++axis) {
        const float middle = twice_middle(order[n], axis);
        result.low[axis] = std::min(result.low[axis], middle);
        result.high[axis] = std::max(result.high[axis], middle);
      }
    }
    return result;
  }

  // Splits the range into that many parts of about equal size.
  void cut(const Range& range, const Extent& within, std::size_t parts, std::vector<Range>& into) {
    if (parts == 1) {
      into.push_back(range);
      return;
    }
    const std::size_t first = parts / 2;
    const std::size_t middle = range[0] + (range[1] - range[0]) * first / parts;
    const int axis = within.longest_axis();
    const auto at = [&](std::size_t n) { return order.begin() + std::ptrdiff_t(n); };
    std::nth_element(at(range[0]), at(middle), at(range[1]), [&](auto one, auto other) {
      return twice_middle(one, axis) < twice_middle(other, axis);
    });
    Extent below = within;
    Extent above = within;
    below.high[axis] = above.low[axis] = twice_middle(order[middle], axis);
    cut({range[0], middle}, below, first, into);
    cut({middle, range[1]}, above, parts - first, into);
  }

  // Builds the node of a range and its subtree; returns its box.
  FloatBox make(std::size_t index, const Range& range) {
    constexpr std::size_t kWidth = BoxNode::kWidth;
    const std::size_t count = range[1] - range[0];
    const bool is_leaf = count <= kWidth;
    std::vector<Range> parts;
    std::size_t full = 1;  // boxes below a child in a full tree
    while (full * kWidth < count) {
      full *= kWidth;
    }
    cut(range, extent(range), (count + full - 1) / full, parts);
    const std::size_t first = nodes.size();
    nodes.resize(first + (is_leaf ? 0 : parts.size()));
    BoxNode node{};
    node.first = is_leaf ? -1 : static_cast<std::int32_t>(first);
    node.lanes = (1U << parts.size()) - 1;
    FloatBox whole = kNothing;
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      FloatBox box = kNothing;
      if (lane < parts.size() && is_leaf) {
        node.box[lane] = order[parts[lane][0]];
        box = boxes.box(node.box[lane]);
      } else if (lane < parts.size()) {
        box = make(first + lane, parts[lane]);
      }
      for (int axis = 0; axis < 3; ++axis) {
        node.side[axis][0][lane / 8][lane % 8] = box.min[axis];
        node.side[axis][1][lane / 8][lane % 8] = box.max[axis];
        whole.min[axis] = std::min(whole.min[axis], box.min[axis]);
        whole.max[axis] = std::max(whole.max[axis], box.max[axis]);
      }
    }
    nodes[index] = node;
    return whole;
  }
};
}  // namespace

std::vector<BoxNode> box_tree(const std::vector<Box>& boxes) {
  return std::move(Builder<SolidBoxes>(boxes).nodes);
}

std::vector<BoxNode> box_tree(const CellBoxes& boxes) {
  return std::move(Builder<BoxesOfCells>(boxes).nodes);
}
}  // namespace altiplan::kit
