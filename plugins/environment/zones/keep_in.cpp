// SPDX-License-Identifier: Apache-2.0
#include "keep_in.hpp"

#include <algorithm>

#include "breaks.hpp"

namespace altiplan::zones {
namespace {

using Point2 = std::array<double, 2>;

// Rounding of a depth, metres.
constexpr double kRounding = 1e-9;

bool is_convex(const Shape& shape) {
  const auto* prism = std::get_if<Prism>(&shape);
  if (prism == nullptr) {
    return true;
  }
  bool left = false;
  bool right = false;
  const std::size_t size = prism->outline.size();
  for (std::size_t n = 0; n < size; ++n) {
    const Point2& p = prism->outline[n];
    const Point2& q = prism->outline[(n + 1) % size];
    const Point2& r = prism->outline[(n + 2) % size];
    const double turn = (q[0] - p[0]) * (r[1] - q[1]) - (q[1] - p[1]) * (r[0] - q[0]);
    left |= turn > 0;
    right |= turn < 0;
  }
  return prism->holes.empty() && !(left && right);
}

// True if a convex zone is at least `depth` deep all over the box: depth is a concave function, so
// the corners decide.
bool holds_box(const kit::ObstacleSet& zone, const Box& box, double depth) {
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1 ? box.max : box.min).x(), (corner & 2 ? box.max : box.min).y(),
                 (corner & 4 ? box.max : box.min).z());
    if (-zone.clearance(p) < depth - kRounding) {
      return false;
    }
  }
  return true;
}
}  // namespace

bool KeepIn::blocked(const Vec3& a, const Vec3& b, double r) const {
  const double depth = r - kLengthTolerance;
  if (clearance((a + b) / 2) >= depth + (b - a).norm() / 2) {
    return false;
  }
  Breaks breaks(a, b, depth);
  for (const Shape& zone : zones_.shapes()) {
    breaks.add(zone);
  }
  // Between two breaks each zone is deep enough everywhere or nowhere: the middle decides.
  const std::vector<double> shares = breaks.sorted();
  for (std::size_t n = 0; n + 1 < shares.size(); ++n) {
    if (clearance(a + (shares[n] + shares[n + 1]) / 2 * (b - a)) < depth - kRounding) {
      return true;
    }
  }
  return false;
}

Nearby KeepIn::nearest(const Vec3& p) const {
  const auto& zones = zones_.shapes();
  const auto zone = std::min_element(zones.begin(), zones.end(), [&](const auto& x, const auto& y) {
    return signed_distance(x, p) < signed_distance(y, p);
  });
  const double distance = -signed_distance(*zone, p);
  const Vec3 point = nearest_surface_point(*zone, p);
  const Vec3 normal = distance < 0 ? Vec3(point - p) : Vec3(p - point);
  const double length = normal.norm();
  return {point, distance, length > 0 ? Vec3(normal / length) : Vec3(0, 0, 1), 0};
}

void KeepIn::rasterize(VoxelGrid& grid) const {
  const GridSpec& spec = grid.spec();
  const double inflation = spec.inflation;
  const bool centre_rule = spec.rule == GridSpec::Rule::centre;
  const double half_diagonal = spec.cell.norm() / 2;
  std::vector<kit::ObstacleSet> convex;
  for (const Shape& zone : zones_.shapes()) {
    if (is_convex(zone)) {
      convex.emplace_back(std::vector<Shape>{zone});
    }
  }
  const auto is_free = [&](const Cell& c) {
    const double depth = clearance(spec.centre(c));
    if (centre_rule) {
      return depth > inflation;
    }
    const Box box = spec.cell_box(c);
    return depth >= inflation + half_diagonal ||
           (depth >= inflation - kRounding &&
            std::any_of(convex.begin(), convex.end(),
                        [&](const auto& zone) { return holds_box(zone, box, inflation); }));
  };
  for (int k = 0; k < spec.counts[2]; ++k) {
    for (int j = 0; j < spec.counts[1]; ++j) {
      grid.ask_watch();
      for (int i = 0; i < spec.counts[0]; ++i) {
        if (!is_free({i, j, k})) {
          grid.block_run(i, i, j, k);
        }
      }
    }
  }
}
}  // namespace altiplan::zones
