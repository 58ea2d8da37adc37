// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "altiplan/swept_volume.hpp"
#include "triangles.hpp"

namespace altiplan::mesh {

/// Triangles in a tree of boxes; each query examines O(log n) of them where they are spread.
class Surface {
 public:
  explicit Surface(std::vector<Triangle> triangles);

  const std::vector<Triangle>& triangles() const { return triangles_; }
  const Box& bounds() const { return nodes_.front().box; }

  struct Nearest {
    Vec3 point;
    double distance;
    const Triangle* triangle;
  };
  Nearest nearest(const Vec3& p) const;
  /// True if some triangle is nearer to the leg, or the box, than that.
  bool leg_is_nearer(const Vec3& a, const Vec3& b, double distance) const;
  bool box_is_nearer(const Box& box, double distance) const;
  /// True if some triangle shares a point with the volume.
  bool meets(const SweptVolume& volume) const;
  /// The results of `add_meetings` for all triangles, ascending.
  std::vector<double> meetings(const Vec3& a, const Vec3& b, double distance) const;
  /// Winding number of the surface around p: 0 outside a closed one.
  ///
  /// The signed number of triangles above p. Each crosses the level of p's y in two of its edges,
  /// and is above or below p if the line between those crossings is. A shared edge gives exactly
  /// the same crossing in both its triangles, so a vertical through an edge or a corner counts
  /// once: no position is in doubt that is farther from the surface than rounding.
  int winding(const Vec3& p) const;

 private:
  struct Node {
    Box box = Box::empty();
    std::uint32_t first = 0;  ///< of its triangles
    std::uint32_t count = 0;
    std::uint32_t right = 0;  ///< index of its second child, the first is the next node; 0: a leaf
  };

  std::uint32_t build(std::uint32_t first, std::uint32_t count);
  void find_nearest(const Node& node, const Vec3& p, Nearest& best) const;
  /// Calls visit(triangle) below the nodes whose box enter(box) accepts, until it returns true.
  template <class Enter, class Visit>
  bool any(const Node& node, const Enter& enter, const Visit& visit) const;

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};
}  // namespace altiplan::mesh
