// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/kd_tree.hpp"

#include <algorithm>
#include <array>

#include "../multiversion.hpp"
#include "kd_search.hpp"

namespace altiplan::kit {
namespace {

using Leaf = KdTree::Leaf;
using Branch = KdTree::Branch;

Box box_of(const Leaf& leaf) {
  Box box = Box::empty();
  for (int axis = 0; axis < 3; ++axis) {
    for (std::uint32_t slot = 0; slot < leaf.count; ++slot) {
      box.min[axis] = std::min(box.min[axis], leaf.at[axis][slot]);
      box.max[axis] = std::max(box.max[axis], leaf.at[axis][slot]);
    }
  }
  return box;
}

Box box_of(const Branch& branch) {
  Box box = Box::empty();
  for (int axis = 0; axis < 3; ++axis) {
    for (std::uint32_t lane = 0; lane < branch.count; ++lane) {
      box.min[axis] = std::min(box.min[axis], branch.side[axis][0][lane]);
      box.max[axis] = std::max(box.max[axis], branch.side[axis][1][lane]);
    }
  }
  return box;
}

Box box_of_part(const Branch& branch, std::uint32_t lane) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = branch.side[axis][0][lane];
    box.max[axis] = branch.side[axis][1][lane];
  }
  return box;
}

void set_part(Branch& branch, std::uint32_t lane, const Box& box, std::uint32_t index) {
  for (int axis = 0; axis < 3; ++axis) {
    branch.side[axis][0][lane] = box.min[axis];
    branch.side[axis][1][lane] = box.max[axis];
  }
  branch.part[lane] = index;
}

void append(Leaf& leaf, const Vec3& p, std::uint32_t number) {
  for (int axis = 0; axis < 3; ++axis) {
    leaf.at[axis][leaf.count] = p[axis];
  }
  leaf.number[leaf.count++] = number;
}

std::uint32_t lane_of(const Branch& branch, std::uint32_t part) {
  return std::uint32_t(std::find(branch.part, branch.part + branch.count, part) - branch.part);
}

// The leaf that lies nearest, step by step; the boxes on the way reach the point from now on.
ALTIPLAN_CLONES std::uint32_t way_to_leaf(Branch* branches, std::uint32_t root,
                                          std::uint32_t height, const Vec3& p) {
  std::uint32_t part = root;
  for (std::uint32_t level = height; level > 0; --level) {
    Branch& branch = branches[part];
    Keys keys;
    distance_keys(branch, p, keys);
    const int lane = kit::lane_of(least_of(keys));
    for (int axis = 0; axis < 3; ++axis) {
      double& low = branch.side[axis][0][lane];
      double& high = branch.side[axis][1][lane];
      low = std::min(low, p[axis]);
      high = std::max(high, p[axis]);
    }
    part = branch.part[lane];
  }
  return part;
}

struct Nearest {
  const Vec3& p;
  Best best{};
  double limit() const { return limit_of(std::min(best.least, kNoLimit)); }
  void keys_of(const Branch& branch, Keys& keys) const { distance_keys(branch, p, keys); }
  void see(const Leaf& leaf) {
    Four square[4];
    for (int quarter = 0; quarter < 4; ++quarter) {
      squares(leaf, quarter, p, square[quarter]);
    }
    best.see(leaf, square);
  }
};

ALTIPLAN_CLONES std::uint32_t find_nearest(const Leaf* leaves, const Branch* branches,
                                           std::uint32_t root, std::uint32_t height,
                                           const Vec3& p) {
  Nearest query{p};
  search(leaves, branches, root, height, query);
  return query.best.number;
}

// F(x) = p_weight |x − p| + q_weight |x − q| is convex: over a box it is at least what its tangent
// at any c of the box says, that is F(c) and, for each axis, the lesser of the gradient times the
// ways from c to both sides. The nearer c is to where F is least in the box, the better; that is
// about where the box is nearest to the segment p–q. Rounding errs by less than `slack`.
struct LeastSum {
  const Vec3& p;
  double p_weight;
  const Vec3& q;
  double q_weight;
  Vec3 way = q - p;
  double inverse = 1 / std::max(way.squaredNorm(), 1e-200);
  double slack = 0;
  Best best{};

  double limit() const { return limit_of(std::min(best.least + slack, kNoLimit)); }

  void keys_of(const Branch& branch, Keys& keys) const {
    for (int half = 0; half < 2; ++half) {
      bound(branch, half, keys.half[half]);
    }
    make_keys(branch.count, keys);
  }

  void bound(const Branch& branch, int half, Four& least) const {
    Four t{};
    for (int axis = 0; axis < 3; ++axis) {
      const Four& low = four(&branch.side[axis][0][4 * half]);
      const Four& high = four(&branch.side[axis][1][4 * half]);
      t += (0.5 * (low + high) - p[axis]) * way[axis];
    }
    t *= inverse;
    t = t > 0.0 ? t : Four{};
    t = t < 1.0 ? t : 1.0 + Four{};
    Four from_p[3];
    Four from_q[3];
    Four p_distance{};
    Four q_distance{};
    for (int axis = 0; axis < 3; ++axis) {
      const Four& low = four(&branch.side[axis][0][4 * half]);
      const Four& high = four(&branch.side[axis][1][4 * half]);
      Four c = p[axis] + t * way[axis];
      c = c > low ? c : low;
      c = c < high ? c : high;
      from_p[axis] = c - p[axis];
      from_q[axis] = c - q[axis];
      p_distance += from_p[axis] * from_p[axis];
      q_distance += from_q[axis] * from_q[axis];
    }
    take_roots(p_distance);
    take_roots(q_distance);
    constexpr double kNoDistance = 1e-200;
    const Four p_pull = p_weight / (p_distance > kNoDistance ? p_distance : kNoDistance + Four{});
    const Four q_pull = q_weight / (q_distance > kNoDistance ? q_distance : kNoDistance + Four{});
    least = p_weight * p_distance + q_weight * q_distance;
    for (int axis = 0; axis < 3; ++axis) {
      const Four& low = four(&branch.side[axis][0][4 * half]);
      const Four& high = four(&branch.side[axis][1][4 * half]);
      const Four gradient = p_pull * from_p[axis] + q_pull * from_q[axis];
      const Four c = from_p[axis] + p[axis];
      const Four down = gradient * (low - c);
      const Four up = gradient * (high - c);
      least += down < up ? down : up;
    }
    least = least > 0.0 ? least : Four{};
  }

  void see(const Leaf& leaf) {
    Four sum[4];
    for (int quarter = 0; quarter < 4; ++quarter) {
      Four p_distance;
      Four q_distance;
      squares(leaf, quarter, p, p_distance);
      squares(leaf, quarter, q, q_distance);
      take_roots(p_distance);
      take_roots(q_distance);
      sum[quarter] = p_weight * p_distance + q_weight * q_distance;
    }
    best.see(leaf, sum);
  }
};

ALTIPLAN_CLONES std::uint32_t find_least_sum(const Leaf* leaves, const Branch* branches,
                                             std::uint32_t root, std::uint32_t height,
                                             LeastSum& query) {
  search(leaves, branches, root, height, query);
  return query.best.number;
}

struct WithinBall {
  const Vec3& p;
  double square;
  std::vector<std::size_t>& found;
  double limit() const { return limit_of(square); }
  void keys_of(const Branch& branch, Keys& keys) const { distance_keys(branch, p, keys); }
  void see(const Leaf& leaf) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      Four here;
      squares(leaf, quarter, p, here);
      for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t slot = 4 * std::uint32_t(quarter) + i;
        if (slot < leaf.count && here[i] <= square) {
          found.push_back(leaf.number[slot]);
        }
      }
    }
  }
};

struct WithinBox {
  const Box& box;
  std::vector<std::size_t>& found;
  double limit() const { return limit_of(0); }
  void keys_of(const Branch& branch, Keys& keys) const {
    for (int half = 0; half < 2; ++half) {
      Four outside{};
      for (int axis = 0; axis < 3; ++axis) {
        const Four& low = four(&branch.side[axis][0][4 * half]);
        const Four& high = four(&branch.side[axis][1][4 * half]);
        outside = low > box.max[axis] || high < box.min[axis] ? 1.0 + Four{} : outside;
      }
      keys.half[half] = outside;
    }
    make_keys(branch.count, keys);
  }
  void see(const Leaf& leaf) {
    for (std::uint32_t slot = 0; slot < leaf.count; ++slot) {
      if (box.contains({leaf.at[0][slot], leaf.at[1][slot], leaf.at[2][slot]})) {
        found.push_back(leaf.number[slot]);
      }
    }
  }
};
}  // namespace

void KdTree::clear() {
  points_.clear();
  leaf_of_.clear();
  leaves_used_ = 0;
  branches_used_ = 0;
  free_leaves_.clear();
  free_branches_.clear();
  root_ = kOut;
  height_ = 0;
}

void KdTree::reserve(std::size_t count) {
  points_.reserve(count);
  leaf_of_.reserve(count);
  leaves_.reserve(count / 10);
  branches_.reserve(count / 50);
}

std::size_t KdTree::insert(const Vec3& p) {
  const auto number = std::uint32_t(points_.size());
  points_.push_back(p);
  leaf_of_.push_back(kOut);
  put(number);
  return number;
}

void KdTree::restore(std::size_t number) { put(std::uint32_t(number)); }

void KdTree::put(std::uint32_t number) {
  if (root_ == kOut) {
    root_ = new_leaf();
    leaves_[root_].above = kOut;
  }
  const Vec3& p = points_[number];
  const std::uint32_t index = way_to_leaf(branches_.data(), root_, height_, p);
  Leaf& leaf = leaves_[index];
  if (leaf.count == Leaf::kMost) {
    halve(index, number);
  } else {
    append(leaf, p, number);
    leaf_of_[number] = index;
  }
}

/// The leaf is full, and the point is one more: half of them move to a new leaf, beyond the median
/// along the longest side of their box.
void KdTree::halve(std::uint32_t leaf, std::uint32_t number) {
  const std::uint32_t added = new_leaf();
  Leaf& low = leaves_[leaf];
  Leaf& high = leaves_[added];
  std::array<std::uint32_t, Leaf::kMost + 1> all;
  std::copy(low.number, low.number + Leaf::kMost, all.begin());
  all.back() = number;
  const Box box = box_of(low).with(points_[number]);
  int axis = 0;
  (box.max - box.min).maxCoeff(&axis);
  const auto middle = all.begin() + all.size() / 2;
  std::nth_element(all.begin(), middle, all.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double x = points_[a][axis];
    const double y = points_[b][axis];
    return x != y ? x < y : a < b;
  });
  low.count = 0;
  for (auto n = all.begin(); n != all.end(); ++n) {
    append(n < middle ? low : high, points_[*n], *n);
    leaf_of_[*n] = n < middle ? leaf : added;
  }
  replace(1, low.above, {box_of(low), leaf}, {box_of(high), added});
}

/// A part, below `level`, has become two.
void KdTree::replace(std::uint32_t level, std::uint32_t above, const Part& part,
                     const Part& added) {
  if (above == kOut) {
    above = new_branch();
    Branch& root = branches_[above];
    root.above = kOut;
    root.count = 1;
    set_part(root, 0, part.box, part.index);
    set_above(level, part.index, above);
    root_ = above;
    height_ = level;
  }
  Branch& branch = branches_[above];
  set_part(branch, lane_of(branch, part.index), part.box, part.index);
  if (branch.count == Branch::kMost) {
    halve(level, above, added);
  } else {
    set_part(branch, branch.count++, added.box, added.index);
    set_above(level, added.index, above);
  }
}

/// The branch is full, and the part is one more: where the two boxes have the least sides, some of
/// them move to a new branch.
void KdTree::halve(std::uint32_t level, std::uint32_t branch, const Part& added) {
  constexpr std::size_t kAll = Branch::kMost + 1;
  constexpr std::size_t kFewest = 3;
  std::array<Part, kAll> all;
  for (std::uint32_t lane = 0; lane < Branch::kMost; ++lane) {
    all[lane] = {box_of_part(branches_[branch], lane), branches_[branch].part[lane]};
  }
  all.back() = added;

  double least = kInfinity;
  std::array<std::uint8_t, kAll> best{};
  std::size_t best_low = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<std::uint8_t, kAll> order;
    for (std::size_t i = 0; i < kAll; ++i) {
      order[i] = std::uint8_t(i);
    }
    std::sort(order.begin(), order.end(), [&](std::uint8_t a, std::uint8_t b) {
      const double x = all[a].box.min[axis] + all[a].box.max[axis];
      const double y = all[b].box.min[axis] + all[b].box.max[axis];
      return x != y ? x < y : a < b;
    });
    std::array<double, kAll> low_sides;  // of the box around the first ones
    Box box = Box::empty();
    for (std::size_t i = 0; i < kAll; ++i) {
      low_sides[i] = box.is_empty() ? 0 : (box.max - box.min).sum();
      box = box.united(all[order[i]].box);
    }
    box = Box::empty();
    for (std::size_t i = kAll - 1; i >= kFewest; --i) {
      box = box.united(all[order[i]].box);
      const double sides = low_sides[i] + (box.max - box.min).sum();
      if (i <= kAll - kFewest && sides < least) {
        least = sides;
        best = order;
        best_low = i;
      }
    }
  }

  const std::uint32_t other = new_branch();
  Branch& low = branches_[branch];
  Branch& high = branches_[other];
  low.count = 0;
  for (std::size_t i = 0; i < kAll; ++i) {
    const Part& part = all[best[i]];
    Branch& to = i < best_low ? low : high;
    set_part(to, to.count++, part.box, part.index);
    set_above(level, part.index, i < best_low ? branch : other);
  }
  replace(level + 1, low.above, {box_of(low), branch}, {box_of(high), other});
}

void KdTree::erase(std::size_t number) {
  const std::uint32_t index = leaf_of_[number];
  leaf_of_[number] = kOut;
  Leaf& leaf = leaves_[index];
  const std::uint32_t last = --leaf.count;
  const auto slot = std::uint32_t(
      std::find(leaf.number, leaf.number + last, std::uint32_t(number)) - leaf.number);
  for (int axis = 0; axis < 3; ++axis) {
    leaf.at[axis][slot] = leaf.at[axis][last];
  }
  leaf.number[slot] = leaf.number[last];
  if (leaf.count > 0) {
    close_boxes(leaf.above, index, box_of(leaf));
  } else {
    free_leaves_.push_back(index);
    take_part(leaf.above, index);
  }
}

/// The part, which is empty, goes, and so do the branches that have no other.
void KdTree::take_part(std::uint32_t above, std::uint32_t part) {
  while (above != kOut && branches_[above].count == 1) {
    free_branches_.push_back(above);
    part = above;
    above = branches_[above].above;
  }
  if (above == kOut) {
    root_ = kOut;
    height_ = 0;
    return;
  }
  Branch& branch = branches_[above];
  const std::uint32_t last = --branch.count;
  set_part(branch, lane_of(branch, part), box_of_part(branch, last), branch.part[last]);
  close_boxes(branch.above, above, box_of(branch));
  while (height_ > 0 && branches_[root_].count == 1) {
    free_branches_.push_back(root_);
    root_ = branches_[root_].part[0];
    --height_;
    set_above(height_ + 1, root_, kOut);
  }
}

/// The part has the box from now on, and those above it what is left to them.
void KdTree::close_boxes(std::uint32_t above, std::uint32_t part, Box box) {
  while (above != kOut) {
    Branch& branch = branches_[above];
    const std::uint32_t lane = lane_of(branch, part);
    const Box before = box_of_part(branch, lane);
    if (before.min == box.min && before.max == box.max) {
      return;
    }
    set_part(branch, lane, box, part);
    box = box_of(branch);
    part = above;
    above = branch.above;
  }
}

std::uint32_t KdTree::new_leaf() {
  if (!free_leaves_.empty()) {
    const std::uint32_t leaf = free_leaves_.back();
    free_leaves_.pop_back();
    return leaf;
  }
  if (leaves_used_ == leaves_.size()) {
    leaves_.emplace_back();
  }
  leaves_[leaves_used_].count = 0;
  return leaves_used_++;
}

std::uint32_t KdTree::new_branch() {
  if (!free_branches_.empty()) {
    const std::uint32_t branch = free_branches_.back();
    free_branches_.pop_back();
    return branch;
  }
  if (branches_used_ == branches_.size()) {
    branches_.emplace_back();
  }
  branches_[branches_used_].count = 0;
  return branches_used_++;
}

/// The part lies below that level.
void KdTree::set_above(std::uint32_t level, std::uint32_t part, std::uint32_t branch) {
  (level == 1 ? leaves_[part].above : branches_[part].above) = branch;
}

std::size_t KdTree::nearest(const Vec3& p) const {
  if (root_ == kOut) {
    return kNone;
  }
  return find_nearest(leaves_.data(), branches_.data(), root_, height_, p);
}

std::size_t KdTree::least_sum(const Vec3& p, double p_weight, const Vec3& q,
                              double q_weight) const {
  if (root_ == kOut) {
    return kNone;
  }
  LeastSum query{p, p_weight, q, q_weight};
  if (height_ > 0) {
    const Box all = box_of(branches_[root_]);
    const double farthest =
        (all.max - all.min).sum() + (p - all.min).cwiseAbs().sum() + (q - all.min).cwiseAbs().sum();
    query.slack = 1e-13 * (p_weight + q_weight) * farthest;
  }
  return find_least_sum(leaves_.data(), branches_.data(), root_, height_, query);
}

void KdTree::within(const Vec3& p, double radius, std::vector<std::size_t>& found) const {
  found.clear();
  if (root_ != kOut) {
    WithinBall query{p, radius * radius, found};
    search(leaves_.data(), branches_.data(), root_, height_, query);
    std::sort(found.begin(), found.end());
  }
}

void KdTree::within(const Box& box, std::vector<std::size_t>& found) const {
  found.clear();
  if (root_ != kOut) {
    WithinBox query{box, found};
    search(leaves_.data(), branches_.data(), root_, height_, query);
    std::sort(found.begin(), found.end());
  }
}
}  // namespace altiplan::kit
