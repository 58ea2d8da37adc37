// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace altiplan::cover {

using Point2 = Eigen::Vector2d;
using Ring2 = std::vector<Point2>;

/// A polygon with islands, in metres. Rings of either orientation, not closed by a repeated point.
class Area {
 public:
  Area(Ring2 outline, std::vector<Ring2> islands);

  const Ring2& outline() const { return rings_[0]; }
  /// The outline, then the islands.
  const std::vector<Ring2>& rings() const { return rings_; }
  double square_metres() const;
  const Point2& min() const { return boxes_[0].first; }
  const Point2& max() const { return boxes_[0].second; }
  bool contains(const Point2& p) const;
  /// True if it lies beyond the outline, not touching it.
  bool is_outside(const Point2& p) const;
  /// The nearest point of the outline.
  Point2 nearest(const Point2& p) const;
  /// True if the leg a–b stays inside, to 1e-7 m; it may touch.
  bool sees(const Point2& a, const Point2& b) const;
  /// The parts of the line y = `y` inside, from west to east.
  std::vector<std::pair<double, double>> along_row(double y) const;
  /// Turned about the origin, counter-clockwise.
  Area turned(double angle) const;

 private:
  std::vector<Ring2> rings_;
  std::vector<std::pair<Point2, Point2>> boxes_;  ///< of each ring: lower and upper corner
  bool is_convex_ = false;                        ///< the outline
};

Point2 turned(const Point2& p, double angle);
}  // namespace altiplan::cover
