// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// Ground heights at the posts of a regular grid, bilinear between them. Heights are metres above
/// sea level; a void is NaN, and the four cells around it have no ground.
class ALTIPLAN_API HeightField {
 public:
  /// Posts in rows from the south, each from the west: post (i, j) is at
  /// (origin x + i dx, origin y + j dy) and has heights[j * columns + i]. Throws Error unless
  /// columns, rows >= 2, dx, dy > 0 and the number of heights matches.
  HeightField(std::array<double, 2> origin, std::array<double, 2> spacing, int columns, int rows,
              std::vector<float> heights);

  /// The posts of a larger grid that a field has.
  struct Part {
    int column = 0;
    int row = 0;
    int columns = 0;
    int rows = 0;
  };
  /// A part of a larger grid, whose post (0, 0) is at `whole_origin`. A part that begins at
  /// multiples of kBlock gives bit by bit the answers of the whole grid at all positions at least
  /// one post spacing inside it. Throws Error likewise.
  HeightField(std::array<double, 2> whole_origin, std::array<double, 2> spacing, const Part& part,
              std::vector<float> heights);
  /// Maximum height and slope are stored for blocks of kBlock × kBlock cells.
  static constexpr int kBlock = 16;

  int columns() const { return part_.columns; }
  int rows() const { return part_.rows; }
  /// Position of post (0, 0) of this field.
  const std::array<double, 2>& origin() const { return origin_; }
  const Part& part() const { return part_; }
  const std::array<double, 2>& whole_origin() const { return whole_origin_; }
  const std::array<double, 2>& spacing() const { return spacing_; }
  float post(int i, int j) const {
    return heights_[std::size_t(j) * std::size_t(part_.columns) + i];
  }
  double max_height() const { return max_height_; }
  double min_height() const { return min_height_; }
  std::size_t void_posts() const { return void_posts_; }
  /// Maximum slope anywhere (rise over run).
  double max_slope() const { return max_slope_; }
  /// Maximum slope within the horizontal box.
  double max_slope(double x0, double y0, double x1, double y1) const;
  /// Highest ground within the horizontal box; +infinity where part of it has none.
  double max_height(double x0, double y0, double x1, double y1) const;

  /// Ground height; none outside the posts and in a cell with a void.
  std::optional<double> at(double x, double y) const;

  /// Minimum height of the leg a–b above the ground: exact, cell by cell (over a bilinear cell it
  /// is a quadratic); -infinity where part of the leg has no ground below. May return any value of
  /// at least `enough` once the leg is known to be that high everywhere.
  double gap(const Vec3& a, const Vec3& b, double enough = kInfinity) const;

  /// Maximum height of the leg above the ground, likewise exact; +infinity where there is none.
  double gap_max(const Vec3& a, const Vec3& b) const;

 private:
  void measure_posts();
  void measure_blocks();
  void measure_block(int block_column, int block_row, float& top, double& squared) const;
  /// Block of a cell; indices count in the whole grid.
  std::size_t block(int i, int j) const {
    return std::size_t(j / kBlock - first_block_[1]) * std::size_t(block_columns_) +
           std::size_t(i / kBlock - first_block_[0]);
  }

  std::array<double, 2> whole_origin_;
  std::array<double, 2> origin_;
  std::array<double, 2> spacing_;
  std::array<double, 2> per_m_;
  Part part_;
  std::vector<float> heights_;
  double max_height_ = -kInfinity;
  double min_height_ = kInfinity;
  double max_slope_ = 0;
  std::size_t void_posts_ = 0;
  std::array<int, 2> first_block_{0, 0};
  int block_columns_ = 0;
  std::vector<float> block_max_;
  std::vector<float> block_slope_;
};
}  // namespace altiplan
