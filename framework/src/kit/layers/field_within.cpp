// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/layers/field_within.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace altiplan::kit {
namespace {

/// Cells are numbered in the whole grid, so that a part gives the same results as the whole.
class Cells {
 public:
  Cells(GroundWithin& ground, const HeightField& field) : ground_(ground), field_(field) {}

  /// Searches the cells from i0, j0 up to, but excluding, i1, j1; first the half with that
  /// position.
  void search(int i0, int j0, int i1, int j1, const Vec3& towards) {
    if (i1 - i0 == 1 && j1 - j0 == 1) {
      search_cell(i0, j0);
      return;
    }
    const double x0 = east(i0);
    const double y0 = north(j0);
    const double x1 = east(i1);
    const double y1 = north(j1);
    const bool is_small = std::max(i1 - i0, j1 - j0) < HeightField::kBlock;
    const double top = is_small ? highest_post(i0, j0, i1, j1) : field_.max_height(x0, y0, x1, y1);
    if (!ground_.may_be_in(x0, y0, x1, y1, top)) {
      return;
    }
    const int i = (i0 + i1) / 2;
    const int j = (j0 + j1) / 2;
    if (i1 - i0 > j1 - j0) {
      const bool in_east = towards.x() > east(i);
      search(in_east ? i : i0, j0, in_east ? i1 : i, j1, towards);
      search(in_east ? i0 : i, j0, in_east ? i : i1, j1, towards);
    } else {
      const bool in_north = towards.y() > north(j);
      search(i0, in_north ? j : j0, i1, in_north ? j1 : j, towards);
      search(i0, in_north ? j0 : j, i1, in_north ? j : j1, towards);
    }
  }

 private:
  double east(int i) const { return field_.whole_origin()[0] + i * field_.spacing()[0]; }
  double north(int j) const { return field_.whole_origin()[1] + j * field_.spacing()[1]; }

  double highest_post(int i0, int j0, int i1, int j1) const {
    float highest = -std::numeric_limits<float>::infinity();
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i) {  // a comparison with a void is false
        const float post = field_.post(i - field_.part().column, j - field_.part().row);
        highest = post > highest ? post : highest;
      }
    }
    return double(highest);
  }

  void search_cell(int column, int row) {
    const int i = column - field_.part().column;
    const int j = row - field_.part().row;
    const double sw = field_.post(i, j);
    const double to_east = field_.post(i + 1, j) - sw;
    const double to_north = field_.post(i, j + 1) - sw;
    const double twist = field_.post(i + 1, j + 1) - sw - to_east - to_north;
    if (std::isnan(twist)) {
      return;  // no ground
    }
    const double x = east(column);
    const double y = north(row);
    const auto [dx, dy] = field_.spacing();
    ground_.search(
        x, y, east(column + 1), north(row + 1),
        [&, dx = dx, dy = dy](double x0, double y0, double x1, double y1) -> GroundPiece {
          const double s = ((x0 + x1) / 2 - x) / dx;
          const double w = ((y0 + y1) / 2 - y) / dy;
          // Bilinear: deviates from its plane by the twist times the distances along both axes.
          return {(x0 + x1) / 2,
                  (y0 + y1) / 2,
                  sw + s * to_east + w * to_north + s * w * twist,
                  (to_east + w * twist) / dx,
                  (to_north + s * twist) / dy,
                  std::abs(twist) * (x1 - x0) / dx * (y1 - y0) / dy / 4};
        });
  }

  GroundWithin& ground_;
  const HeightField& field_;
};
}  // namespace

void search_field(GroundWithin& ground, const HeightField& field) {
  const Box box = ground.reach();
  const HeightField::Part& part = field.part();
  const auto cell = [&](double at, std::size_t axis, int first, int posts) {
    const double units = std::floor((at - field.whole_origin()[axis]) / field.spacing()[axis]);
    return int(std::clamp(units, double(first), double(first + posts - 2)));
  };
  Cells(ground, field)
      .search(cell(box.min.x(), 0, part.column, part.columns),
              cell(box.min.y(), 1, part.row, part.rows),
              cell(box.max.x(), 0, part.column, part.columns) + 1,
              cell(box.max.y(), 1, part.row, part.rows) + 1, (box.min + box.max) / 2);
}
}  // namespace altiplan::kit
