// SPDX-License-Identifier: Apache-2.0
// Bounds of a height field as a whole, and of blocks of its posts.
#include <algorithm>

#include "altiplan/error.hpp"
#include "altiplan/height_field.hpp"
#include "height_patch.hpp"

namespace altiplan {
namespace {

constexpr int kLanes = 16;  ///< side by side, so that the compiler can vectorise

/// Minimum and maximum of many heights, and the number of voids among them.
struct Range {
  std::array<float, kLanes> low;
  std::array<float, kLanes> high;
  std::array<int, kLanes> voids{};

  Range() {
    low.fill(float(kInfinity));
    high.fill(-float(kInfinity));
  }
  void add(const float* heights, std::size_t count) {
    std::size_t k = 0;
    for (; k + kLanes <= count; k += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        add(heights[k + lane], lane);
      }
    }
    for (; k < count; ++k) {
      add(heights[k], 0);
    }
  }

 private:
  void add(float height, std::size_t lane) {  // a void compares false
    low[lane] = height < low[lane] ? height : low[lane];
    high[lane] = height > high[lane] ? height : high[lane];
    voids[lane] += height != height ? 1 : 0;
  }
};
}  // namespace

HeightField::HeightField(std::array<double, 2> origin, std::array<double, 2> spacing, int columns,
                         int rows, std::vector<float> heights)
    : HeightField(origin, spacing, Part{0, 0, columns, rows}, std::move(heights)) {}

HeightField::HeightField(std::array<double, 2> whole_origin, std::array<double, 2> spacing,
                         const Part& part, std::vector<float> heights)
    : whole_origin_(whole_origin),
      origin_{whole_origin[0] + part.column * spacing[0], whole_origin[1] + part.row * spacing[1]},
      spacing_(spacing),
      per_m_{1 / spacing[0], 1 / spacing[1]},
      part_(part),
      heights_(std::move(heights)) {
  const std::string size = std::to_string(part.columns) + " x " + std::to_string(part.rows);
  if (part.columns < 2 || part.rows < 2) {
    throw Error("a height field needs at least 2 x 2 posts, found " + size);
  }
  for (int axis = 0; axis < 2; ++axis) {
    if (!(spacing[axis] > 0) || !std::isfinite(spacing[axis]) || !std::isfinite(origin_[axis])) {
      throw Error("a height field needs a finite origin and positive spacings, found origin " +
                  std::to_string(origin_[axis]) + " m and spacing " +
                  std::to_string(spacing[axis]) + " m");
    }
  }
  if (part.column < 0 || part.row < 0) {
    throw Error("a part of a height field must begin inside the whole, found column " +
                std::to_string(part.column) + ", row " + std::to_string(part.row));
  }
  if (heights_.size() != std::size_t(part.columns) * std::size_t(part.rows)) {
    throw Error("a height field of " + size + " posts needs as many heights, found " +
                std::to_string(heights_.size()));
  }
  measure_posts();
  measure_blocks();
}

void HeightField::measure_posts() {
  Range range;
  range.add(heights_.data(), heights_.size());
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (range.high[lane] == kInfinity || range.low[lane] == -kInfinity) {
      throw Error("a height field's heights must be finite or NaN (a void)");
    }
    min_height_ = std::min(min_height_, double(range.low[lane]));
    max_height_ = std::max(max_height_, double(range.high[lane]));
  }
  for (const int voids : range.voids) {
    void_posts_ += std::size_t(voids);
  }
}

void HeightField::measure_blocks() {
  first_block_ = {part_.column / kBlock, part_.row / kBlock};
  block_columns_ = (part_.column + part_.columns - 2) / kBlock - first_block_[0] + 1;
  const int block_rows = (part_.row + part_.rows - 2) / kBlock - first_block_[1] + 1;
  block_max_.resize(std::size_t(block_columns_) * std::size_t(block_rows));
  block_slope_.resize(block_max_.size());
  double steepest = 0;
  for (int block_row = 0; block_row < block_rows; ++block_row) {
    for (int block_column = 0; block_column < block_columns_; ++block_column) {
      const std::size_t n =
          std::size_t(block_row) * std::size_t(block_columns_) + std::size_t(block_column);
      double squared = 0;
      measure_block(block_column, block_row, block_max_[n], squared);
      steepest = std::max(steepest, squared);
      block_slope_[n] =
          squared > 0 ? std::nextafter(float(std::sqrt(squared)), float(kInfinity)) : 0;
    }
  }
  max_slope_ = std::sqrt(steepest);
}

/// Highest ground of a block of cells, infinite where a cell has none: such a block is never
/// skipped; and the maximum squared slope.
void HeightField::measure_block(int block_column, int block_row, float& top,
                                double& squared) const {
  static_assert(kBlock == kLanes);
  const auto cells = [](int block, int first, int posts) {
    return std::array<int, 2>{std::max(block * kBlock - first, 0),
                              std::min((block + 1) * kBlock - first, posts - 1)};
  };
  const auto [i0, i1] = cells(first_block_[0] + block_column, part_.column, part_.columns);
  const auto [j0, j1] = cells(first_block_[1] + block_row, part_.row, part_.rows);
  std::array<float, kLanes> high;
  std::array<double, kLanes> steep{};
  high.fill(-float(kInfinity));
  const auto measure = [&](const float* south, const float* north, std::size_t lane) {
    const float highest = std::max(std::max(south[0], south[1]), std::max(north[0], north[1]));
    const Patch p{south[0], south[1], north[0], north[1]};
    const double here = p.squared_slope(per_m_);
    const bool has_ground = p.has_ground();
    const float roof = has_ground ? highest : float(kInfinity);
    const double slope = has_ground ? here : 0;
    high[lane] = roof > high[lane] ? roof : high[lane];
    steep[lane] = slope > steep[lane] ? slope : steep[lane];
  };
  for (int j = j0; j < j1; ++j) {
    const float* south = heights_.data() + std::size_t(j) * std::size_t(part_.columns) + i0;
    const float* north = south + part_.columns;
    if (i1 - i0 == kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        measure(south + lane, north + lane, lane);
      }
    } else {
      for (std::size_t lane = 0; lane < std::size_t(i1 - i0); ++lane) {
        measure(south + lane, north + lane, lane);
      }
    }
  }
  top = *std::max_element(high.begin(), high.end());
  squared = *std::max_element(steep.begin(), steep.end());
}
}  // namespace altiplan
