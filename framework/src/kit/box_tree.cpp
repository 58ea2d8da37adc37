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

constexpr float kMost = std::numeric_limits<float>::max();
constexpr FloatBox kNothing{{kMost, kMost, kMost}, {-kMost, -kMost, -kMost}};

FloatBox grown(const Box& box) {
  double most = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {box.min[axis], box.max[axis]}) {
      most = std::abs(side) <= kTreeReach ? std::max(most, std::abs(side)) : most;
    }
  }
  FloatBox result{};
  for (int axis = 0; axis < 3; ++axis) {
    const double min = box.min[axis] - kTreeGrowth * most;
    const double max = box.max[axis] + kTreeGrowth * most;
    result.min[axis] =
        min >= -kTreeReach ? rounded_down(std::min(min, kTreeReach)) : -float(kInfinity);
    result.max[axis] =
        max <= kTreeReach ? rounded_up(std::max(max, -kTreeReach)) : float(kInfinity);
  }
  return result;
}

struct Builder {
  const std::vector<FloatBox>& boxes;
  std::vector<std::int32_t> order;  // indices of boxes, the range of a node together
  std::vector<BoxNode> nodes;

  using Range = std::array<std::size_t, 2>;

  float twice_middle(std::int32_t index, int axis) const {
    constexpr float kFar = 2e15F;  // the sum of two endless sides stays a number
    const FloatBox& box = boxes[std::size_t(index)];
    return std::clamp(box.min[axis], -kFar, kFar) + std::clamp(box.max[axis], -kFar, kFar);
  }

  int longest_axis(const Range& range) const {
    int longest = 0;
    float most = -1;
    for (int axis = 0; axis < 3; ++axis) {
      float low = twice_middle(order[range[0]], axis);
      float high = low;
      for (std::size_t n = range[0]; n < range[1]; ++n) {
        low = std::min(low, twice_middle(order[n], axis));
        high = std::max(high, twice_middle(order[n], axis));
      }
      if (high - low > most) {
        most = high - low;
        longest = axis;
      }
    }
    return longest;
  }

  // Cuts the range into that many parts of about equal size.
  void cut(const Range& range, std::size_t parts, std::vector<Range>& into) {
    if (parts == 1) {
      into.push_back(range);
      return;
    }
    const std::size_t first = parts / 2;
    const std::size_t middle = range[0] + (range[1] - range[0]) * first / parts;
    const int axis = longest_axis(range);
    const auto at = [&](std::size_t n) { return order.begin() + std::ptrdiff_t(n); };
    std::nth_element(at(range[0]), at(middle), at(range[1]), [&](auto one, auto other) {
      return twice_middle(one, axis) < twice_middle(other, axis);
    });
    cut({range[0], middle}, first, into);
    cut({middle, range[1]}, parts - first, into);
  }

  // Makes the node of a range, and all below it; gives its box.
  FloatBox make(std::size_t index, const Range& range) {
    constexpr std::size_t kWidth = BoxNode::kWidth;
    const std::size_t count = range[1] - range[0];
    const bool is_leaf = count <= kWidth;
    std::vector<Range> parts;
    std::size_t full = 1;  // boxes below a child where all is full
    while (full * kWidth < count) {
      full *= kWidth;
    }
    cut(range, (count + full - 1) / full, parts);
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
        box = boxes[std::size_t(node.box[lane])];
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
  std::vector<FloatBox> floats(boxes.size());
  std::transform(boxes.begin(), boxes.end(), floats.begin(), grown);
  Builder builder{floats, std::vector<std::int32_t>(boxes.size()), {}};
  std::iota(builder.order.begin(), builder.order.end(), 0);
  if (!boxes.empty()) {
    builder.nodes.resize(1);
    builder.make(0, {0, boxes.size()});
  }
  builder.nodes.shrink_to_fit();
  return std::move(builder.nodes);
}
}  // namespace altiplan::kit
