// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/layers/ground_body.hpp"

#include <algorithm>

namespace altiplan::kit {
namespace {

/// Cells of an axis that a volume may reach, first and last.
std::array<int, 2> cells_near(double low, double high, double origin, double spacing, int posts) {
  const auto cell = [&](double at) {
    return int(std::clamp(std::floor((at - origin) / spacing), -1.0, double(posts)));
  };
  // One cell more, for rounding.
  return {std::max(0, cell(low) - 1), std::min(posts - 2, cell(high) + 1)};
}
}  // namespace

bool meets_below(const SweptVolume& volume, const GroundPiece& piece, double half_x, double half_y,
                 double up) {
  const double low = volume.box().min.z();
  const auto height = [&](double x, double y) {
    return std::min(piece.z + x * piece.dx + y * piece.dy + up, piece.top);
  };
  std::array<Vec3, 8> corners;
  double highest = -kInfinity;
  double lowest = low;
  for (int n = 0; n < 4; ++n) {
    const double x = (n & 1) != 0 ? half_x : -half_x;
    const double y = (n & 2) != 0 ? half_y : -half_y;
    corners[std::size_t(n)] = {piece.x + x, piece.y + y, height(x, y)};
    highest = std::max(highest, height(x, y));
    lowest = std::min(lowest, height(x, y));
  }
  if (highest < low) {
    return false;
  }
  for (std::size_t n = 0; n < 4; ++n) {
    corners[n + 4] = {corners[n].x(), corners[n].y(), lowest - 1};
  }
  return volume.meets(corners);
}

bool meets_ground(const SweptVolume& volume, const HeightField& field) {
  const Box& box = volume.box();
  const double dx = field.spacing()[0];
  const double dy = field.spacing()[1];
  const auto& [left, south] = field.origin();
  const auto columns = cells_near(box.min.x(), box.max.x(), left, dx, field.columns());
  const auto rows = cells_near(box.min.y(), box.max.y(), south, dy, field.rows());
  for (int j = rows[0]; j <= rows[1]; ++j) {
    for (int i = columns[0]; i <= columns[1]; ++i) {
      const double sw = field.post(i, j);
      const double se = field.post(i + 1, j);
      const double nw = field.post(i, j + 1);
      const double ne = field.post(i + 1, j + 1);
      if (!(std::max({sw, se, nw, ne}) >= box.min.z()) || std::isnan(sw + se + nw + ne)) {
        continue;
      }
      const double x = left + i * dx;
      const double y = south + j * dy;
      const double twist = ne - se - nw + sw;
      const auto piece_of = [&](double x0, double y0, double x1, double y1) {
        const double s = ((x0 + x1) / 2 - x) / dx;
        const double w = ((y0 + y1) / 2 - y) / dy;
        const double z = sw + s * (se - sw) + w * (nw - sw) + s * w * twist;
        return GroundPiece{(x0 + x1) / 2,
                           (y0 + y1) / 2,
                           z,
                           (se - sw + w * twist) / dx,
                           (nw - sw + s * twist) / dy,
                           std::abs(twist) * (x1 - x0) / dx * (y1 - y0) / dy / 4};
      };
      if (meets_ground(volume, x, y, x + dx, y + dy, piece_of)) {
        return true;
      }
    }
  }
  return false;
}
}  // namespace altiplan::kit
