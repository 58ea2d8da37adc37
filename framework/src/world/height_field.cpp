// SPDX-License-Identifier: Apache-2.0
#include "altiplan/height_field.hpp"

#include <algorithm>

#include "altiplan/error.hpp"
#include "height_patch.hpp"

namespace altiplan {
namespace {

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
    const double start[2] = {u0, v0};
    const double delta[2] = {du, dv};
    double line[2];
    double crossing[2] = {kInfinity, kInfinity};
    for (int axis = 0; axis < 2; ++axis) {
      const double at = (start[axis] + from * delta[axis]) / step;
      line[axis] = step * (delta[axis] > 0 ? std::floor(at) : std::ceil(at));
      if (delta[axis] != 0) {
        crossing[axis] = (line[axis] - start[axis]) / delta[axis];
      }
    }
    double t = from;
    while (t < to) {
      for (int axis = 0; axis < 2; ++axis) {
        while (crossing[axis] <= t) {
          line[axis] += delta[axis] > 0 ? step : -step;
          crossing[axis] = (line[axis] - start[axis]) / delta[axis];
        }
      }
      const double next = std::min({to, crossing[0], crossing[1]});
      if (next - t > 1e-14 && !visit(t, next)) {
        return;
      }
      t = next;
    }
  }
};

// The floor, as `first` is not negative.
int clamped_floor(double value, int first, int last) {
  return static_cast<int>(std::clamp(value, double(first), double(last)));
}

// The cell whose south-west post has these indices in the whole grid.
Patch patch(const HeightField& field, int i, int j) {
  i -= field.part().column;
  j -= field.part().row;
  return {field.post(i, j), field.post(i + 1, j), field.post(i, j + 1), field.post(i + 1, j + 1)};
}

// Places and cells are counted in the whole grid, so that a part rounds as the whole does.
struct Extent {
  explicit Extent(const HeightField& field)
      : origin(field.whole_origin()),
        spacing(field.spacing()),
        first{field.part().column, field.part().row},
        last{first[0] + field.columns() - 1, first[1] + field.rows() - 1} {}
  bool holds(double x, double y) const {
    return x >= origin[0] + first[0] * spacing[0] && y >= origin[1] + first[1] * spacing[1] &&
           x <= origin[0] + last[0] * spacing[0] && y <= origin[1] + last[1] * spacing[1];
  }
  double u(double x) const { return (x - origin[0]) / spacing[0]; }
  double v(double y) const { return (y - origin[1]) / spacing[1]; }
  double u_within(double x) const { return std::clamp(u(x), double(first[0]), double(last[0])); }
  double v_within(double y) const { return std::clamp(v(y), double(first[1]), double(last[1])); }
  int column(double u) const { return clamped_floor(u, first[0], last[0] - 1); }
  int row(double v) const { return clamped_floor(v, first[1], last[1] - 1); }

  std::array<double, 2> origin;
  std::array<double, 2> spacing;
  std::array<int, 2> first;  // post
  std::array<int, 2> last;
};

bool is_whole(double value) { return value == std::floor(value); }

// Least of sign * (height of a leg above the ground), piece by piece; -infinity where ground is
// missing.
struct GapSearch {
  const HeightField& field;
  const Extent& extent;
  double sign;
  double enough;
  Walk walk;
  double z0, dz;  ///< sign * height of the leg
  double gap = kInfinity;

  /// Of the part of the leg over one cell; false ends the search.
  bool visit_cell(double t0, double t1) {
    const double middle = (t0 + t1) / 2;
    int i = extent.column(walk.u(middle));
    int j = extent.row(walk.v(middle));
    Patch p = patch(field, i, j);
    if (!p.has_ground()) {  // along a line of posts either side will do
      i -= walk.du == 0 && walk.u0 == i && i > extent.first[0];
      j -= walk.dv == 0 && walk.v0 == j && j > extent.first[1];
      p = patch(field, i, j);
    }
    if (!p.has_ground()) {
      gap = -kInfinity;
      return false;
    }
    p = p.scaled(sign);
    const double z_from = z0 + t0 * dz;
    const double z_to = z0 + t1 * dz;
    // High above a cell nothing is least, rounding included.
    const double top = p.max();
    const double rounding = 1e-12 * (std::abs(z_from) + std::abs(z_to) + std::abs(top));
    if (std::min(z_from, z_to) - top <= std::min(gap, enough) + rounding) {
      gap = std::min(gap, piece_gap(p, walk.u(t0) - i, walk.v(t0) - j, z_from, walk.u(t1) - i,
                                    walk.v(t1) - j, z_to));
    }
    return true;
  }
};

// roof(block column, block row) is the highest ground of a block of cells, above which they are
// skipped.
template <class Roof>
double min_gap(const HeightField& field, double sign, const Vec3& a_in, const Vec3& b_in,
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
  const Extent extent(field);
  if (!extent.holds(a.x(), a.y()) || !extent.holds(b.x(), b.y())) {
    return -kInfinity;
  }
  const double u0 = extent.u_within(a.x());
  const double v0 = extent.v_within(a.y());
  GapSearch search{field,
                   extent,
                   sign,
                   enough,
                   {u0, v0, extent.u_within(b.x()) - u0, extent.v_within(b.y()) - v0},
                   sign * a.z(),
                   sign * (b.z() - a.z())};
  const Walk& walk = search.walk;
  walk.pieces(0, 1, block, [&](double t0, double t1) {
    const double middle = (t0 + t1) / 2;
    const int i = extent.column(walk.u(middle)) / block;
    const int j = extent.row(walk.v(middle)) / block;
    const double lowest = search.z0 + (search.dz < 0 ? t1 : t0) * search.dz;
    if (lowest - roof(i, j) < std::min(search.gap, enough)) {
      walk.pieces(t0, t1, 1, [&](double from, double to) { return search.visit_cell(from, to); });
    }
    return search.gap > -kInfinity;
  });
  return search.gap;
}
}  // namespace

double HeightField::max_slope(double x0, double y0, double x1, double y1) const {
  const Extent extent(*this);
  const double u0 = extent.u(x0);
  const double v0 = extent.v(y0);
  const double u1 = extent.u(x1);
  const double v1 = extent.v(y1);
  if (!(u0 <= extent.last[0] && v0 <= extent.last[1] && u1 >= extent.first[0] &&
        v1 >= extent.first[1])) {
    return 0;
  }
  // Cells that the closed box touches.
  const int i0 = extent.column(std::ceil(u0) - 1);
  const int j0 = extent.row(std::ceil(v0) - 1);
  const int i1 = extent.column(u1);
  const int j1 = extent.row(v1);
  double squared = 0;
  double slope = 0;
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      if (block_slope_[block(i, j)] <= slope) {
        i = (i / kBlock + 1) * kBlock - 1;
        continue;
      }
      const Patch p = patch(*this, i, j);
      if (const double here = p.squared_slope(per_m_); p.has_ground() && here > squared) {
        squared = here;
        slope = std::sqrt(squared);
      }
    }
  }
  return slope;
}

double HeightField::max_height(double x0, double y0, double x1, double y1) const {
  const Extent extent(*this);
  if (!extent.holds(x0, y0) || !extent.holds(x1, y1)) {
    return kInfinity;
  }
  const double u0 = extent.u(x0);
  const double v0 = extent.v(y0);
  const double u1 = extent.u(x1);
  const double v1 = extent.v(y1);
  const int i0 = extent.column(u0);
  const int j0 = extent.row(v0);
  const int i1 = extent.column(u1);
  const int j1 = extent.row(v1);
  double height = -kInfinity;
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      if (block_max_[block(i, j)] <= height) {
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
  const Extent extent(*this);
  if (!extent.holds(x, y)) {
    return std::nullopt;
  }
  const double u = extent.u_within(x);
  const double v = extent.v_within(y);
  // A point on a border has the ground of whichever of its cells has one.
  const int i1 = extent.column(u);
  const int j1 = extent.row(v);
  for (int j = j1; j >= (is_whole(v) ? std::max(j1 - 1, extent.first[1]) : j1); --j) {
    for (int i = i1; i >= (is_whole(u) ? std::max(i1 - 1, extent.first[0]) : i1); --i) {
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
  const Extent extent(*this);
  if (lowest - max_height_ >= enough && void_posts_ == 0 && extent.holds(a.x(), a.y()) &&
      extent.holds(b.x(), b.y())) {
    return lowest - max_height_;
  }
  return min_gap(*this, 1, a, b, enough, kBlock, [this](int i, int j) {
    return double(block_max_[block(i * kBlock, j * kBlock)]);
  });
}

double HeightField::gap_max(const Vec3& a, const Vec3& b) const {
  return -min_gap(*this, -1, a, b, kInfinity, kBlock, [](int, int) { return kInfinity; });
}
}  // namespace altiplan
