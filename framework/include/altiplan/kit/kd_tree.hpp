// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan::kit {

/// Points in space under their numbers 0, 1, 2 …, as inserted; a number is never used again. All
/// queries are exact and see the points that are in the tree; the smallest number among equals.
/// New points wait in a list that is searched whole; when they are as many as those in the tree,
/// the tree is built anew, balanced.
class ALTIPLAN_API KdTree {
 public:
  static constexpr std::size_t kNone = ~std::size_t{0};

  void clear();
  void reserve(std::size_t count);
  /// Numbers given, those of erased points included.
  std::size_t size() const { return points_.size(); }
  const Vec3& point(std::size_t number) const { return points_[number]; }
  /// Returns the point's number.
  std::size_t insert(const Vec3& p);
  /// Takes the point out, which must be in; its number stays given.
  void erase(std::size_t number) { out_[number] = 1; }
  /// Puts an erased point back in.
  void restore(std::size_t number) { out_[number] = 0; }
  bool contains(std::size_t number) const { return out_[number] == 0; }
  /// The point nearest to p; kNone in an empty tree.
  std::size_t nearest(const Vec3& p) const;
  /// The point x with the least p_weight |x − p| + q_weight |x − q|, weights >= 0; kNone in an
  /// empty tree.
  std::size_t least_sum(const Vec3& p, double p_weight, const Vec3& q, double q_weight) const;
  /// Numbers of the points at most `radius` away, ascending. `found` is emptied first.
  void within(const Vec3& p, double radius, std::vector<std::size_t>& found) const;
  /// Numbers of the points in the closed box, ascending. `found` is emptied first.
  void within(const Box& box, std::vector<std::size_t>& found) const;

 private:
  /// The range of order_ splits at its middle, on the axis stored for that middle.
  void build(std::size_t begin, std::size_t end);
  template <class Visit>
  void search(std::size_t begin, std::size_t end, const Vec3& p, Visit& visit) const;

  static constexpr std::size_t kLeaf = 8;    ///< points that are not split further
  static constexpr std::size_t kFirst = 64;  ///< points before the first tree

  std::vector<Vec3> points_;
  std::vector<std::uint8_t> out_;     ///< one entry per point
  std::vector<std::uint32_t> order_;  ///< numbers of the points in the tree
  std::vector<std::uint8_t> axis_;    ///< one entry per entry of order_
};
}  // namespace altiplan::kit
