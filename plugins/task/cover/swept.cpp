// SPDX-License-Identifier: Apache-2.0
#include "swept.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan::cover {
namespace {

/// Multiples of the golden ratio modulo 1: evenly spread, however many.
std::vector<double> spread(int count, double by) {
  std::vector<double> all(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    all[std::size_t(i)] = std::fmod(0.5 + i * by, 1.0);
  }
  return all;
}
}  // namespace

Swept::Swept(const Area& area, double half_width, double cell_m)
    : origin_(area.min()), cell_(cell_m), half_width_(half_width) {
  const Point2 size = area.max() - area.min();
  columns_ = std::max(1, int(std::ceil(size.x() / cell_)));
  rows_ = std::max(1, int(std::ceil(size.y() / cell_)));
  shift_x_ = spread(rows_, 0.6180339887498949);
  shift_y_ = spread(columns_, 0.7548776662466927);
  counts_.assign(std::size_t(columns_) * std::size_t(rows_), -1);
  for (int row = 0; row < rows_; ++row) {
    for (const auto& [from, to] : area.along_row(origin_.y() + (row + 0.5) * cell_)) {
      for (int column = column_of(from); column <= column_of(to); ++column) {
        counts_[index(column, row)] = 0;
      }
    }
  }
  // Cells that an edge may cut are decided by their samples.
  for (const Ring2& ring : area.rings()) {
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const Point2 low = ring[i].cwiseMin(ring[j]);
      const Point2 high = ring[i].cwiseMax(ring[j]);
      for (int row = row_of(low.y() - cell_); row <= row_of(high.y() + cell_); ++row) {
        // The edge's extent within the row and its neighbours.
        double from = low.x();
        double to = high.x();
        const double rise = ring[i].y() - ring[j].y();
        if (std::abs(rise) > cell_) {
          const double y0 = origin_.y() + (row - 1) * cell_;
          const double x0 = ring[j].x() + (ring[i].x() - ring[j].x()) * (y0 - ring[j].y()) / rise;
          const double x1 =
              ring[j].x() + (ring[i].x() - ring[j].x()) * (y0 + 3 * cell_ - ring[j].y()) / rise;
          from = std::max(from, std::min(x0, x1));
          to = std::min(to, std::max(x0, x1));
        }
        for (int column = column_of(from - cell_); column <= column_of(to + cell_); ++column) {
          counts_[index(column, row)] = area.contains(sample(column, row)) ? 0 : -1;
        }
      }
    }
  }
  uncovered_ = std::count(counts_.begin(), counts_.end(), 0);
}

int Swept::column_of(double x) const {
  return std::clamp(int(std::floor((x - origin_.x()) / cell_)), 0, columns_ - 1);
}
int Swept::row_of(double y) const {
  return std::clamp(int(std::floor((y - origin_.y()) / cell_)), 0, rows_ - 1);
}

void Swept::change(std::int16_t& count, int by) {
  uncovered_ -= count == 0;
  count = std::int16_t(count + by);
  uncovered_ += count == 0;
}

void Swept::add(const Segment& leg) {
  const double r = half_width_;
  const Point2 way = leg.b - leg.a;
  const double rise = way.y();
  const int last = row_of(std::max(leg.a.y(), leg.b.y()) + r);
  for (int row = row_of(std::min(leg.a.y(), leg.b.y()) - r); row <= last; ++row) {
    // The leg's part within reach of the row, and what that reaches.
    double t0 = 0;
    double t1 = 1;
    if (std::abs(rise) > 1e-9) {
      const double low = origin_.y() + row * cell_ - r;
      const double high = low + cell_ + 2 * r;
      t0 = std::clamp((low - leg.a.y()) / rise, 0.0, 1.0);
      t1 = std::clamp((high - leg.a.y()) / rise, 0.0, 1.0);
    }
    const double x0 = leg.a.x() + t0 * way.x();
    const double x1 = leg.a.x() + t1 * way.x();
    const int to = column_of(std::max(x0, x1) + r);
    for (int column = column_of(std::min(x0, x1) - r); column <= to; ++column) {
      std::int16_t& count = counts_[index(column, row)];
      if (count >= 0 && covers(leg, sample(column, row))) {
        change(count, 1);
      }
    }
  }
}

Swept::Window Swept::window(std::span<const Point2> about) const {
  Point2 low = about[0];
  Point2 high = about[0];
  for (const Point2& p : about) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return {{column_of(low.x() - half_width_), column_of(high.x() + half_width_)},
          {row_of(low.y() - half_width_), row_of(high.y() + half_width_)}};
}

namespace {
int legs_over(std::span<const Segment> legs, const Point2& p, double square) {
  int over = 0;
  for (const Segment& leg : legs) {
    over += squared_distance(p, leg) <= square;
  }
  return over;
}
}  // namespace

double Swept::lost(std::span<const Segment> old, std::span<const Segment> by,
                   std::span<const Point2> about, double enough) const {
  const Window at = window(about);
  const double square = half_width_ * half_width_;
  const double limit = enough / (cell_ * cell_);
  const int most = int(old.size());
  int lost = 0;
  for (int row = at.rows[0]; row <= at.rows[1]; ++row) {
    for (int column = at.columns[0]; column <= at.columns[1]; ++column) {
      const std::int16_t count = counts_[index(column, row)];
      if (count <= 0 || count > most) {
        continue;
      }
      const Point2 p = sample(column, row);
      if (legs_over(old, p, square) == count && legs_over(by, p, square) == 0) {
        ++lost;
      }
    }
    if (lost > limit) {
      break;
    }
  }
  return square_metres(std::size_t(lost));
}

void Swept::replace(std::span<const Segment> old, std::span<const Segment> by,
                    std::span<const Point2> about) {
  const Window at = window(about);
  const double square = half_width_ * half_width_;
  for (int row = at.rows[0]; row <= at.rows[1]; ++row) {
    for (int column = at.columns[0]; column <= at.columns[1]; ++column) {
      std::int16_t& count = counts_[index(column, row)];
      if (count >= 0) {
        const Point2 p = sample(column, row);
        change(count, legs_over(by, p, square) - legs_over(old, p, square));
      }
    }
  }
}

std::vector<std::vector<Point2>> Swept::gaps() const {
  std::vector<std::vector<Point2>> all;
  std::vector<bool> seen(counts_.size());
  std::vector<std::size_t> stack;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (counts_[i] != 0 || seen[i]) {
      continue;
    }
    std::vector<Point2>& gap = all.emplace_back();
    stack.assign(1, i);
    seen[i] = true;
    while (!stack.empty()) {
      const std::size_t at = stack.back();
      stack.pop_back();
      const int row = int(at / std::size_t(columns_));
      const int column = int(at % std::size_t(columns_));
      gap.push_back(sample(column, row));
      for (int r = std::max(0, row - 2); r <= std::min(rows_ - 1, row + 2); ++r) {
        for (int c = std::max(0, column - 2); c <= std::min(columns_ - 1, column + 2); ++c) {
          const std::size_t next = index(c, r);
          if (counts_[next] == 0 && !seen[next]) {
            seen[next] = true;
            stack.push_back(next);
          }
        }
      }
    }
  }
  std::sort(all.begin(), all.end(),
            [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return all;
}
}  // namespace altiplan::cover
