// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "area.hpp"

namespace altiplan::cover {

/// Seconds of straight legs, each from rest to rest.
struct LegTime {
  double speed_mps = 1;
  double acceleration_mps2 = 1;  ///< may be infinite
  double of(double length_m) const;
  double between(const Point2& a, const Point2& b) const { return of((b - a).norm()); }
};

/// Fastest joins between points of an area, bending at corners of its rings.
class Joins {
 public:
  Joins(const Area& area, const LegTime& time, Ring2 points);

  std::size_t size() const { return points_.size(); }
  const Point2& point(int i) const { return points_[std::size_t(i)]; }
  double time(int i, int j) const { return times_[at(i, j)]; }
  /// The corners between the points; none where one sees the other.
  Ring2 corners(int i, int j) const;

 private:
  std::size_t at(int i, int j) const { return std::size_t(i) * points_.size() + std::size_t(j); }
  void find_corners(const Area& area);
  void join_corners(const Area& area, const LegTime& time);

  Ring2 points_;
  Ring2 corners_;
  std::vector<double> between_corners_;
  std::vector<int> next_;          ///< corner after the first on the way between two
  std::vector<double> to_corner_;  ///< by point and corner: along sight; infinite without it
  std::vector<double> times_;
  std::vector<int> last_;   ///< by pair: the last corner; -1: in sight
  std::vector<int> first_;  ///< by point and corner: the first corner on the way
};
}  // namespace altiplan::cover
