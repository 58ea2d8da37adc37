// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "area.hpp"

namespace altiplan::cover {

struct Segment {
  Point2 a;
  Point2 b;
};

/// Squared distance of a point from a segment.
inline double squared_distance(const Point2& p, const Segment& segment) {
  const double wx = segment.b.x() - segment.a.x();
  const double wy = segment.b.y() - segment.a.y();
  const double px = p.x() - segment.a.x();
  const double py = p.y() - segment.a.y();
  const double square = wx * wx + wy * wy;
  double t = square > 0 ? (px * wx + py * wy) / square : 0;
  t = t < 0 ? 0 : t > 1 ? 1 : t;
  const double dx = px - t * wx;
  const double dy = py - t * wy;
  return dx * dx + dy * dy;
}

/// What legs cover of an area, by sample points, one in each square cell: of each how many legs
/// pass within half a strip of it. Samples lie at different places of their cells along rows and
/// columns, so that thin gaps along either are met as often as their area says.
class Swept {
 public:
  Swept(const Area& area, double half_width, double cell_m);

  void add(const Segment& leg);
  /// Legs in place of others, where nothing changes outside the box around `about`, grown by the
  /// half width.
  void replace(std::span<const Segment> old, std::span<const Segment> by,
               std::span<const Point2> about);
  /// Square metres that such a change uncovers; more than `enough` once it is known to be that.
  double lost(std::span<const Segment> old, std::span<const Segment> by,
              std::span<const Point2> about, double enough) const;
  /// Area that no leg covers, square metres.
  double uncovered() const { return double(uncovered_) * cell_ * cell_; }
  /// Connected uncovered places, largest first; each as its samples.
  std::vector<std::vector<Point2>> gaps() const;
  bool covers(const Segment& leg, const Point2& p) const {
    return squared_distance(p, leg) <= half_width_ * half_width_;
  }
  double square_metres(std::size_t samples) const { return double(samples) * cell_ * cell_; }

 private:
  Point2 sample(int column, int row) const {
    return {origin_.x() + (column + shift_x_[std::size_t(row)]) * cell_,
            origin_.y() + (row + shift_y_[std::size_t(column)]) * cell_};
  }
  std::size_t index(int column, int row) const {
    return std::size_t(row) * std::size_t(columns_) + std::size_t(column);
  }
  struct Window {
    int columns[2];
    int rows[2];
  };
  Window window(std::span<const Point2> about) const;
  int column_of(double x) const;
  int row_of(double y) const;
  void change(std::int16_t& count, int by);

  Point2 origin_;
  double cell_;
  double half_width_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<double> shift_x_;       ///< of each row, in cells
  std::vector<double> shift_y_;       ///< of each column
  std::vector<std::int16_t> counts_;  ///< -1: not of the area
  std::int64_t uncovered_ = 0;
};
}  // namespace altiplan::cover
