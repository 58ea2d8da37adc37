// SPDX-License-Identifier: Apache-2.0
#include "ground_zones.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/kit/layers/solid.hpp"
#include "altiplan/swept_volume.hpp"
#include "breaks.hpp"

namespace altiplan::zones {
namespace {

std::vector<Shape> outlines_of(const std::vector<GroundPrism>& prisms) {
  std::vector<Shape> outlines;
  outlines.reserve(prisms.size());
  for (const GroundPrism& prism : prisms) {
    outlines.emplace_back(Prism{prism.prism.outline, prism.prism.holes});
  }
  return outlines;
}

Vec3 within(const Box& area, Vec3 p) {
  p.x() = std::clamp(p.x(), area.min.x(), area.max.x());
  p.y() = std::clamp(p.y(), area.min.y(), area.max.y());
  return p;
}

/// Calls part(from, to) for the parts of the leg between sorted fractions.
template <class Part>
bool any_part(const Vec3& a, const Vec3& b, const std::vector<double>& shares, const Part& part) {
  for (std::size_t n = 0; n + 1 < shares.size(); ++n) {
    if (part(a + shares[n] * (b - a), a + shares[n + 1] * (b - a))) {
      return true;
    }
  }
  return false;
}

double highest_ground(const World& world) {
  double top = -kInfinity;
  for (const Layer& layer : world.layers()) {
    if (layer.environment->ground() != nullptr) {
      top = std::max(top, layer.environment->bounds().max.z());
    }
  }
  return top;
}
}  // namespace

GroundZones::GroundZones(World ground, std::vector<GroundPrism> prisms)
    : ground_(std::move(ground)), outlines_(outlines_of(prisms)) {
  for (GroundPrism& prism : prisms) {
    zones_.push_back(zone_of(ground_, std::move(prism)));
    bounds_ = bounds_.united(zones_.back().bounds);
  }
}

GroundZones::Zone GroundZones::zone_of(const World& ground, GroundPrism&& prism) {
  Zone zone;
  zone.outline = Prism{prism.prism.outline, prism.prism.holes};
  zone.area = altiplan::bounds(zone.outline);
  zone.bounds = zone.area;
  zone.bounds.min.z() = prism.prism.floor;
  zone.bounds.max.z() = std::isfinite(prism.above_ceiling)
                            ? highest_ground(ground) + prism.above_ceiling
                            : prism.prism.ceiling;
  zone.slope = prism.slope;
  zone.steepness = std::hypot(1, zone.slope);
  zone.limits = std::move(prism);
  return zone;
}

double GroundZones::distance(const Zone& zone, const Vec3& p) const {
  const GroundPrism& limits = zone.limits;
  double maximum = std::max(
      {signed_distance(zone.outline, p), limits.prism.floor - p.z(), p.z() - limits.prism.ceiling});
  const Vec3 over = within(zone.area, p);
  if (const auto ground = ground_.ground(over.x(), over.y())) {
    const double above = p.z() - *ground;
    maximum = std::max({maximum, (limits.above_floor - above) / zone.steepness,
                        (above - limits.above_ceiling) / zone.steepness});
  }
  return maximum;
}

double GroundZones::clearance(const Vec3& p) const {
  double minimum = kInfinity;
  // No zone is nearer than its outline.
  double reach = std::max(outlines_.clearance(p), 0.0);
  const auto take = [&](const Nearby& outline) {
    minimum = std::min(minimum, distance(zones_[std::size_t(outline.id)], p));
  };
  outlines_.near(p, reach, take);
  if (minimum > reach) {
    reach = minimum;
    outlines_.near(p, reach, take);
  }
  return minimum;
}

bool GroundZones::blocked(const Vec3& a, const Vec3& b, double r) const {
  if (!outlines_.blocked(a, b, r)) {
    return false;
  }
  const auto meets = [&](const Zone& zone) {
    const double reach = std::max(r, 0.0) * zone.steepness + kLengthTolerance;
    return kit::may_reach(zone.bounds, a, b, reach) && meets_leg(zone, a, b, r);
  };
  constexpr std::size_t kFew = 32;
  if (zones_.size() <= kFew) {
    return std::any_of(zones_.begin(), zones_.end(), meets);
  }
  bool found = false;
  const double around = (b - a).norm() / 2 + std::max(r, 0.0) + kLengthTolerance;
  outlines_.near((a + b) / 2, around, [&](const Nearby& outline) {
    found = found || meets(zones_[std::size_t(outline.id)]);
  });
  return found;
}

bool GroundZones::meets_leg(const Zone& zone, const Vec3& a, const Vec3& b, double r) const {
  const double keep = r - kLengthTolerance;
  Breaks breaks(a, b, keep);
  breaks.add(zone.outline);
  return any_part(a, b, breaks.sorted(), [&](const Vec3& from, const Vec3& to) {
    return signed_distance(zone.outline, (from + to) / 2) < keep &&
           meets_part(zone, from, to, keep);
  });
}

/// Of a part that is near enough to the outline everywhere.
bool GroundZones::meets_part(const Zone& zone, const Vec3& a, const Vec3& b, double keep) const {
  const double floor = zone.limits.prism.floor - keep;
  const double ceiling = zone.limits.prism.ceiling + keep;
  std::vector<double> shares{0, 1};
  const auto add = [&](double share) {
    if (share > 0 && share < 1) {
      shares.push_back(share);
    }
  };
  add((floor - a.z()) / (b.z() - a.z()));
  add((ceiling - a.z()) / (b.z() - a.z()));
  for (int axis = 0; axis < 2; ++axis) {
    add((zone.area.min[axis] - a[axis]) / (b[axis] - a[axis]));
    add((zone.area.max[axis] - a[axis]) / (b[axis] - a[axis]));
  }
  std::sort(shares.begin(), shares.end());
  return any_part(a, b, shares, [&](const Vec3& from, const Vec3& to) {
    const double z = (from.z() + to.z()) / 2;
    return z > floor && z < ceiling && meets_over_ground(zone, from, to, keep);
  });
}

/// Of a part within the limits above the sea, all of it over the area or all beside it.
bool GroundZones::meets_over_ground(const Zone& zone, const Vec3& a, const Vec3& b,
                                    double keep) const {
  const Vec3 from = within(zone.area, a);
  const Vec3 to = within(zone.area, b);
  double more = keep;
  if (keep > 0) {
    const Box near = leg_box(from, to).grown(keep).intersected(zone.area);
    more *= std::hypot(1, std::min(ground_.ground_slope(near), zone.slope));
  }
  const double floor = zone.limits.above_floor - more;
  const double ceiling = zone.limits.above_ceiling + more;
  if (!(floor < ceiling)) {
    return false;
  }
  // Without ground below part of the leg the gap is -infinity: the zone is closed there.
  const double gap = ground_.ground_gap(from, to);
  return gap == -kInfinity ||
         (gap < ceiling && (floor == -kInfinity || ground_.ground_gap_max(from, to) > floor));
}

bool GroundZones::meets(const SweptVolume& volume) const {
  return !empty() && meets_by_clearance(
                         volume, [this](const Vec3& p) { return clearance(p); }, kBodyTolerance);
}

void GroundZones::near(const Vec3& p, double reach, int first_id, const NearSink& sink) const {
  outlines_.near(p, reach, [&](const Nearby& outline) {
    const Zone& zone = zones_[std::size_t(outline.id)];
    const double away = distance(zone, p);
    if (away > reach) {
      return;
    }
    constexpr double kStep = 1e-3;
    Vec3 normal;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = kStep * Vec3::Unit(axis);
      normal[axis] = distance(zone, p + step) - distance(zone, p - step);
    }
    normal = normal.squaredNorm() > 0 ? Vec3(normal.normalized()) : Vec3(0, 0, 1);
    sink({p - normal * away, away, normal, first_id + outline.id});
  });
}

void GroundZones::rasterize(VoxelGrid& grid) const {
  for (const Zone& zone : zones_) {
    // Cells in doubt are blocked.
    kit::rasterize(
        grid, zone.bounds, [&](const Vec3& p) { return distance(zone, p); },
        [](const Box&, double) { return true; });
  }
}

double GroundZones::over_approximation(double r) const {
  double maximum = 0;
  for (const Zone& zone : zones_) {
    // A point r from the outline, and r √(1 + s²) above a limit that is s r higher at the outline.
    maximum = std::max(maximum, r * (std::hypot(1, zone.steepness + zone.slope) - 1));
  }
  return maximum;
}

Shape GroundZones::drawn(std::size_t zone) const {
  constexpr int kPoints = 4;
  const GroundPrism& prism = zones_[zone].limits;
  const Box area = altiplan::bounds(Shape(prism.prism));
  double low = kInfinity;
  double high = -kInfinity;
  for (int i = 0; i <= kPoints; ++i) {
    for (int j = 0; j <= kPoints; ++j) {
      const double x = area.min.x() + (area.max.x() - area.min.x()) * i / kPoints;
      const double y = area.min.y() + (area.max.y() - area.min.y()) * j / kPoints;
      if (const auto height = ground_.ground(x, y)) {
        low = std::min(low, *height);
        high = std::max(high, *height);
      }
    }
  }
  Prism shape = prism.prism;
  shape.floor = std::isfinite(prism.above_floor) ? low + prism.above_floor : shape.floor;
  shape.ceiling = std::isfinite(prism.above_ceiling) ? high + prism.above_ceiling : shape.ceiling;
  return shape;
}
}  // namespace altiplan::zones
