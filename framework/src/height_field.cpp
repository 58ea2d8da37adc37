// SPDX-License-Identifier: Apache-2.0
#include "altiplan/height_field.hpp"

#include <algorithm>

#include "altiplan/error.hpp"

namespace altiplan {
namespace {

// A bilinear cell, by the fractions s (east) and w (north) of it.
struct Patch {
  double sw, se, nw, ne;

  bool has_ground() const { return !std::isnan(sw + se + nw + ne); }
  Patch scaled(double by) const { return {by * sw, by * se, by * nw, by * ne}; }
  double max() const { return std::max({sw, se, nw, ne}); }
  double at(double s, double w) const {
    return (1 - w) * ((1 - s) * sw + s * se) + w * ((1 - s) * nw + s * ne);
  }
  // Each component of the gradient runs between the slopes of two opposite edges, independently of
  // the other one: this is the steepest point exactly.
  double slope(double dx, double dy) const {
    const double east = std::max(std::abs(se - sw), std::abs(ne - nw)) / dx;
    const double north = std::max(std::abs(nw - sw), std::abs(ne - se)) / dy;
    return std::hypot(east, north);
  }
};

Patch patch(const HeightField& field, int i, int j) {
  return {field.post(i, j), field.post(i + 1, j), field.post(i, j + 1), field.post(i + 1, j + 1)};
}

// Least height above the patch of a straight piece from (s0, w0, z0) to (s1, w1, z1): a quadratic
// in the share of the piece, so the least of the ends and, where convex, of the stationary point.
double piece_gap(const Patch& p, double s0, double w0, double z0, double s1, double w1, double z1) {
  const double gap = std::min(z0 - p.at(s0, w0), z1 - p.at(s1, w1));
  const double ds = s1 - s0;
  const double dw = w1 - w0;
  const double twist = p.ne - p.se - p.nw + p.sw;
  const double bend = -twist * ds * dw;
  if (bend <= 0) {
    return gap;
  }
  const double rise = (z1 - z0) - (p.se - p.sw) * ds - (p.nw - p.sw) * dw -
                      twist * (s0 * dw + w0 * ds);  // at the piece's start
  const double share = -rise / (2 * bend);
  if (!(share > 0 && share < 1)) {
    return gap;
  }
  return std::min(gap, z0 + share * (z1 - z0) - p.at(s0 + share * ds, w0 + share * dw));
}

// A leg in units of cells; t runs from 0 to 1.
struct Walk {
  double u0, v0, du, dv;
  double u(double t) const { return u0 + t * du; }
  double v(double t) const { return v0 + t * dv; }

  // Calls visit(t0, t1) for the pieces of [from, to] between the lines u, v = multiples of step,
  // until it returns false. Pieces too short to matter (under 1e-14 of the leg) are left out: they
  // are what rounding leaves where the leg runs through a post.
  template <class Visit>
  void pieces(double from, double to, int step, const Visit& visit) const {
    double line[2];
    const double start[2] = {u0, v0};
    const double delta[2] = {du, dv};
    for (int axis = 0; axis < 2; ++axis) {
      const double at = (start[axis] + from * delta[axis]) / step;
      line[axis] = step * (delta[axis] > 0 ? std::floor(at) : std::ceil(at));
    }
    double t = from;
    while (t < to) {
      double next = to;
      for (int axis = 0; axis < 2; ++axis) {
        if (delta[axis] != 0) {
          double crossing = (line[axis] - start[axis]) / delta[axis];
          while (crossing <= t) {
            line[axis] += delta[axis] > 0 ? step : -step;
            crossing = (line[axis] - start[axis]) / delta[axis];
          }
          next = std::min(next, crossing);
        }
      }
      if (next - t > 1e-14 && !visit(t, next)) {
        return;
      }
      t = next;
    }
  }
};

int clamped_floor(double value, int last) {
  return static_cast<int>(std::clamp(std::floor(value), 0.0, double(last)));
}

bool is_whole(double value) { return value == std::floor(value); }

// Least of sign * (height of the leg above the ground); -infinity where ground is missing.
// roof(block column, block row) is the highest ground of a block of cells, above which they are
// skipped.
template <class Roof>
double least_gap(const HeightField& field, double sign, const Vec3& a_in, const Vec3& b_in,
                 double enough, int block, const Roof& roof) {
  // One sense for both, so that the answer is symmetric to the last bit.
  const bool swapped =
      std::lexicographical_compare(b_in.data(), b_in.data() + 3, a_in.data(), a_in.data() + 3);
  const Vec3& a = swapped ? b_in : a_in;
  const Vec3& b = swapped ? a_in : b_in;
  if (a.x() == b.x() && a.y() == b.y()) {
    const std::optional<double> ground = field.at(a.x(), a.y());
    return ground ? std::min(sign * (a.z() - *ground), sign * (b.z() - *ground)) : -kInfinity;
  }
  const auto [x0, y0] = field.origin();
  const auto [dx, dy] = field.spacing();
  const double last_u = field.columns() - 1;
  const double last_v = field.rows() - 1;
  for (const Vec3* p : {&a, &b}) {
    if (!(p->x() >= x0 && p->y() >= y0 && p->x() <= x0 + last_u * dx &&
          p->y() <= y0 + last_v * dy)) {
      return -kInfinity;
    }
  }
  const double u0 = std::clamp((a.x() - x0) / dx, 0.0, last_u);
  const double v0 = std::clamp((a.y() - y0) / dy, 0.0, last_v);
  const double u1 = std::clamp((b.x() - x0) / dx, 0.0, last_u);
  const double v1 = std::clamp((b.y() - y0) / dy, 0.0, last_v);
  const Walk walk{u0, v0, u1 - u0, v1 - v0};
  const double z0 = sign * a.z();
  const double dz = sign * (b.z() - a.z());

  double gap = kInfinity;
  const auto visit_cell = [&](double t0, double t1) {
    const double middle = (t0 + t1) / 2;
    const int i = clamped_floor(walk.u(middle), field.columns() - 2);
    const int j = clamped_floor(walk.v(middle), field.rows() - 2);
    // Along a line of posts either side will do.
    int use_i = i;
    int use_j = j;
    if (!patch(field, i, j).has_ground()) {
      use_i -= walk.du == 0 && walk.u0 == i && i > 0;
      use_j -= walk.dv == 0 && walk.v0 == j && j > 0;
    }
    const Patch p = patch(field, use_i, use_j).scaled(sign);
    gap = !p.has_ground()
              ? -kInfinity
              : std::min(gap, piece_gap(p, walk.u(t0) - use_i, walk.v(t0) - use_j, z0 + t0 * dz,
                                        walk.u(t1) - use_i, walk.v(t1) - use_j, z0 + t1 * dz));
    return gap > -kInfinity;
  };
  walk.pieces(0, 1, block, [&](double t0, double t1) {
    const double middle = (t0 + t1) / 2;
    const int i = clamped_floor(walk.u(middle), field.columns() - 2) / block;
    const int j = clamped_floor(walk.v(middle), field.rows() - 2) / block;
    const double lowest = z0 + (dz < 0 ? t1 : t0) * dz;
    if (lowest - roof(i, j) < std::min(gap, enough)) {
      walk.pieces(t0, t1, 1, visit_cell);
    }
    return gap > -kInfinity;
  });
  return gap;
}
}  // namespace

HeightField::HeightField(std::array<double, 2> origin, std::array<double, 2> spacing, int columns,
                         int rows, std::vector<float> heights)
    : origin_(origin),
      spacing_(spacing),
      columns_(columns),
      rows_(rows),
      heights_(std::move(heights)) {
  const std::string size = std::to_string(columns) + " x " + std::to_string(rows);
  if (columns < 2 || rows < 2) {
    throw Error("a height field needs at least 2 x 2 posts, found " + size);
  }
  for (int axis = 0; axis < 2; ++axis) {
    if (!(spacing[axis] > 0) || !std::isfinite(spacing[axis]) || !std::isfinite(origin[axis])) {
      throw Error("a height field needs a finite origin and positive spacings, found origin " +
                  std::to_string(origin[axis]) + " m and spacing " + std::to_string(spacing[axis]) +
                  " m");
    }
  }
  if (heights_.size() != std::size_t(columns) * std::size_t(rows)) {
    throw Error("a height field of " + size + " posts needs as many heights, found " +
                std::to_string(heights_.size()));
  }
  for (const float height : heights_) {
    if (std::isnan(height)) {
      ++void_posts_;
    } else if (!std::isfinite(height)) {
      throw Error("a height field's heights must be finite or NaN (a void)");
    } else {
      max_height_ = std::max(max_height_, double(height));
      min_height_ = std::min(min_height_, double(height));
    }
  }
  block_columns_ = (columns_ - 2) / kBlock + 1;
  const int block_rows = (rows_ - 2) / kBlock + 1;
  block_max_.assign(std::size_t(block_columns_) * std::size_t(block_rows), -float(kInfinity));
  block_slope_.assign(block_max_.size(), 0);
  for (int j = 0; j + 1 < rows_; ++j) {
    for (int i = 0; i + 1 < columns_; ++i) {
      const std::size_t block = std::size_t(j / kBlock) * block_columns_ + i / kBlock;
      const Patch p = patch(*this, i, j);
      if (!p.has_ground()) {
        block_max_[block] = float(kInfinity);  // never skipped
        continue;
      }
      block_max_[block] = std::max(block_max_[block], float(p.max()));
      const double slope = p.slope(spacing_[0], spacing_[1]);
      max_slope_ = std::max(max_slope_, slope);
      block_slope_[block] =
          std::max(block_slope_[block], std::nextafter(float(slope), float(kInfinity)));
    }
  }
}

double HeightField::max_slope(double x0, double y0, double x1, double y1) const {
  const double u0 = (x0 - origin_[0]) / spacing_[0];
  const double v0 = (y0 - origin_[1]) / spacing_[1];
  const double u1 = (x1 - origin_[0]) / spacing_[0];
  const double v1 = (y1 - origin_[1]) / spacing_[1];
  if (!(u0 <= columns_ - 1 && v0 <= rows_ - 1 && u1 >= 0 && v1 >= 0)) {
    return 0;
  }
  // Cells that the closed box touches.
  const int i0 = clamped_floor(std::ceil(u0) - 1, columns_ - 2);
  const int j0 = clamped_floor(std::ceil(v0) - 1, rows_ - 2);
  const int i1 = clamped_floor(u1, columns_ - 2);
  const int j1 = clamped_floor(v1, rows_ - 2);
  double slope = 0;
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      const double block = block_slope_[std::size_t(j / kBlock) * block_columns_ + i / kBlock];
      if (block <= slope) {
        i = (i / kBlock + 1) * kBlock - 1;
        continue;
      }
      const Patch p = patch(*this, i, j);
      if (p.has_ground()) {
        slope = std::max(slope, p.slope(spacing_[0], spacing_[1]));
      }
    }
  }
  return slope;
}

double HeightField::max_height(double x0, double y0, double x1, double y1) const {
  if (!(x0 >= origin_[0] && y0 >= origin_[1] && x1 <= origin_[0] + (columns_ - 1) * spacing_[0] &&
        y1 <= origin_[1] + (rows_ - 1) * spacing_[1])) {
    return kInfinity;
  }
  const double u0 = (x0 - origin_[0]) / spacing_[0];
  const double v0 = (y0 - origin_[1]) / spacing_[1];
  const double u1 = (x1 - origin_[0]) / spacing_[0];
  const double v1 = (y1 - origin_[1]) / spacing_[1];
  const int i0 = clamped_floor(u0, columns_ - 2);
  const int j0 = clamped_floor(v0, rows_ - 2);
  const int i1 = clamped_floor(u1, columns_ - 2);
  const int j1 = clamped_floor(v1, rows_ - 2);
  double height = -kInfinity;
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      if (block_max_[std::size_t(j / kBlock) * block_columns_ + i / kBlock] <= height) {
        i = (i / kBlock + 1) * kBlock - 1;
        continue;
      }
      const Patch p = patch(*this, i, j);
      if (!p.has_ground()) {
        return kInfinity;
      }
      // A bilinear patch is highest in a corner of any rectangle of it.
      for (const double s : {std::clamp(u0 - i, 0.0, 1.0), std::clamp(u1 - i, 0.0, 1.0)}) {
        for (const double w : {std::clamp(v0 - j, 0.0, 1.0), std::clamp(v1 - j, 0.0, 1.0)}) {
          height = std::max(height, p.at(s, w));
        }
      }
    }
  }
  return height;
}

std::optional<double> HeightField::at(double x, double y) const {
  if (!(x >= origin_[0] && y >= origin_[1] && x <= origin_[0] + (columns_ - 1) * spacing_[0] &&
        y <= origin_[1] + (rows_ - 1) * spacing_[1])) {
    return std::nullopt;
  }
  const double u = std::clamp((x - origin_[0]) / spacing_[0], 0.0, double(columns_ - 1));
  const double v = std::clamp((y - origin_[1]) / spacing_[1], 0.0, double(rows_ - 1));
  // A point on a border has the ground of whichever of its cells has one.
  const int i1 = clamped_floor(u, columns_ - 2);
  const int j1 = clamped_floor(v, rows_ - 2);
  for (int j = j1; j >= (is_whole(v) ? std::max(j1 - 1, 0) : j1); --j) {
    for (int i = i1; i >= (is_whole(u) ? std::max(i1 - 1, 0) : i1); --i) {
      const Patch p = patch(*this, i, j);
      if (u - i <= 1 && v - j <= 1 && p.has_ground()) {
        return p.at(u - i, v - j);
      }
    }
  }
  return std::nullopt;
}

double HeightField::gap(const Vec3& a, const Vec3& b, double enough) const {
  const double lowest = std::min(a.z(), b.z());
  const Box posts{{origin_[0], origin_[1], -kInfinity},
                  {origin_[0] + (columns_ - 1) * spacing_[0],
                   origin_[1] + (rows_ - 1) * spacing_[1], kInfinity}};
  if (lowest - max_height_ >= enough && void_posts_ == 0 && posts.contains(a) &&
      posts.contains(b)) {
    return lowest - max_height_;
  }
  return least_gap(*this, 1, a, b, enough, kBlock, [this](int i, int j) {
    return double(block_max_[std::size_t(j) * block_columns_ + i]);
  });
}

double HeightField::gap_max(const Vec3& a, const Vec3& b) const {
  return -least_gap(*this, -1, a, b, kInfinity, kBlock, [](int, int) { return kInfinity; });
}
}  // namespace altiplan
