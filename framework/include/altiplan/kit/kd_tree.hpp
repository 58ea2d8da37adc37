// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan::kit {

/// Points in space under their numbers 0, 1, 2 …, as inserted. New points wait in a list that is
/// searched whole; when they are as many as those in the tree, the tree is built anew, balanced.
class ALTIPLAN_API KdTree {
 public:
  static constexpr std::size_t kNone = ~std::size_t{0};

  void clear();
  void reserve(std::size_t count);
  std::size_t size() const { return points_.size(); }
  const Vec3& point(std::size_t number) const { return points_[number]; }
  /// Returns the point's number.
  std::size_t insert(const Vec3& p);
  /// The point nearest to p, the smallest number among equals; kNone in an empty tree.
  std::size_t nearest(const Vec3& p) const;
  /// Numbers of the points at most `radius` away, ascending. `found` is emptied first.
  void within(const Vec3& p, double radius, std::vector<std::size_t>& found) const;

 private:
  /// The range of order_ splits at its middle, on the axis stored for that middle.
  void build(std::size_t begin, std::size_t end);
  template <class Visit>
  void search(std::size_t begin, std::size_t end, const Vec3& p, Visit& visit) const;

  static constexpr std::size_t kLeaf = 8;    ///< points that are not split further
  static constexpr std::size_t kFirst = 64;  ///< points before the first tree

  std::vector<Vec3> points_;
  std::vector<std::uint32_t> order_;  ///< numbers of the points in the tree
  std::vector<std::uint8_t> axis_;    ///< one entry per entry of order_
};
}  // namespace altiplan::kit
