// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan::kit {

/// Points in 3-D with numbers 0, 1, 2 … in order of insertion; a number is never reused. All
/// queries are exact and see the points that are in the tree; the smallest number among equals.
/// Coordinates are finite and below 1e100.
///
/// Up to sixteen points share a leaf, up to eight parts of the tree a branch, which stores the
/// tight bounding box of each; few of these overlap. A full leaf or branch is split in two, and its
/// parent gets one part more, as in a B-tree: all leaves have the same depth, whatever the order of
/// the points, and nothing is ever rebuilt. insert, erase and restore take O(log n); a cleared tree
/// keeps its memory.
class ALTIPLAN_API KdTree {
 public:
  static constexpr std::size_t kNone = ~std::size_t{0};

  void clear();
  void reserve(std::size_t count);
  /// Number of points inserted, including erased ones.
  std::size_t size() const { return points_.size(); }
  const Vec3& point(std::size_t number) const { return points_[number]; }
  /// Returns the point's number.
  std::size_t insert(const Vec3& p);
  /// Removes the point if it is in the tree; its number stays assigned.
  void erase(std::size_t number);
  /// Puts the point back if it was erased.
  void restore(std::size_t number);
  bool contains(std::size_t number) const { return leaf_of_[number] != kOut; }
  /// The point nearest to p; kNone in an empty tree.
  std::size_t nearest(const Vec3& p) const;
  /// Numbers of the `count` points nearest to p, or of all if there are fewer, nearest first.
  /// `found` is emptied first.
  void nearest(const Vec3& p, std::size_t count, std::vector<std::size_t>& found) const;
  /// The point x with the minimum p_weight |x − p| + q_weight |x − q|, weights >= 0; kNone in an
  /// empty tree.
  std::size_t min_sum(const Vec3& p, double p_weight, const Vec3& q, double q_weight) const;
  /// Numbers of the points at most `radius` away, ascending. `found` is emptied first.
  void within(const Vec3& p, double radius, std::vector<std::size_t>& found) const;
  /// Numbers of the points in the closed box, ascending. `found` is emptied first.
  void within(const Box& box, std::vector<std::size_t>& found) const;
  /// Branches above each leaf: at most log2(n / 4) after n insertions and restorations, as a leaf
  /// takes eight more points before it is split again, a branch two more parts.
  std::size_t depth() const { return height_; }

  /// Points in structure-of-arrays form, for vector operations. Unused slots are far away, without
  /// a number.
  struct alignas(64) Leaf {
    static constexpr std::uint32_t kMax = 16;
    double at[3][kMax] = {};
    std::uint32_t number[kMax] = {};
    std::uint32_t above = 0;  ///< its branch; kOut for the root
    std::uint32_t count = 0;
  };
  /// Parts in structure-of-arrays form; the content of unused slots does not matter.
  struct alignas(64) Branch {
    static constexpr std::uint32_t kMax = 8;
    double side[3][2][kMax] = {};   ///< of the boxes: by axis, the lower and the upper one
    std::uint32_t part[kMax] = {};  ///< indices of leaves in the lowest branches, else of branches
    std::uint32_t above = 0;
    std::uint32_t count = 0;
  };

 private:
  static constexpr std::uint32_t kOut = ~std::uint32_t{0};

  struct Part {
    Box box;
    std::uint32_t index;
  };

  static constexpr std::size_t kParts = Branch::kMax + 1;

  void put(std::uint32_t number);
  void halve(std::uint32_t leaf, std::uint32_t number);
  void replace(std::uint32_t level, std::uint32_t above, const Part& part, const Part& added);
  void halve(std::uint32_t level, std::uint32_t branch, const Part& added);
  static std::pair<double, std::size_t> best_cut(const std::array<Part, kParts>& parts);
  void take_part(std::uint32_t above, std::uint32_t part);
  void close_boxes(std::uint32_t above, std::uint32_t part, Box box);
  std::uint32_t new_leaf();
  std::uint32_t new_branch();
  void set_above(std::uint32_t level, std::uint32_t part, std::uint32_t branch);

  std::vector<Vec3> points_;
  std::vector<std::uint32_t> leaf_of_;  ///< one entry per point; kOut for an erased one
  // Leaves in use come first, apart from free ones among them.
  std::vector<Leaf> leaves_;
  std::vector<Branch> branches_;
  std::uint32_t leaves_used_ = 0;
  std::uint32_t branches_used_ = 0;
  std::vector<std::uint32_t> free_leaves_;
  std::vector<std::uint32_t> free_branches_;
  std::uint32_t root_ = kOut;  ///< a leaf where height_ is 0; kOut for an empty tree
  std::uint32_t height_ = 0;
};
}  // namespace altiplan::kit
