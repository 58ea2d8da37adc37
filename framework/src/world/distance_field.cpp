// SPDX-License-Identifier: Apache-2.0
#include "altiplan/distance_field.hpp"

#include <algorithm>

namespace altiplan {
namespace {

// Lower envelope of the parabolas (x - q step)² + f[q], sampled at x = q step.
class Envelope {
 public:
  explicit Envelope(int longest)
      : values_(longest), sites_(longest), height_(longest), from_(longest) {}

  double& operator[](int q) { return values_[q]; }

  // Replaces values 0..n-1 by the envelope.
  void transform(int n, double step) {
    int top = -1;
    for (int q = 0; q < n; ++q) {
      if (values_[q] == kInfinity) {
        continue;
      }
      double start = -kInfinity;
      while (top >= 0) {
        start = crossing(sites_[top], height_[top], q, values_[q], step);
        if (start > from_[top]) {
          break;
        }
        --top;
        start = -kInfinity;
      }
      ++top;
      sites_[top] = q;
      height_[top] = values_[q];
      from_[top] = start;
    }
    if (top < 0) {
      return;
    }
    for (int q = 0, site = 0; q < n; ++q) {
      while (site < top && from_[site + 1] < q * step) {
        ++site;
      }
      const double along = (q - sites_[site]) * step;
      values_[q] = along * along + height_[site];
    }
  }

 private:
  // Position from which the parabola of q lies below that of p < q.
  static double crossing(int p, double fp, int q, double fq, double step) {
    return (fq - fp) / (2 * (q - p) * step) + (q + p) * step / 2;
  }

  std::vector<double> values_;
  std::vector<int> sites_;
  std::vector<double> height_;
  std::vector<double> from_;
};

// Never above the double, so that the field stays a lower bound.
float rounded_down(double value) {
  const float near = static_cast<float>(value);
  return double(near) > value ? std::nextafter(near, 0.0F) : near;
}
}  // namespace

// The border is not an obstacle: the field measures blocked cells of the grid itself.
DistanceField::DistanceField(const VoxelGrid& grid, double max_m) : spec_(grid.spec()) {
  const auto [nx, ny, nz] = spec_.counts;
  const std::size_t level = std::size_t(nx) * std::size_t(ny);
  distances_.resize(spec_.cell_count());
  Envelope line(std::max({nx, ny, nz}));
  std::vector<double> slice(level);
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        line[i] = grid.blocked(i, j, k) ? 0 : kInfinity;
      }
      line.transform(nx, spec_.cell.x());
      for (int i = 0; i < nx; ++i) {
        slice[std::size_t(j) * nx + i] = line[i];
      }
    }
    for (int i = 0; i < nx; ++i) {
      for (int j = 0; j < ny; ++j) {
        line[j] = slice[std::size_t(j) * nx + i];
      }
      line.transform(ny, spec_.cell.y());
      for (int j = 0; j < ny; ++j) {
        distances_[k * level + std::size_t(j) * nx + i] = rounded_down(line[j]);
      }
    }
  }
  for (std::size_t column = 0; column < level; ++column) {
    for (int k = 0; k < nz; ++k) {
      line[k] = distances_[k * level + column];
    }
    line.transform(nz, spec_.cell.z());
    for (int k = 0; k < nz; ++k) {
      distances_[k * level + column] = rounded_down(std::min(std::sqrt(line[k]), max_m));
    }
  }
}

double DistanceField::centre_distance(const Cell& c) const {
  if (!spec_.holds(c)) {
    return 0;
  }
  return distances_[(std::size_t(c[2]) * spec_.counts[1] + c[1]) * spec_.counts[0] + c[0]];
}

double DistanceField::clearance(const Vec3& p) const {
  const Cell c = spec_.cell_of(p);
  if (!spec_.holds(c)) {
    return 0;
  }
  // Between p and a blocked cell: the distance of the centres, minus p's distance to its own centre
  // and the blocked cell's half diagonal.
  const double away = (p - spec_.centre(c)).norm() + spec_.cell.norm() / 2;
  return std::max(0.0, centre_distance(c) - away);
}
}  // namespace altiplan
