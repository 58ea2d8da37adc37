// SPDX-License-Identifier: Apache-2.0
#include "layer_index.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "layer_answer.hpp"

namespace altiplan {
namespace {

constexpr int kLeaf = 4;

/// True if the leg meets the box.
bool meets(const Box& box, const Vec3& a, const Vec3& way) {
  double enter = 0;
  double leave = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0) {
      if (a[axis] < box.min[axis] || a[axis] > box.max[axis]) {
        return false;
      }
      continue;
    }
    const double one = (box.min[axis] - a[axis]) / way[axis];
    const double other = (box.max[axis] - a[axis]) / way[axis];
    enter = std::max(enter, std::min(one, other));
    leave = std::min(leave, std::max(one, other));
  }
  return enter <= leave;
}
}  // namespace

LayerIndex::LayerIndex(const std::vector<Layer>& layers) {
  std::vector<Box> boxes;
  for (std::size_t n = 0; n < layers.size(); ++n) {
    boxes.push_back(answer_of(layers[n], [](const Environment& asked) {
      const bool is_exact = asked.ground() == nullptr && asked.over_approximation() == 0;
      return is_exact ? asked.bounds() : Box();
    }));
    const bool is_bounded = boxes.back().is_bounded() && !boxes.back().is_empty();
    (is_bounded ? sorted_ : always_).push_back(int(n));
  }
  if (!sorted_.empty()) {
    nodes_.emplace_back();
    split(0, 0, int(sorted_.size()), boxes);
  }
}

void LayerIndex::split(int node, int begin, int end, const std::vector<Box>& boxes) {
  Box box = Box::empty();
  for (int n = begin; n < end; ++n) {
    box = box.united(boxes[std::size_t(sorted_[std::size_t(n)])]);
  }
  nodes_[std::size_t(node)] = {box, begin, end - begin};
  if (end - begin <= kLeaf) {
    return;
  }
  Eigen::Index axis = 0;
  (box.max - box.min).maxCoeff(&axis);
  const int middle = (begin + end) / 2;
  const auto centre = [&](int layer) {
    return boxes[std::size_t(layer)].min[axis] + boxes[std::size_t(layer)].max[axis];
  };
  std::nth_element(sorted_.begin() + begin, sorted_.begin() + middle, sorted_.begin() + end,
                   [&](int one, int other) { return centre(one) < centre(other); });
  const int first = int(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[std::size_t(node)].first = first;
  nodes_[std::size_t(node)].count = 0;
  split(first, begin, middle, boxes);
  split(first + 1, middle, end, boxes);
}

std::vector<int> LayerIndex::within(const Vec3& a, const Vec3& b, double reach) const {
  // Far more than the rounding of distances: a layer that is not found lies farther away.
  const double scale = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  const double grown = std::max(reach, 0.0) + 1e-3 + 1e-9 * scale;
  const Vec3 way = b - a;
  std::vector<int> found = always_;
  std::vector<int> open(nodes_.empty() ? 0 : 1, 0);
  while (!open.empty()) {
    const Node& node = nodes_[std::size_t(open.back())];
    open.pop_back();
    if (!meets(node.box.grown(grown), a, way)) {
      continue;
    }
    if (node.count == 0) {
      open.push_back(node.first);
      open.push_back(node.first + 1);
    } else {
      const auto first = sorted_.begin() + node.first;
      found.insert(found.end(), first, first + node.count);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}
}  // namespace altiplan
