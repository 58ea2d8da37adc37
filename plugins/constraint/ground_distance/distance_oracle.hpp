// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan::testing {

/// Distances to bilinear ground in extended precision, by no code of the framework.
class DistanceOracle {
 public:
  using Real = long double;
  struct Point {
    Real x, y, z;
  };

  DistanceOracle(Real dx, Real dy, int columns, int rows, const std::vector<float>& heights)
      : dx_(dx), dy_(dy), columns_(columns), rows_(rows), heights_(heights) {}

  /// 0 at or below the ground.
  Real distance(const Point& p) const {
    if (p.z <= height(p.x, p.y)) {
      return 0;
    }
    Real best = p.z - height(p.x, p.y);
    for (int j = 0; j + 1 < rows_; ++j) {
      for (int i = 0; i + 1 < columns_; ++i) {
        best = to_box(p, i, j) < best ? std::min(best, to_cell(p, i, j)) : best;
      }
    }
    return best;
  }

  /// The greatest distance along the leg: dense samples, refined about each of their maxima.
  Real farthest(const Vec3& a, const Vec3& b) const {
    const auto at = [&](Real t) {
      return distance({a.x() + t * (Real(b.x()) - a.x()), a.y() + t * (Real(b.y()) - a.y()),
                       a.z() + t * (Real(b.z()) - a.z())});
    };
    constexpr int kSamples = 240;
    std::vector<Real> all(kSamples + 1);
    for (int n = 0; n <= kSamples; ++n) {
      all[std::size_t(n)] = at(Real(n) / kSamples);
    }
    Real best = *std::max_element(all.begin(), all.end());
    const Real step = (b - a).norm() / kSamples;
    for (int n = 0; n <= kSamples; ++n) {
      const Real here = all[std::size_t(n)];
      const Real before = n > 0 ? all[std::size_t(n) - 1] : here;
      const Real after = n < kSamples ? all[std::size_t(n) + 1] : here;
      if (here >= before && here >= after && here + step >= best) {
        best = std::max(best, -minimum([&](Real t) { return -at(t); }, Real(n - 1) / kSamples,
                                       Real(n + 1) / kSamples));
      }
    }
    return best;
  }

  Real height(Real x, Real y) const {
    const int i = std::clamp(int(std::floor(x / dx_)), 0, columns_ - 2);
    const int j = std::clamp(int(std::floor(y / dy_)), 0, rows_ - 2);
    const Real s = x / dx_ - i;
    const Real w = y / dy_ - j;
    return (1 - s) * ((1 - w) * post(i, j) + w * post(i, j + 1)) +
           s * ((1 - w) * post(i + 1, j) + w * post(i + 1, j + 1));
  }

 private:
  Real post(int i, int j) const { return heights_[std::size_t(j * columns_ + i)]; }

  /// Golden section search within [0, 1].
  static Real minimum(const std::function<Real(Real)>& f, Real low, Real high) {
    const Real golden = (std::sqrt(Real(5)) - 1) / 2;
    low = std::max(low, Real(0));
    high = std::min(high, Real(1));
    Real t1 = high - golden * (high - low);
    Real t2 = low + golden * (high - low);
    Real f1 = f(t1);
    Real f2 = f(t2);
    while (high - low > 1e-11L) {
      if (f1 < f2) {
        high = t2;
        t2 = t1;
        f2 = f1;
        f1 = f(t1 = high - golden * (high - low));
      } else {
        low = t1;
        t1 = t2;
        f1 = f2;
        f2 = f(t2 = low + golden * (high - low));
      }
    }
    return std::min(f1, f2);
  }

  Real to_box(const Point& p, int i, int j) const {
    const Real x = std::max({i * dx_ - p.x, p.x - (i + 1) * dx_, Real(0)});
    const Real y = std::max({j * dy_ - p.y, p.y - (j + 1) * dy_, Real(0)});
    const Real top = std::max({post(i, j), post(i + 1, j), post(i, j + 1), post(i + 1, j + 1)});
    const Real z = std::max(p.z - top, Real(0));
    return std::sqrt(x * x + y * y + z * z);
  }

  /// A cell is a family of straight segments, one for each share s of its width.
  Real to_cell(const Point& p, int i, int j) const {
    const auto to_segment = [&](Real s) {
      const Real x = (i + s) * dx_ - p.x;
      const Real y0 = j * dy_ - p.y;
      const Real z0 = (1 - s) * post(i, j) + s * post(i + 1, j) - p.z;
      const Real z1 = (1 - s) * post(i, j + 1) + s * post(i + 1, j + 1) - p.z;
      const Real rise = z1 - z0;
      const Real t =
          std::clamp(-(y0 * dy_ + z0 * rise) / (dy_ * dy_ + rise * rise), Real(0), Real(1));
      const Real y = y0 + t * dy_;
      const Real z = z0 + t * rise;
      return std::sqrt(x * x + y * y + z * z);
    };
    constexpr int kSamples = 24;
    std::array<Real, kSamples + 1> all;
    for (int n = 0; n <= kSamples; ++n) {
      all[std::size_t(n)] = to_segment(Real(n) / kSamples);
    }
    const Real nearest = *std::min_element(all.begin(), all.end());
    const Real across = std::max(std::abs(post(i + 1, j) - post(i, j)),
                                 std::abs(post(i + 1, j + 1) - post(i, j + 1)));
    const Real step = std::hypot(dx_, across) / kSamples;
    Real best = nearest;
    for (int n = 0; n <= kSamples; ++n) {
      const Real here = all[std::size_t(n)];
      const bool is_min = (n == 0 || here <= all[std::size_t(n) - 1]) &&
                          (n == kSamples || here <= all[std::size_t(n) + 1]);
      if (is_min && here - step < nearest) {
        best = std::min(best, minimum(to_segment, Real(n - 1) / kSamples, Real(n + 1) / kSamples));
      }
    }
    return best;
  }

  Real dx_, dy_;
  int columns_, rows_;
  std::vector<float> heights_;
};
}  // namespace altiplan::testing
