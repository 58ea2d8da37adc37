// SPDX-License-Identifier: Apache-2.0
#include "altiplan/formats/earth_polygon.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/earth.hpp"
#include "altiplan/error.hpp"

namespace altiplan::formats {
namespace {

constexpr double kPole = 90;
constexpr double kHalfTurn = 180;
constexpr double kTurn = 360;

const Point2& after(const Ring& ring, std::size_t n) {
  return ring[n + 1 < ring.size() ? n + 1 : 0];
}

/// Along a pole an edge has no length, whatever its longitudes.
bool is_at_pole(const Point2& p, const Point2& q) {
  return std::abs(p[1]) >= kPole && p[1] == q[1];
}

/// An edge that is longer as written than across the 180th meridian.
bool has_jump(const Ring& ring) {
  for (std::size_t n = 0; n < ring.size(); ++n) {
    const Point2& q = after(ring, n);
    if (std::abs(q[0] - ring[n][0]) > kHalfTurn && !is_at_pole(ring[n], q)) {
      return true;
    }
  }
  return false;
}

/// Closes a ring around a pole along the nearer one.
void close_at_pole(Ring& ring) {
  const double last = ring.back()[0];
  const double turn = longitude_near(ring.front()[0], last) - ring.front()[0];
  if (turn == 0) {
    return;
  }
  double lats = 0;
  for (const Point2& p : ring) {
    lats += p[1];
  }
  const double pole = std::copysign(kPole, lats);
  const Point2 first = ring.front();
  ring.push_back({first[0] + turn, first[1]});
  ring.push_back({first[0] + turn, pole});
  ring.push_back({first[0], pole});
}

struct Extent {
  Point2 low{kInfinity, kInfinity};
  Point2 high{-kInfinity, -kInfinity};

  explicit Extent(const Ring& ring) {
    for (const Point2& p : ring) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        low[axis] = std::min(low[axis], p[axis]);
        high[axis] = std::max(high[axis], p[axis]);
      }
    }
  }
  double size(std::size_t axis) const { return high[axis] - low[axis]; }
};

double twice_area(const Ring& ring) {
  double twice = 0;
  for (std::size_t n = 0; n < ring.size(); ++n) {
    twice += cross(ring[0], ring[n], after(ring, n));
  }
  return twice;
}

/// How edges over more than half of the Earth run, as far as the ring tells.
enum class Reading { as_written, short_way, either };

/// Files that keep to no rule draw their rings either way around, so the direction decides alone
/// where the other reading is wider than any zone.
Reading reading_of(const Ring& ring, const Ring& by_short) {
  constexpr double kMask = 60;   // reached on both sides of the equator
  constexpr double kSmall = 20;  // of latitude, and as wide on the ground
  constexpr double kWidest = 100;
  const Extent written(ring);
  const Extent shorter(by_short);
  const double width = shorter.size(0);
  if (width == 0 || (written.low[1] <= -kMask && written.high[1] >= kMask)) {
    return Reading::as_written;
  }
  const double nearest = std::min(std::abs(written.low[1]), std::abs(written.high[1])) *
                         (written.low[1] * written.high[1] > 0);
  const bool is_around_a_pole = width >= kTurn && written.size(1) <= kMask;
  const bool is_small = width * std::cos(radians(nearest)) <= kSmall && written.size(1) <= kSmall;
  if (is_around_a_pole || is_small) {
    return Reading::short_way;
  }
  return width > kWidest && twice_area(ring) > 0 ? Reading::as_written : Reading::either;
}

bool has_two_readings(const Ring& ring) {
  return ring.size() >= 3 && has_jump(ring) &&
         reading_of(ring, continuous(ring)) == Reading::either;
}

/// Sutherland and Hodgman: the part of the ring on one side of a line. Where the line cuts the ring
/// more than twice, the parts hang together along it.
Ring cut(Ring ring, std::size_t axis, double limit, double side) {
  if (std::all_of(ring.begin(), ring.end(),
                  [&](const Point2& p) { return (p[axis] - limit) * side >= 0; })) {
    return ring;
  }
  Ring kept;
  for (std::size_t n = 0; n < ring.size(); ++n) {
    const Point2& p = ring[n];
    const Point2& q = after(ring, n);
    const double inside = (p[axis] - limit) * side;
    const double next = (q[axis] - limit) * side;
    if (inside >= 0) {
      kept.push_back(p);
    }
    if ((inside < 0) != (next < 0)) {
      const double share = inside / (inside - next);
      Point2 at{p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])};
      at[axis] = limit;
      kept.push_back(at);
    }
  }
  return kept;
}

/// Moves edges along a meridian at which zones are cut a centimetre beyond it: along the 180th, and
/// the sides of a ring around the Earth.
void overlap(Ring& ring, const Extent& extent) {
  constexpr double kOverlap = 1e-7;
  const bool is_around = extent.size(0) == kTurn;
  for (Point2& p : ring) {
    if (p[0] == extent.high[0] && (is_around || p[0] == kHalfTurn)) {
      p[0] += kOverlap;
    } else if (p[0] == extent.low[0] && (is_around || p[0] == -kHalfTurn)) {
      p[0] -= kOverlap;
    }
  }
}

constexpr double kReach = 20;  // degrees about a frame's origin

/// The surroundings of a frame's origin in longitude and latitude.
class Surroundings {
 public:
  Surroundings(const Frame& frame, double degrees, bool keeps_in)
      : frame_(frame), middle_(frame.to_lonlat(0, 0)), keeps_in_(keeps_in) {
    low_ = {0, std::max(middle_[1] - degrees, -kPole)};
    high_ = {0, std::min(middle_[1] + degrees, kPole)};
    const double widest = std::max(std::abs(low_[1]), std::abs(high_[1]));
    holds_pole_ = widest >= kPole - 1 && is_whole_about_pole(std::copysign(kPole, middle_[1]));
    const double east = degrees / std::cos(radians(std::min(widest, kPole - 1)));
    const double width = std::min(east, kHalfTurn - 1e-9);
    low_[0] = middle_[0] - width;
    high_[0] = middle_[0] + width;
  }

  bool hold(const Point2& p) const {
    return p[1] >= low_[1] && p[1] <= high_[1] &&
           (holds_pole_ ||
            std::abs(longitude_near(p[0], middle_[0]) - middle_[0]) <= high_[0] - middle_[0]);
  }

  /// The part of a polygon, moved by whole turns of the Earth, in the frame.
  void add(Polygon polygon, std::vector<Polygon>& to) const {
    Extent extent(polygon.outline);
    if (extent.low[1] > high_[1] || extent.high[1] < low_[1]) {
      return;
    }
    if (holds_pole_) {
      add_turned(polygon, 0, to);
      return;
    }
    if (!keeps_in_) {
      overlap(polygon.outline, extent);
    }
    const double first = std::ceil((low_[0] - extent.high[0]) / kTurn);
    for (double n = first; extent.low[0] + n * kTurn <= high_[0]; ++n) {
      add_turned(polygon, n * kTurn, to);
    }
  }

 private:
  /// True if the meridian opposite to the middle is none of the frame's edges.
  bool is_whole_about_pole(double pole) const {
    const double lat = pole - std::copysign(0.01, pole);
    const Point2 west = frame_.to_local(middle_[0] + kHalfTurn - 1e-6, lat);
    const Point2 east = frame_.to_local(middle_[0] - kHalfTurn + 1e-6, lat);
    return std::hypot(west[0] - east[0], west[1] - east[1]) < 1;
  }

  void add_turned(const Polygon& polygon, double turn, std::vector<Polygon>& to) const {
    Polygon part{local(polygon.outline, turn), {}};
    if (part.outline.size() < 3) {
      return;
    }
    for (const Ring& hole : polygon.holes) {
      Ring cut_out = local(hole, turn);
      if (cut_out.size() >= 3) {
        part.holes.push_back(std::move(cut_out));
      }
    }
    to.push_back(std::move(part));
  }

  Ring within(Ring ring, double turn) const {
    for (Point2& p : ring) {
      p[0] += turn;
    }
    ring = cut(cut(std::move(ring), 1, low_[1], 1), 1, high_[1], -1);
    return holds_pole_ ? without_poles(in_quarters(ring))
                       : cut(cut(std::move(ring), 0, low_[0], 1), 0, high_[0], -1);
  }

  /// With corners at most a quarter of a turn apart, but along a pole.
  static Ring in_quarters(const Ring& ring) {
    constexpr double kQuarter = 90;
    Ring result;
    for (std::size_t n = 0; n < ring.size(); ++n) {
      const Point2& p = ring[n];
      const Point2& q = after(ring, n);
      const int parts =
          is_at_pole(p, q) ? 1 : std::max(1, int(std::ceil(std::abs(q[0] - p[0]) / kQuarter)));
      for (int part = 0; part < parts; ++part) {
        const double share = double(part) / parts;
        result.push_back({p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])});
      }
    }
    return result;
  }

  /// All around a pole it is no corner: the ring closes across it, by an edge of no length.
  static Ring without_poles(const Ring& ring) {
    Ring result;
    for (std::size_t n = 0; n < ring.size(); ++n) {
      const Point2& before = ring[n > 0 ? n - 1 : ring.size() - 1];
      const Point2& next = after(ring, n);
      const auto is_around = [&](const Point2& p, const Point2& q) {
        return is_at_pole(p, q) && std::abs(q[0] - p[0]) == kTurn;
      };
      if (!is_around(before, ring[n]) && !is_around(ring[n], next)) {
        result.push_back(ring[n]);
      }
    }
    return result;
  }

  Ring local(const Ring& lonlat, double turn) const {
    const Ring near = without_repeats(within(lonlat, turn));
    Ring corners;
    for (const Point2& p : near) {
      corners.push_back(frame_.to_local(p[0], p[1]));
    }
    Ring ring;
    for (std::size_t n = 0; n < near.size(); ++n) {
      ring.push_back(corners[n]);
      add_edge(near[n], after(near, n), corners[n], after(corners, n), 0, ring);
    }
    return without_repeats(ring);
  }

  static double tolerance(const Point2& p, double half_length) {
    constexpr double kNear = 1e-3;
    constexpr double kShare = 1e-7;
    return std::max(kNear, kShare * (std::hypot(p[0], p[1]) - half_length));
  }

  /// Corners between two, where the frame bends the edge.
  void add_edge(const Point2& p, const Point2& q, const Point2& local_p, const Point2& local_q,
                int depth, Ring& to) const {
    constexpr int kMaxDepth = 24;
    constexpr double kEarth = 6'371'000;
    const Point2 chord{(local_p[0] + local_q[0]) / 2, (local_p[1] + local_q[1]) / 2};
    const double length = std::hypot(local_q[0] - local_p[0], local_q[1] - local_p[1]);
    const double allowed = tolerance(chord, length / 2);
    // A map bends a parallel by tan(latitude) / R if it is conformal, and none that is used by more
    // than four times that. Edges over many longitudes may end where they begin.
    const double lat = radians(std::min(std::max(std::abs(p[1]), std::abs(q[1])), kPole - 1e-6));
    const double turn = std::abs(q[0] - p[0]);
    const bool is_long = turn > 1 && turn < kTurn && !is_at_pole(p, q);
    if (depth == kMaxDepth ||
        (!is_long && length * length / 2 * (1 + std::tan(lat)) / kEarth <= allowed)) {
      return;
    }
    const Point2 middle{(p[0] + q[0]) / 2, (p[1] + q[1]) / 2};
    const Point2 local = frame_.to_local(middle[0], middle[1]);
    if (!is_long && std::hypot(local[0] - chord[0], local[1] - chord[1]) <= allowed) {
      return;
    }
    add_edge(p, middle, local_p, local, depth + 1, to);
    to.push_back(local);
    add_edge(middle, q, local, local_q, depth + 1, to);
  }

  const Frame& frame_;
  Point2 middle_;
  Point2 low_;
  Point2 high_;
  bool keeps_in_;
  bool holds_pole_ = false;
};

}  // namespace

Ring continuous(Ring ring) {
  for (std::size_t n = 1; n < ring.size(); ++n) {
    ring[n][0] = longitude_near(ring[n][0], ring[n - 1][0]);
  }
  if (!ring.empty()) {
    close_at_pole(ring);
  }
  return ring;
}

Ring unfolded(const Ring& ring) {
  if (ring.size() < 3 || !has_jump(ring)) {
    return ring;
  }
  const Ring by_short = continuous(ring);
  return reading_of(ring, by_short) == Reading::short_way ? without_repeats(by_short) : ring;
}

Polygon unfolded(Polygon polygon) {
  polygon.outline = unfolded(polygon.outline);
  const Extent extent(polygon.outline);
  for (Ring& hole : polygon.holes) {
    hole = unfolded(hole);
    if (hole.empty()) {
      continue;
    }
    const Extent own(hole);
    const double turn = kTurn * std::ceil((extent.low[0] - own.low[0]) / kTurn);
    if (own.high[0] + turn <= extent.high[0]) {
      for (Point2& p : hole) {
        p[0] += turn;
      }
    }
  }
  return polygon;
}

bool has_two_readings(const Polygon& polygon) {
  return has_two_readings(polygon.outline) ||
         std::any_of(polygon.holes.begin(), polygon.holes.end(),
                     [](const Ring& hole) { return has_two_readings(hole); });
}

namespace {
/// What is surely the polygon's: of an outline with two readings nothing stays in, both are kept
/// out; a hole with two opens nothing.
std::vector<Polygon> readings(Polygon polygon, bool keeps_in) {
  std::erase_if(polygon.holes, [](const Ring& hole) { return has_two_readings(hole); });
  if (!has_two_readings(polygon.outline)) {
    return {std::move(polygon)};
  }
  if (keeps_in) {
    return {};
  }
  Polygon by_short{without_repeats(continuous(polygon.outline)), {}};
  polygon.holes.clear();
  return {std::move(polygon), std::move(by_short)};
}
}  // namespace

std::vector<Polygon> in_frame(const Polygon& polygon, const Frame& frame, bool keeps_in) {
  constexpr double kLeast = 1;
  for (double reach = kReach;; reach /= 2) {
    try {
      std::vector<Polygon> parts;
      const Surroundings surroundings(frame, reach, keeps_in);
      for (Polygon& reading : readings(polygon, keeps_in)) {
        surroundings.add(std::move(reading), parts);
      }
      return parts;
    } catch (const Error&) {
      if (reach < kLeast) {
        throw;
      }
    }
  }
}

bool are_in_frame(const std::vector<Point2>& positions, const Frame& frame) {
  const Surroundings surroundings(frame, kReach, false);
  return std::all_of(positions.begin(), positions.end(),
                     [&](const Point2& p) { return surroundings.hold(p); });
}

Frame frame_around(const std::vector<Point2>& positions) {
  Ring near = positions;
  for (Point2& p : near) {
    p[0] = longitude_near(p[0], near.front()[0]);
  }
  const Extent extent(near);
  return Frame::local({(extent.low[0] + extent.high[0]) / 2, (extent.low[1] + extent.high[1]) / 2},
                      extent.low);
}

double radius_in(const Frame& frame, const Point2& centre, double radius_m, bool keeps_in) {
  constexpr int kDirections = 16;
  const Point2 middle = frame.to_local(centre[0], centre[1]);
  double low = kInfinity;
  double high = 0;
  for (int n = 0; n < kDirections; ++n) {
    const Point2 end = geodesic_end(centre, kTurn * n / kDirections, radius_m);
    const Point2 at = frame.to_local(end[0], std::clamp(end[1], -kPole, kPole));
    const double radius = std::hypot(at[0] - middle[0], at[1] - middle[1]);
    low = std::min(low, radius);
    high = std::max(high, radius);
  }
  return keeps_in ? low : high;
}
}  // namespace altiplan::formats
