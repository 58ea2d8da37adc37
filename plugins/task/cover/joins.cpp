// SPDX-License-Identifier: Apache-2.0
#include "joins.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace altiplan::cover {
namespace {
constexpr double kNever = std::numeric_limits<double>::infinity();
}

double LegTime::of(double length_m) const {
  const double to_speed = speed_mps * speed_mps / acceleration_mps2;
  return length_m < to_speed ? 2 * std::sqrt(length_m / acceleration_mps2)
                             : length_m / speed_mps + speed_mps / acceleration_mps2;
}

/// A shortest way bends only where the free side is larger than a half turn.
void Joins::find_corners(const Area& area) {
  for (std::size_t k = 0; k < area.rings().size(); ++k) {
    const Ring2& ring = area.rings()[k];
    const std::size_t n = ring.size();
    double sense = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Point2& a = ring[i];
      const Point2& b = ring[(i + 1) % n];
      sense += a.x() * b.y() - a.y() * b.x();
    }
    for (std::size_t i = 0; i < n; ++i) {
      const Point2 in = ring[i] - ring[(i + n - 1) % n];
      const Point2 out = ring[(i + 1) % n] - ring[i];
      const double turn = (in.x() * out.y() - in.y() * out.x()) * (k == 0 ? -sense : sense);
      if (turn > 0) {
        corners_.push_back(ring[i]);
      }
    }
  }
}

/// All pairs by Floyd and Warshall.
void Joins::join_corners(const Area& area, const LegTime& time) {
  const std::size_t n = corners_.size();
  between_corners_.assign(n * n, kNever);
  next_.assign(n * n, -1);
  for (std::size_t i = 0; i < n; ++i) {
    between_corners_[i * n + i] = 0;
    next_[i * n + i] = int(i);
    for (std::size_t j = 0; j < i; ++j) {
      if (area.sees(corners_[i], corners_[j])) {
        between_corners_[i * n + j] = between_corners_[j * n + i] =
            time.between(corners_[i], corners_[j]);
        next_[i * n + j] = int(j);
        next_[j * n + i] = int(i);
      }
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      const double to_k = between_corners_[i * n + k];
      if (to_k == kNever || i == k) {
        continue;
      }
      for (std::size_t j = 0; j < n; ++j) {
        const double by_k = to_k + between_corners_[k * n + j];
        if (by_k < between_corners_[i * n + j]) {
          between_corners_[i * n + j] = by_k;
          next_[i * n + j] = next_[i * n + k];
        }
      }
    }
  }
}

Joins::Joins(const Area& area, const LegTime& time, Ring2 points) : points_(std::move(points)) {
  find_corners(area);
  join_corners(area, time);
  const std::size_t n = points_.size();
  const std::size_t m = corners_.size();
  to_corner_.assign(n * m, kNever);
  first_.assign(n * m, -1);
  std::vector<double> by_corners(n * m, kNever);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t c = 0; c < m; ++c) {
      if (area.sees(points_[i], corners_[c])) {
        to_corner_[i * m + c] = time.between(points_[i], corners_[c]);
      }
    }
    for (std::size_t u = 0; u < m; ++u) {
      const double to_u = to_corner_[i * m + u];
      if (to_u == kNever) {
        continue;
      }
      for (std::size_t c = 0; c < m; ++c) {
        const double by_u = to_u + between_corners_[u * m + c];
        if (by_u < by_corners[i * m + c]) {
          by_corners[i * m + c] = by_u;
          first_[i * m + c] = int(u);
        }
      }
    }
  }
  times_.assign(n * n, 0);
  last_.assign(n * n, -1);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      double best = kNever;
      int last = -1;
      if (area.sees(points_[i], points_[j])) {
        best = time.between(points_[i], points_[j]);
      } else {
        for (std::size_t c = 0; c < m; ++c) {
          const double by_c = by_corners[i * m + c] + to_corner_[j * m + c];
          if (by_c < best) {
            best = by_c;
            last = int(c);
          }
        }
      }
      times_[i * n + j] = times_[j * n + i] = best;
      last_[i * n + j] = last;
    }
  }
}

Ring2 Joins::corners(int i, int j) const {
  if (i < j) {
    Ring2 back = corners(j, i);
    std::reverse(back.begin(), back.end());
    return back;
  }
  Ring2 all;
  const int last = i == j ? -1 : last_[at(i, j)];
  if (last < 0) {
    return all;
  }
  const std::size_t m = corners_.size();
  int corner = first_[std::size_t(i) * m + std::size_t(last)];
  all.push_back(corners_[std::size_t(corner)]);
  while (corner != last) {
    corner = next_[std::size_t(corner) * m + std::size_t(last)];
    all.push_back(corners_[std::size_t(corner)]);
  }
  return all;
}
}  // namespace altiplan::cover
