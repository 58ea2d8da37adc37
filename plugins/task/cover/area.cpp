// SPDX-License-Identifier: Apache-2.0
#include "area.hpp"

#include "altiplan/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan::cover {
namespace {

/// What counts as touching, metres: below the judge's tolerance.
constexpr double kTouch = 1e-7;

double cross(const Point2& a, const Point2& b) { return a.x() * b.y() - a.y() * b.x(); }

bool ring_contains(const Ring2& ring, const Point2& p) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Point2& a = ring[i];
    const Point2& b = ring[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) {
      inside = !inside;
    }
  }
  return inside;
}

Point2 nearest_of(const Ring2& ring, const Point2& p) {
  Point2 nearest = ring[0];
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Point2 way = ring[i] - ring[j];
    const double t =
        std::clamp((p - ring[j]).dot(way) / std::max(way.squaredNorm(), 1e-30), 0.0, 1.0);
    const Point2 there = ring[j] + t * way;
    if ((there - p).squaredNorm() < (nearest - p).squaredNorm()) {
      nearest = there;
    }
  }
  return nearest;
}

double ring_distance(const Ring2& ring, const Point2& p) {
  return (nearest_of(ring, p) - p).norm();
}

/// True if the leg is on the forbidden side of the ring somewhere by more than kTouch: inside, or
/// of an outline outside.
bool crosses(const Ring2& ring, bool is_outline, const Point2& a, const Point2& b) {
  const Point2 way = b - a;
  const double length = way.norm();
  const auto forbidden = [&](const Point2& p) {
    return ring_contains(ring, p) != is_outline && ring_distance(ring, p) > kTouch;
  };
  if (length < kTouch) {
    return forbidden(a);
  }
  const Point2 normal(-way.y() / length, way.x() / length);
  std::vector<double> cuts;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Point2& p = ring[j];
    const Point2& q = ring[i];
    const double sp = normal.dot(p - a);
    const double sq = normal.dot(q - a);
    if ((sp > kTouch && sq > kTouch) || (sp < -kTouch && sq < -kTouch)) {
      continue;
    }
    const Point2 edge = q - p;
    const double edge_length = edge.norm();
    const double sa = cross(edge, a - p) / edge_length;
    const double sb = cross(edge, b - p) / edge_length;
    if ((sa > kTouch && sb > kTouch) || (sa < -kTouch && sb < -kTouch)) {
      continue;
    }
    if (std::min(sp, sq) < -kTouch && std::max(sp, sq) > kTouch && std::min(sa, sb) < -kTouch &&
        std::max(sa, sb) > kTouch) {
      return true;
    }
    cuts.push_back(std::clamp(way.dot(p - a) / (length * length), 0.0, 1.0));
    cuts.push_back(std::clamp(way.dot(q - a) / (length * length), 0.0, 1.0));
    if (std::abs(sa - sb) > 1e-12) {
      cuts.push_back(std::clamp(sa / (sa - sb), 0.0, 1.0));
    }
  }
  if (cuts.empty()) {
    return forbidden(a + 0.5 * way);
  }
  cuts.push_back(0);
  cuts.push_back(1);
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    if ((cuts[i] - cuts[i - 1]) * length > kTouch &&
        forbidden(a + 0.5 * (cuts[i] + cuts[i - 1]) * way)) {
      return true;
    }
  }
  return false;
}

double twice_area(const Ring2& ring) {
  double sum = 0;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    sum += cross(ring[j], ring[i]);
  }
  return sum;
}
}  // namespace

Area::Area(Ring2 outline, std::vector<Ring2> islands) {
  rings_.push_back(std::move(outline));
  for (Ring2& island : islands) {
    rings_.push_back(std::move(island));
  }
  for (const Ring2& ring : rings_) {
    Point2 low = ring[0];
    Point2 high = ring[0];
    for (const Point2& p : ring) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    boxes_.emplace_back(low, high);
  }
  const double sense = twice_area(rings_[0]);
  is_convex_ = true;
  const std::size_t n = rings_[0].size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 before = rings_[0][(i + 1) % n] - rings_[0][i];
    const Point2 after = rings_[0][(i + 2) % n] - rings_[0][(i + 1) % n];
    is_convex_ = is_convex_ && cross(before, after) * sense >= 0;
  }
}

double Area::square_metres() const {
  double sum = std::abs(twice_area(rings_[0]));
  for (std::size_t i = 1; i < rings_.size(); ++i) {
    sum -= std::abs(twice_area(rings_[i]));
  }
  return sum / 2;
}

bool Area::contains(const Point2& p) const {
  if (!ring_contains(rings_[0], p)) {
    return false;
  }
  for (std::size_t i = 1; i < rings_.size(); ++i) {
    const auto& [low, high] = boxes_[i];
    if (p.x() >= low.x() && p.x() <= high.x() && p.y() >= low.y() && p.y() <= high.y() &&
        ring_contains(rings_[i], p)) {
      return false;
    }
  }
  return true;
}

bool Area::is_outside(const Point2& p) const {
  return !ring_contains(rings_[0], p) && ring_distance(rings_[0], p) > kTouch;
}

Point2 Area::nearest(const Point2& p) const { return nearest_of(rings_[0], p); }

bool Area::sees(const Point2& a, const Point2& b) const {
  const Point2 low = a.cwiseMin(b);
  const Point2 high = a.cwiseMax(b);
  const auto& [area_low, area_high] = boxes_[0];
  if ((low.array() < area_low.array() - kTouch).any() ||
      (high.array() > area_high.array() + kTouch).any()) {
    return false;
  }
  for (std::size_t i = 1; i < rings_.size(); ++i) {
    const auto& [ring_low, ring_high] = boxes_[i];
    if ((low.array() <= ring_high.array()).all() && (high.array() >= ring_low.array()).all() &&
        crosses(rings_[i], false, a, b)) {
      return false;
    }
  }
  // A leg between points of a convex area stays in it.
  return is_convex_ || !crosses(rings_[0], true, a, b);
}

std::vector<std::pair<double, double>> Area::along_row(double y) const {
  std::vector<double> cuts;
  for (const Ring2& ring : rings_) {
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const Point2& a = ring[j];
      const Point2& b = ring[i];
      if ((a.y() > y) != (b.y() > y)) {
        cuts.push_back(a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()));
      }
    }
  }
  std::sort(cuts.begin(), cuts.end());
  std::vector<std::pair<double, double>> parts;
  for (std::size_t i = 0; i + 1 < cuts.size(); i += 2) {
    parts.emplace_back(cuts[i], cuts[i + 1]);
  }
  return parts;
}

Point2 turned(const Point2& p, double angle) {
  // Quarters are exact.
  const double quarters = angle / (kPi / 2);
  const double whole = std::round(quarters);
  if (quarters == whole) {
    const int n = ((int(whole) % 4) + 4) % 4;
    return n == 0   ? p
           : n == 1 ? Point2(-p.y(), p.x())
           : n == 2 ? Point2(-p)
                    : Point2(p.y(), -p.x());
  }
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * p.x() - s * p.y(), s * p.x() + c * p.y()};
}

Area Area::turned(double angle) const {
  std::vector<Ring2> rings = rings_;
  for (Ring2& ring : rings) {
    for (Point2& p : ring) {
      p = cover::turned(p, angle);
    }
  }
  Ring2 outline = rings[0];
  rings.erase(rings.begin());
  return {std::move(outline), std::move(rings)};
}
}  // namespace altiplan::cover
