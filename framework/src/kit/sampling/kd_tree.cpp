// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/sampling/kd_tree.hpp"

#include <algorithm>
#include <array>

#include "../../multiversion.hpp"
#include "kd_search.hpp"

namespace altiplan::kit {
namespace {

using namespace kd;

constexpr double kFar = 1e150;  // x of a leaf's unused slots

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

// All slots unused: far away and without a number.
void make_empty(Leaf& leaf) {
  leaf.count = 0;
  std::fill_n(leaf.at[0], Leaf::kMax, kFar);
  std::fill_n(leaf.number, Leaf::kMax, ~std::uint32_t{0});
}

std::uint32_t lane_with(const Branch& branch, std::uint32_t part) {
  return std::uint32_t(std::find(branch.part, branch.part + branch.count, part) - branch.part);
}

// True if the box of a part, extended to the point, would overlap another part's.
inline bool would_meet(const Branch& branch, int lane, const Vec3& p) {
  FourBits meets[2] = {~FourBits{}, ~FourBits{}};
  for (int axis = 0; axis < 3; ++axis) {
    const double low = std::min(branch.side[axis][0][lane], p[axis]);
    const double high = std::max(branch.side[axis][1][lane], p[axis]);
    for (int half = 0; half < 2; ++half) {
      meets[half] &= four(&branch.side[axis][0][4 * half]) <= high;
      meets[half] &= four(&branch.side[axis][1][4 * half]) >= low;
    }
  }
  constexpr FourBits kLane{0, 1, 2, 3};
  FourBits others = meets[0] & (kLane < std::int64_t(branch.count)) & (kLane != lane);
  others |= meets[1] & (kLane + 4 < std::int64_t(branch.count)) & (kLane + 4 != lane);
  return (others[0] | others[1] | others[2] | others[3]) != 0;
}

// The nearest part whose box can be extended to the point without overlapping another's, simply the
// nearest if there is none: overlapping parts cost every query.
inline int lane_for(const Branch& branch, const Vec3& p) {
  Keys keys;
  distance_keys(branch, p, keys);
  const double nearest = min_of(keys);
  if (nearest <= limit_of(0)) {
    return lane_in(nearest);
  }
  for (double key = nearest; key < kNoLimit; key = min_of(keys)) {
    const int lane = lane_in(key);
    if (!would_meet(branch, lane, p)) {
      return lane;
    }
    keys[lane] = kBeyond;
  }
  return lane_in(nearest);
}

// Extends the boxes on the path to include the point.
ALTIPLAN_CLONES std::uint32_t way_to_leaf(Branch* branches, std::uint32_t root,
                                          std::uint32_t height, const Vec3& p) {
  std::uint32_t part = root;
  for (std::uint32_t level = height; level > 0; --level) {
    Branch& branch = branches[part];
    const int lane = lane_for(branch, p);
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

void KdTree::restore(std::size_t number) {
  if (!contains(number)) {
    put(std::uint32_t(number));
  }
}

void KdTree::put(std::uint32_t number) {
  if (root_ == kOut) {
    root_ = new_leaf();
    leaves_[root_].above = kOut;
  }
  const Vec3& p = points_[number];
  const std::uint32_t index = way_to_leaf(branches_.data(), root_, height_, p);
  Leaf& leaf = leaves_[index];
  if (leaf.count == Leaf::kMax) {
    halve(index, number);
  } else {
    append(leaf, p, number);
    leaf_of_[number] = index;
  }
}

/// The leaf is full: half of its points, the new one included, move to a new leaf, beyond the
/// median along the longest side of their box.
void KdTree::halve(std::uint32_t leaf, std::uint32_t number) {
  struct Entry {
    Vec3 p;
    std::uint32_t number;
  };
  const std::uint32_t added = new_leaf();
  Leaf& low = leaves_[leaf];
  Leaf& high = leaves_[added];
  std::array<Entry, Leaf::kMax + 1> all;
  for (std::uint32_t slot = 0; slot < Leaf::kMax; ++slot) {
    all[slot] = {{low.at[0][slot], low.at[1][slot], low.at[2][slot]}, low.number[slot]};
  }
  all.back() = {points_[number], number};
  const Box box = box_of(low).with(points_[number]);
  int axis = 0;
  (box.max - box.min).maxCoeff(&axis);
  const auto middle = all.begin() + all.size() / 2;
  std::nth_element(all.begin(), middle, all.end(), [&](const Entry& a, const Entry& b) {
    return a.p[axis] != b.p[axis] ? a.p[axis] < b.p[axis] : a.number < b.number;
  });
  leaf_of_[number] = leaf;
  make_empty(low);
  for (auto entry = all.begin(); entry != middle; ++entry) {
    append(low, entry->p, entry->number);
  }
  for (auto entry = middle; entry != all.end(); ++entry) {
    append(high, entry->p, entry->number);
    leaf_of_[entry->number] = added;
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
  set_part(branch, lane_with(branch, part.index), part.box, part.index);
  if (branch.count == Branch::kMax) {
    halve(level, above, added);
  } else {
    set_part(branch, branch.count++, added.box, added.index);
    set_above(level, added.index, above);
  }
}

/// The branch is full: some of its parts, the new one included, move to a new branch, at the split
/// with the least overlap of the two boxes and the shortest sides.
void KdTree::halve(std::uint32_t level, std::uint32_t branch, const Part& added) {
  std::array<Part, kParts> all;
  for (std::uint32_t lane = 0; lane < Branch::kMax; ++lane) {
    all[lane] = {box_of_part(branches_[branch], lane), branches_[branch].part[lane]};
  }
  all.back() = added;
  std::array<Part, kParts> best{};
  std::size_t stay = 0;
  double minimum = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    std::sort(all.begin(), all.end(), [&](const Part& a, const Part& b) {
      const double x = a.box.min[axis] + a.box.max[axis];
      const double y = b.box.min[axis] + b.box.max[axis];
      return x != y ? x < y : a.index < b.index;
    });
    const auto [badness, count] = best_cut(all);
    if (badness < minimum) {
      minimum = badness;
      best = all;
      stay = count;
    }
  }
  const std::uint32_t other = new_branch();
  Branch& low = branches_[branch];
  Branch& high = branches_[other];
  low.count = 0;
  for (std::size_t i = 0; i < kParts; ++i) {
    Branch& to = i < stay ? low : high;
    set_part(to, to.count++, best[i].box, best[i].index);
    set_above(level, best[i].index, i < stay ? branch : other);
  }
  replace(level + 1, low.above, {box_of(low), branch}, {box_of(high), other});
}

/// Number of parts, in that order, before the best split, and its cost in metres; the more even
/// split among equals.
std::pair<double, std::size_t> KdTree::best_cut(const std::array<Part, kParts>& parts) {
  constexpr double kOverlap = 1000;  // overlapping parts cost every query
  constexpr double kUneven = 0.5;    // few parts in a branch cost another level
  std::array<Box, kParts> first;     // around the preceding parts
  std::array<Box, kParts> last;      // around this and the following parts
  Box box = Box::empty();
  for (std::size_t i = 0; i < kParts; ++i) {
    first[i] = box;
    box = box.united(parts[i].box);
  }
  const double all_sides = (box.max - box.min).sum();
  box = Box::empty();
  for (std::size_t i = kParts; i-- > 0;) {
    box = box.united(parts[i].box);
    last[i] = box;
  }
  std::pair<double, std::size_t> best{kInfinity, 0};
  for (const std::size_t i : {4, 5, 3, 6, 2, 7}) {
    const Box common = first[i].intersected(last[i]);
    const double overlap = std::max((common.max - common.min).minCoeff(), 0.0);
    const Vec3 sides = first[i].max - first[i].min + last[i].max - last[i].min;
    const bool is_uneven = i == 2 || i == 7;
    const double badness =
        sides.sum() + kOverlap * overlap + (is_uneven ? kUneven * all_sides : 0.0);
    if (badness < best.first) {
      best = {badness, i};
    }
  }
  return best;
}

void KdTree::erase(std::size_t number) {
  if (!contains(number)) {
    return;
  }
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
  leaf.at[0][last] = kFar;
  leaf.number[last] = kOut;
  if (leaf.count > 0) {
    close_boxes(leaf.above, index, box_of(leaf));
  } else {
    free_leaves_.push_back(index);
    take_part(leaf.above, index);
  }
}

/// Removes the part, which is empty, and the branches that have no other.
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
  set_part(branch, lane_with(branch, part), box_of_part(branch, last), branch.part[last]);
  close_boxes(branch.above, above, box_of(branch));
  while (height_ > 0 && branches_[root_].count == 1) {
    free_branches_.push_back(root_);
    root_ = branches_[root_].part[0];
    --height_;
    set_above(height_ + 1, root_, kOut);
  }
}

/// Sets the box of the part, and updates those above it.
void KdTree::close_boxes(std::uint32_t above, std::uint32_t part, Box box) {
  while (above != kOut) {
    Branch& branch = branches_[above];
    const std::uint32_t lane = lane_with(branch, part);
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
    make_empty(leaves_[leaf]);
    return leaf;
  }
  if (leaves_used_ == leaves_.size()) {
    leaves_.emplace_back();
  }
  make_empty(leaves_[leaves_used_]);
  return leaves_used_++;
}

std::uint32_t KdTree::new_branch() {
  if (!free_branches_.empty()) {
    const std::uint32_t branch = free_branches_.back();
    free_branches_.pop_back();
    branches_[branch].count = 0;
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
}  // namespace altiplan::kit
