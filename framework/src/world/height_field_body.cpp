// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "altiplan/height_field.hpp"
#include "altiplan/swept_volume.hpp"

#include "height_patch.hpp"

namespace altiplan {
namespace {

/// The ground below a rectangle: of a cell, or a part of it.
struct Column {
  std::array<double, 2> min;
  std::array<double, 2> max;
  Patch tops;
};

/// True if the volume reaches into the column. The convex hull of its corners contains it, and more
/// by at most a quarter of its twist, which a quarter of its area has a quarter of.
bool reaches_into(const SweptVolume& volume, const Column& column) {
  const Patch& p = column.tops;
  const Box& box = volume.box();
  if (p.max() < box.min.z() || column.min[0] > box.max.x() || column.max[0] < box.min.x() ||
      column.min[1] > box.max.y() || column.max[1] < box.min.y()) {
    return false;
  }
  const double floor = std::min({p.sw, p.se, p.nw, p.ne, box.min.z()}) - 1;
  const std::array<Vec3, 8> corners{
      Vec3(column.min[0], column.min[1], p.sw),  Vec3(column.max[0], column.min[1], p.se),
      Vec3(column.min[0], column.max[1], p.nw),  Vec3(column.max[0], column.max[1], p.ne),
      Vec3(column.min[0], column.min[1], floor), Vec3(column.max[0], column.min[1], floor),
      Vec3(column.min[0], column.max[1], floor), Vec3(column.max[0], column.max[1], floor)};
  if (!volume.meets(corners)) {
    return false;
  }
  if (std::abs(p.sw + p.ne - p.se - p.nw) / 4 <= kBodyTolerance / 2) {
    return true;
  }
  const double x = (column.min[0] + column.max[0]) / 2;
  const double y = (column.min[1] + column.max[1]) / 2;
  const double south = p.at(0.5, 0);
  const double north = p.at(0.5, 1);
  const double west = p.at(0, 0.5);
  const double east = p.at(1, 0.5);
  const double middle = p.at(0.5, 0.5);
  return reaches_into(volume, {column.min, {x, y}, {p.sw, south, west, middle}}) ||
         reaches_into(volume,
                      {{x, column.min[1]}, {column.max[0], y}, {south, p.se, middle, east}}) ||
         reaches_into(volume,
                      {{column.min[0], y}, {x, column.max[1]}, {west, middle, p.nw, north}}) ||
         reaches_into(volume, {{x, y}, column.max, {middle, east, north, p.ne}});
}
}  // namespace

bool HeightField::meets(const SweptVolume& volume) const {
  const Box& box = volume.box();
  std::array<int, 2> first{};
  std::array<int, 2> last{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const int cells = (axis == 0 ? columns() : rows()) - 1;
    const double low = (box.min[int(axis)] - origin_[axis]) * per_m_[axis];
    const double high = (box.max[int(axis)] - origin_[axis]) * per_m_[axis];
    if (high < 0 || low > cells) {
      return false;
    }
    // One cell more, for rounding.
    first[axis] = int(std::max(0.0, std::floor(low) - 1));
    last[axis] = int(std::min(cells - 1.0, std::floor(high) + 1));
  }
  for (int j = first[1]; j <= last[1]; ++j) {
    for (int i = first[0]; i <= last[0]; ++i) {
      const Patch tops{post(i, j), post(i + 1, j), post(i, j + 1), post(i + 1, j + 1)};
      const double x = origin_[0] + i * spacing_[0];
      const double y = origin_[1] + j * spacing_[1];
      if (tops.has_ground() &&
          reaches_into(volume, {{x, y}, {x + spacing_[0], y + spacing_[1]}, tops})) {
        return true;
      }
    }
  }
  return false;
}
}  // namespace altiplan
