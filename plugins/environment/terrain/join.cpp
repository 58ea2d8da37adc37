// SPDX-License-Identifier: Apache-2.0
#include "join.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace terrain {
namespace {

using altiplan::HeightField;
using XY = std::array<double, 2>;

/// Fraction of a spacing within which two positions are the same.
constexpr double kSameShare = 1e-3;

/// Highest ground of the layers, including those that end at most `within` before the position; NaN
/// if there is none.
double ground_about(const altiplan::World& world, double x, double y, double within) {
  double highest = NAN;
  for (const altiplan::Layer& layer : world.layers()) {
    const altiplan::Box box = layer.environment->bounds();
    const altiplan::Vec3 at(x, y, 0);
    const altiplan::Vec3 in = at.cwiseMax(box.min).cwiseMin(box.max);
    const altiplan::Ground* ground = layer.environment->ground();
    if (ground != nullptr && (in - at).head<2>().norm() <= within) {
      if (const auto height = ground->height(in.x(), in.y())) {
        highest = std::fmax(highest, *height);
      }
    }
  }
  return highest;
}

/// True if some ground ends between one spacing beyond the side and the side itself; ground that
/// continues below the model needs no joining.
bool ends_before(const altiplan::World& world, int axis, double side, double outer) {
  return std::any_of(world.layers().begin(), world.layers().end(),
                     [&](const altiplan::Layer& layer) {
                       const altiplan::Box box = layer.environment->bounds();
                       const double end = outer < side ? box.max[axis] : box.min[axis];
                       const double slack = kSameShare * std::abs(outer - side);
                       return layer.environment->ground() != nullptr && end != side &&
                              (outer < side ? end < side && end >= outer - slack
                                            : end > side && end <= outer + slack);
                     });
}

/// The field with an extra row or column on one side, if neighbouring ground covers all of it. A
/// corner that no layer has yet (its tile comes later) gets the height of the adjacent post.
std::optional<HeightField> joined(const HeightField& field, const altiplan::World& world, int axis,
                                  bool at_end) {
  const int columns = field.columns();
  const int rows = field.rows();
  const int last = (axis == 0 ? columns : rows) - 1;
  const double step = field.spacing()[axis];
  const double side = field.origin()[axis] + (at_end ? last * step : 0);
  const double outer = side + (at_end ? step : -step);
  if (!ends_before(world, axis, side, outer)) {
    return std::nullopt;
  }
  const int along = axis == 0 ? rows : columns;
  const double within = kSameShare * std::max(field.spacing()[0], field.spacing()[1]);
  std::vector<float> more;
  for (int n = 0; n < along; ++n) {
    const double at = field.origin()[1 - axis] + n * field.spacing()[1 - axis];
    const XY p = axis == 0 ? XY{outer, at} : XY{at, outer};
    more.push_back(float(ground_about(world, p[0], p[1], within)));
  }
  for (const int n : {1, 0}) {  // the most that joining may have added to a side
    if (along > 4 && std::isnan(more[std::size_t(n)])) {
      more[std::size_t(n)] = more[std::size_t(n) + 1];
    }
    if (along > 4 && std::isnan(more[std::size_t(along - 1 - n)])) {
      more[std::size_t(along - 1 - n)] = more[std::size_t(along - 2 - n)];
    }
  }
  if (std::any_of(more.begin(), more.end(), [](float h) { return std::isnan(h); })) {
    return std::nullopt;
  }
  const int shift_i = axis == 0 && !at_end ? 1 : 0;
  const int shift_j = axis == 1 && !at_end ? 1 : 0;
  std::vector<float> heights;
  for (int j = 0; j < rows + axis; ++j) {
    for (int i = 0; i < columns + 1 - axis; ++i) {
      const int from_i = i - shift_i;
      const int from_j = j - shift_j;
      const bool own = from_i >= 0 && from_j >= 0 && from_i < columns && from_j < rows;
      heights.push_back(own ? field.post(from_i, from_j) : more[std::size_t(axis == 0 ? j : i)]);
    }
  }
  XY origin = field.origin();
  origin[axis] -= at_end ? 0 : step;
  return HeightField(origin, field.spacing(), columns + 1 - axis, rows + axis, std::move(heights));
}
}  // namespace

bool may_join(const XY& origin, const XY& spacing, int columns, int rows,
              const altiplan::World& world) {
  for (const int axis : {0, 1}) {
    const double step = spacing[std::size_t(axis)];
    const double low = origin[std::size_t(axis)];
    const double high = low + ((axis == 0 ? columns : rows) - 1) * step;
    if (ends_before(world, axis, low, low - step) || ends_before(world, axis, high, high + step)) {
      return true;
    }
  }
  return false;
}

bool join(HeightField& field, const altiplan::World& world) {
  bool any = false;
  for (const int axis : {0, 1}) {
    for (const bool at_end : {false, true}) {
      // Twice if rounding leaves the first row short of the neighbour.
      for (int n = 0; n < 2; ++n) {
        if (auto wider = joined(field, world, axis, at_end)) {
          field = std::move(*wider);
          any = true;
        }
      }
    }
  }
  return any;
}
}  // namespace terrain
