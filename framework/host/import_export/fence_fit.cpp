// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/fence_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "altiplan/geometry.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {
namespace {

using formats::Point2;
using formats::Ring;
using formats::Zone;

constexpr double kMetresPerDegree = 111'320;
/// Narrower simplifications are made even where the fence fits, metres: positions are no better.
constexpr double kFreeWidth = 1.5;
/// A corner nearer than that to the line between its neighbours is none, metres.
constexpr double kStraight = 0.001;
/// Corners of the polygon around a circle that becomes part of a larger zone.
constexpr int kCircleCorners = 12;
/// A zone is joined with one of so many that are nearest.
constexpr std::size_t kNeighbours = 6;

double twice_area(const Point2& a, const Point2& b, const Point2& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
}

/// The closed triangle, in either orientation.
bool triangle_holds(const Point2& a, const Point2& b, const Point2& c, const Point2& p) {
  const double u = twice_area(a, b, p);
  const double v = twice_area(b, c, p);
  const double w = twice_area(c, a, p);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

/// True if the segments have a point in common.
bool cross_each_other(const Point2& a, const Point2& b, const Point2& p, const Point2& q) {
  if (std::max(a[0], b[0]) < std::min(p[0], q[0]) || std::max(p[0], q[0]) < std::min(a[0], b[0]) ||
      std::max(a[1], b[1]) < std::min(p[1], q[1]) || std::max(p[1], q[1]) < std::min(a[1], b[1])) {
    return false;
  }
  return twice_area(a, b, p) * twice_area(a, b, q) <= 0 &&
         twice_area(p, q, a) * twice_area(p, q, b) <= 0;
}

double ring_area(const Ring& ring) {
  double twice = 0;
  for (std::size_t n = 1; n + 1 < ring.size(); ++n) {
    twice += twice_area(ring[0], ring[n], ring[n + 1]);
  }
  return twice / 2;
}

/// A triangle added to what a ring closes: corner `at` and, if `corners` is 2, the next are
/// replaced by `apex`, or corner `at` by nothing.
struct Growth {
  double area = kInfinity;
  double width = 0;  ///< of the triangle beside the edge that goes
  std::size_t at = 0;
  std::optional<Point2> apex{};
};

/// A ring in metres east and north, counter-clockwise around what it closes: a keep-out zone, or
/// all but a keep-in zone, which then is clockwise itself. What is closed only grows.
class ClosingRing {
 public:
  ClosingRing(Ring ring, bool is_keep_in, const Ring& route)
      : ring_(std::move(ring)), route_(&route) {
    if ((ring_area(ring_) > 0) == is_keep_in) {
      std::reverse(ring_.begin(), ring_.end());
    }
  }

  const Ring& ring() const { return ring_; }
  /// The least growth that is possible; its area is infinite if there is none.
  const Growth& best() {
    if (!best_) {
      best_ = find();
    }
    return *best_;
  }
  void grow() {
    const Growth growth = best();
    const std::size_t next = (growth.at + 1) % ring_.size();
    if (growth.apex) {
      ring_[growth.at] = *growth.apex;
      ring_.erase(ring_.begin() + std::ptrdiff_t(next));
    } else {
      ring_.erase(ring_.begin() + std::ptrdiff_t(growth.at));
    }
    best_.reset();
  }

 private:
  const Point2& corner(std::size_t n) const { return ring_[n % ring_.size()]; }

  Growth find() const {
    std::vector<Growth> all;
    if (ring_.size() <= 3) {
      return {};
    }
    for (std::size_t n = 0; n < ring_.size(); ++n) {
      if (const auto growth = without_corner(n)) {
        all.push_back(*growth);
      }
      if (const auto growth = without_edge(n)) {
        all.push_back(*growth);
      }
    }
    const auto is_larger = [](const Growth& a, const Growth& b) { return a.area > b.area; };
    std::make_heap(all.begin(), all.end(), is_larger);
    for (; !all.empty(); all.pop_back()) {
      std::pop_heap(all.begin(), all.end(), is_larger);
      if (is_free(all.back())) {
        return all.back();
      }
    }
    return {};
  }

  /// Straight past a corner that points inward.
  std::optional<Growth> without_corner(std::size_t n) const {
    const Point2& before = corner(n + ring_.size() - 1);
    const Point2& after = corner(n + 1);
    const double twice = -twice_area(before, corner(n), after);
    const double base = std::hypot(after[0] - before[0], after[1] - before[1]);
    const double width = base > 0 ? twice / base : 0;
    if (width < -kStraight) {
      return std::nullopt;
    }
    return Growth{std::max(twice, 0.0) / 2, width, n, std::nullopt};
  }

  /// The edges before and after an edge between outward corners, extended until they meet.
  std::optional<Growth> without_edge(std::size_t n) const {
    const Point2& a = corner(n + ring_.size() - 1);
    const Point2& b = corner(n);
    const Point2& c = corner(n + 1);
    const Point2& d = corner(n + 2);
    if (twice_area(a, b, c) <= 0 || twice_area(b, c, d) <= 0) {
      return std::nullopt;
    }
    const double ux = b[0] - a[0];
    const double uy = b[1] - a[1];
    const double vx = c[0] - d[0];
    const double vy = c[1] - d[1];
    const double turn = ux * vy - uy * vx;  // negative where the lines meet ahead
    if (turn >= 0) {
      return std::nullopt;
    }
    const double along = ((c[0] - b[0]) * vy - (c[1] - b[1]) * vx) / turn;
    const Point2 apex{b[0] + along * ux, b[1] + along * uy};
    const double twice = std::abs(twice_area(b, apex, c));
    const double base = std::hypot(c[0] - b[0], c[1] - b[1]);
    if (!std::isfinite(apex[0]) || !std::isfinite(apex[1])) {
      return std::nullopt;
    }
    return Growth{twice / 2, base > 0 ? twice / base : 0, n, apex};
  }

  /// True if neither the rest of the ring nor the route is in the triangle.
  bool is_free(const Growth& growth) const {
    if (growth.width < kStraight) {
      return true;  // a corner on a straight edge
    }
    const std::size_t before = growth.apex ? growth.at : growth.at + ring_.size() - 1;
    const Point2& a = corner(before);
    const Point2 b = growth.apex ? *growth.apex : corner(growth.at);
    const Point2& c = corner(growth.at + 1);
    const auto touches = [&](const Point2& p, const Point2& q) {
      return triangle_holds(a, b, c, p) || triangle_holds(a, b, c, q) ||
             cross_each_other(a, b, p, q) || cross_each_other(b, c, p, q) ||
             cross_each_other(a, c, p, q);
    };
    for (std::size_t n = 0; n + 1 < route_->size(); ++n) {
      if (touches((*route_)[n], (*route_)[n + 1])) {
        return false;
      }
    }
    const std::size_t last = growth.at + ring_.size() - (growth.apex ? 1 : 2);
    for (std::size_t n = growth.at + 2; n <= last; ++n) {
      if (touches(corner(n), corner(std::min(n + 1, last)))) {
        return false;
      }
    }
    return true;
  }

  Ring ring_;
  const Ring* route_;
  std::optional<Growth> best_;
};

/// Two keep-out pieces as a polygon around both; `area` is what that closes more.
struct Joint {
  double area = kInfinity;
  std::size_t other = 0;  ///< index of the second
  Ring ring{};
};

/// A polygon or a circle of the fence.
struct Piece {
  ClosingRing ring;
  std::optional<Zone> circle;
  std::string name;
  bool is_keep_in = false;
  bool is_gone = false;          ///< joined with another
  std::optional<Joint> joint{};  ///< the best with another; none: to be looked for
};

Ring hull_of(Ring points) {
  std::sort(points.begin(), points.end());
  Ring hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const Point2& p : points) {
      while (hull.size() >= first + 2 && twice_area(hull[hull.size() - 2], hull.back(), p) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

class FenceFit {
 public:
  FenceFit(const std::vector<Zone>& zones, const Ring& route, const FenceLimits& limits)
      : limits_(limits), origin_(origin_of(zones)) {
    for (const Point2& p : route) {
      route_.push_back(local(p));
    }
    for (const Zone& zone : zones) {
      add(zone);
    }
  }

  void simplify() {
    for (Piece& piece : pieces_) {
      while (!piece.circle && piece.ring.best().width <= kFreeWidth &&
             std::isfinite(piece.ring.best().area)) {
        piece.ring.grow();
      }
    }
    while (!fits()) {
      std::size_t smallest = 0;
      std::size_t joined = 0;
      for (std::size_t n = 0; n < pieces_.size(); ++n) {
        smallest = growth_of(n) < growth_of(smallest) ? n : smallest;
        joined = joint_of(n).area < joint_of(joined).area ? n : joined;
      }
      if (joint_of(joined).area < growth_of(smallest)) {
        join(joined);
      } else if (std::isfinite(growth_of(smallest))) {
        grown_m2_ += growth_of(smallest);
        pieces_[smallest].ring.grow();
        forget_joints(smallest);
      } else {
        return;
      }
    }
  }

  bool fits() const {
    FenceLimits size{0, 4};
    for (const Piece& piece : pieces_) {
      if (piece.is_gone) {
        continue;
      }
      const std::size_t corners = piece.ring.ring().size();
      size.points += piece.circle ? 1 : corners;
      size.bytes += piece.circle ? 13 : 2 + 8 * corners;
    }
    return size.points <= limits_.points && size.bytes <= limits_.bytes;
  }

  std::vector<Zone> zones() const {
    std::vector<Zone> all;
    for (const Piece& piece : pieces_) {
      if (piece.is_gone) {
        continue;
      }
      Zone zone = piece.circle.value_or(Zone());
      if (!piece.circle) {
        Ring outline;
        for (const Point2& p : piece.ring.ring()) {
          outline.push_back({longitude_near(p[0] / scale_x() + origin_[0], 0),
                             p[1] / kMetresPerDegree + origin_[1]});
        }
        zone.volumes = {{{std::move(outline), {}}, {}, {}}};
        zone.name = piece.name;
        zone.restriction =
            piece.is_keep_in ? formats::Restriction::keep_in : formats::Restriction::keep_out;
      }
      all.push_back(std::move(zone));
    }
    return all;
  }

  double grown_km2() const { return grown_m2_ / 1e6; }
  std::size_t joined() const { return joined_; }

 private:
  static Point2 origin_of(const std::vector<Zone>& zones) {
    const formats::ZoneVolume& volume = zones.front().volumes.front();
    return volume.polygon.outline.empty() ? volume.centre : volume.polygon.outline.front();
  }
  double scale_x() const { return kMetresPerDegree * std::cos(radians(origin_[1])); }
  Point2 local(const Point2& lonlat) const {
    return {std::remainder(lonlat[0] - origin_[0], 360.0) * scale_x(),
            (lonlat[1] - origin_[1]) * kMetresPerDegree};
  }

  void add(const Zone& zone) {
    const formats::ZoneVolume& volume = zone.volumes.front();
    const auto add_ring = [&](const Ring& lonlat, bool is_keep_in, std::optional<Zone> circle) {
      Ring ring;
      for (const Point2& p : lonlat) {
        ring.push_back(local(p));
      }
      pieces_.push_back({ClosingRing(std::move(ring), is_keep_in, route_), std::move(circle),
                         zone.name, is_keep_in, false, std::nullopt});
    };
    if (volume.polygon.outline.empty()) {
      Ring around;  // used only where it is joined with another zone
      const double radius = volume.radius_m / std::cos(kPi / kCircleCorners);
      for (int n = 0; n < kCircleCorners; ++n) {
        around.push_back(geodesic_end(volume.centre, -360.0 * n / kCircleCorners, radius));
      }
      add_ring(around, zone.keeps_in(), zone);
      return;
    }
    add_ring(volume.polygon.outline, zone.keeps_in(), std::nullopt);
    for (const Ring& hole : volume.polygon.holes) {
      if (zone.keeps_in()) {  // those of keep-out zones are filled
        add_ring(hole, false, std::nullopt);
      }
    }
  }

  bool touches_route(const Ring& hull) const {
    for (std::size_t n = 0; n + 1 < route_.size(); ++n) {
      bool is_inside = true;
      for (std::size_t k = 0; k < hull.size(); ++k) {
        const Point2& next = hull[(k + 1) % hull.size()];
        is_inside &= twice_area(hull[k], next, route_[n]) >= 0;
        if (cross_each_other(hull[k], next, route_[n], route_[n + 1])) {
          return true;
        }
      }
      if (is_inside) {
        return true;
      }
    }
    return false;
  }

  static Point2 middle(const Ring& ring) {
    Point2 sum{0, 0};
    for (const Point2& p : ring) {
      sum = {sum[0] + p[0] / double(ring.size()), sum[1] + p[1] / double(ring.size())};
    }
    return sum;
  }

  double growth_of(std::size_t n) {
    return pieces_[n].is_gone || pieces_[n].circle ? kInfinity : pieces_[n].ring.best().area;
  }

  /// The piece with the one near it that together close the least more; infinite if there is none.
  const Joint& joint_of(std::size_t n) {
    Piece& piece = pieces_[n];
    if (piece.joint) {
      return *piece.joint;
    }
    piece.joint = Joint();
    if (piece.is_gone || piece.is_keep_in) {
      return *piece.joint;
    }
    std::vector<std::pair<double, std::size_t>> near;
    const Point2 here = middle(piece.ring.ring());
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      if (k != n && !pieces_[k].is_keep_in && !pieces_[k].is_gone) {
        const Point2 there = middle(pieces_[k].ring.ring());
        near.emplace_back(std::hypot(there[0] - here[0], there[1] - here[1]), k);
      }
    }
    const std::size_t count = std::min(near.size(), kNeighbours);
    std::partial_sort(near.begin(), near.begin() + std::ptrdiff_t(count), near.end());
    for (std::size_t k = 0; k < count; ++k) {
      consider(piece, near[k].second);
    }
    return *piece.joint;
  }

  void consider(Piece& piece, std::size_t other) const {
    const Ring& a = piece.ring.ring();
    const Ring& b = pieces_[other].ring.ring();
    Ring all = a;
    all.insert(all.end(), b.begin(), b.end());
    Ring hull = hull_of(std::move(all));
    if (touches_route(hull)) {
      return;
    }
    // Fewer corners than both had; of two circles a few, which gain with a third.
    constexpr std::size_t kOfCircles = 5;
    const std::size_t before = std::max(
        kOfCircles, (piece.circle ? 1 : a.size()) + (pieces_[other].circle ? 1 : b.size()));
    ClosingRing around(std::move(hull), false, route_);
    while (around.ring().size() >= before && std::isfinite(around.best().area)) {
      around.grow();
    }
    const double area = ring_area(around.ring()) - std::abs(ring_area(a)) - std::abs(ring_area(b));
    if (around.ring().size() < before && area < piece.joint->area) {
      piece.joint = Joint{area, other, around.ring()};
    }
  }

  /// Those with the piece, which has changed.
  void forget_joints(std::size_t changed) {
    for (std::size_t n = 0; n < pieces_.size(); ++n) {
      if (n == changed || (pieces_[n].joint && pieces_[n].joint->other == changed)) {
        pieces_[n].joint.reset();
      }
    }
  }

  void join(std::size_t n) {
    const Joint joint = *pieces_[n].joint;
    Piece& other = pieces_[joint.other];
    grown_m2_ += std::max(joint.area, 0.0);
    ++joined_;
    pieces_[n] = {ClosingRing(joint.ring, false, route_),
                  std::nullopt,
                  pieces_[n].name + " + " + other.name,
                  false,
                  false,
                  std::nullopt};
    other.is_gone = true;
    forget_joints(n);
    forget_joints(joint.other);
  }

  FenceLimits limits_;
  Point2 origin_;
  Ring route_;
  std::vector<Piece> pieces_;
  double grown_m2_ = 0;
  std::size_t joined_ = 0;
};
}  // namespace

FenceLimits fence_limits(VehicleType vehicle) {
  constexpr std::size_t kPlaneBytes = 672;
  FenceLimits limits;
  limits.bytes = vehicle == VehicleType::copter ? limits.bytes : kPlaneBytes;
  return limits;
}

FenceLimits fence_size(const std::vector<Zone>& zones) {
  constexpr std::size_t kHead = 4;
  FenceLimits size{0, kHead};
  const auto add = [&](std::size_t corners) {
    size.points += corners;
    size.bytes += 2 + 8 * corners;
  };
  for (const Zone& zone : zones) {
    const formats::Polygon& polygon = zone.volumes.front().polygon;
    if (polygon.outline.empty()) {
      size.points += 1;
      size.bytes += 13;
      continue;
    }
    add(polygon.outline.size());
    for (const Ring& hole : polygon.holes) {
      if (zone.keeps_in()) {
        add(hole.size());
      }
    }
  }
  return size;
}

std::vector<std::string> fit_fence(std::vector<Zone>& zones, const Ring& route,
                                   const FenceLimits& limits) {
  std::vector<std::string> notes;
  if (zones.empty()) {
    return notes;
  }
  const std::size_t before = fence_size(zones).points;
  FenceFit fit(zones, route, limits);
  fit.simplify();
  zones = fit.zones();
  const std::size_t after = fence_size(zones).points;
  if (fit.grown_km2() > 0) {
    notes.push_back(
        "the fence's " + std::to_string(before) + " points became " + std::to_string(after) +
        ", as PX4 holds " + std::to_string(limits.points) + ": it closes " +
        rounded_text(fit.grown_km2(), 3) + " km² more" +
        (fit.joined() > 0 ? " (" + counted(fit.joined(), "zone") + " joined with others)" : ""));
  }
  if (!fit.fits()) {
    notes.push_back("warning: the fence has " + std::to_string(after) +
                    " points and does not fit: PX4 holds " + std::to_string(limits.points) +
                    ", ArduPilot " + std::to_string((limits.bytes - 6) / 8) +
                    " of one polygon, and fewer would close the route");
  }
  return notes;
}
}  // namespace altiplan::host
