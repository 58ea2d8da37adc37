// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "airspace_parts.hpp"
#include "altiplan/earth.hpp"
#include "altiplan/formats/earth_polygon.hpp"
#include "altiplan/geometry.hpp"

namespace altiplan::formats {
namespace {

// Chords are at most this far from their arc, metres.
constexpr double kChord = 1;
// More than what straight edges in longitude and latitude are off between the ends of a chord.
constexpr double kEdge = 0.05;
// A corner that repeats the end of an arc lies within the first distance of it, and one that is
// meant to be it within the second, as coordinates are rounded.
constexpr double kSamePlace = 0.06;
constexpr double kGap = 100;

constexpr const char* kNoArea =
    "outline without an area (three corners or more that are not in line), skipped";

/// How chords run: along the arc's inner side, or around its outer side.
/// Few: as inner ones, no more than the ring's orientation takes.
enum class Chords { inner, outer, few };

double half_step(double radius) { return std::min(std::acos(radius / (radius + kChord)), 0.5); }

void add_arc(Ring& ring, const OutlineArc& arc, Chords chords) {
  const bool inner = chords != Chords::outer;
  const double radius = inner ? arc.min_radius_m : arc.max_radius_m;
  const double sweep = radians(arc.sweep_deg);
  const double step = chords == Chords::few ? kPi / 6 : 2 * half_step(radius);
  const int steps = std::max(1, int(std::ceil(std::abs(sweep) / step)));
  const auto add = [&](double share, double distance) {
    ring.push_back(geodesic_end(arc.centre, arc.from_deg + share * arc.sweep_deg, distance));
  };
  const double at_ends = inner ? std::max(radius - kEdge, 0.0) : radius + kEdge;
  if (arc.has_start) {
    add(0, at_ends);
  }
  const double around = radius / std::cos(sweep / steps / 2) + kEdge;
  for (int n = 0; n < steps; ++n) {
    if (!inner) {
      add((n + 0.5) / steps, around);
    } else if (n > 0) {
      add(double(n) / steps, at_ends);
    }
  }
  if (arc.has_end) {
    add(1, at_ends);
  }
}

bool has_arcs(const Outline& outline) {
  return std::any_of(outline.begin(), outline.end(), [](const OutlinePart& part) {
    return std::holds_alternative<OutlineArc>(part);
  });
}

template <class ChordsOf>
Ring ring_of(const Outline& outline, const ChordsOf& chords_of) {
  Ring ring;
  for (const OutlinePart& part : outline) {
    if (const auto* arc = std::get_if<OutlineArc>(&part)) {
      add_arc(ring, *arc, chords_of(*arc));
    } else {
      ring.push_back(std::get<Point2>(part));
    }
  }
  ring = without_repeats(ring);
  return has_arcs(outline) ? continuous(ring) : unfolded(ring);
}

bool is_clockwise(const Ring& ring) {
  double twice = 0;
  for (std::size_t n = 0; n < ring.size(); ++n) {
    const Point2& p = ring[n];
    const Point2& q = ring[n + 1 < ring.size() ? n + 1 : 0];
    twice += (p[0] - ring[0][0]) * (q[1] - ring[0][1]) - (q[0] - ring[0][0]) * (p[1] - ring[0][1]);
  }
  return twice < 0;
}

/// Arcs that bulge out of the zone have chords around them, others chords within; with `within`
/// it is the other way round.
Ring fitted_ring(const Outline& outline, bool within) {
  const Ring plain = ring_of(outline, [](const OutlineArc&) { return Chords::few; });
  const bool clockwise = is_clockwise(plain);
  return ring_of(outline, [&](const OutlineArc& arc) {
    const bool bulges = (arc.sweep_deg > 0) == clockwise;
    return bulges != within ? Chords::outer : Chords::inner;
  });
}

Ring hull(Ring points) {
  std::sort(points.begin(), points.end());
  Ring result;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = result.size();
    for (const Point2& p : points) {
      while (result.size() >= first + 2 &&
             cross(result[result.size() - 2], result.back(), p) <= 0) {
        result.pop_back();
      }
      result.push_back(p);
    }
    result.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return result;
}

/// A ring with a corner wherever it meets itself.
class Corners {
 public:
  explicit Corners(const Ring& ring) : ring_(ring), on_edge_(ring.size()) {
    for (std::size_t n = 0; n < ring.size(); ++n) {
      for (std::size_t m = n + 1; m < ring.size(); ++m) {
        if (overlap(n, m, 0) && overlap(n, m, 1)) {
          meet(n, m);
        }
      }
    }
  }

  Ring with_meetings() {
    Ring result;
    for (std::size_t n = 0; n < ring_.size(); ++n) {
      result.push_back(ring_[n]);
      std::sort(on_edge_[n].begin(), on_edge_[n].end());
      for (const auto& [share, at] : on_edge_[n]) {
        result.push_back(at);
      }
    }
    return without_repeats(result);
  }

 private:
  const Point2& end(std::size_t n) const { return ring_[n + 1 < ring_.size() ? n + 1 : 0]; }
  bool overlap(std::size_t n, std::size_t m, std::size_t axis) const {
    const auto [a, b] = std::minmax(ring_[n][axis], end(n)[axis]);
    const auto [c, d] = std::minmax(ring_[m][axis], end(m)[axis]);
    return a <= d && c <= b;
  }
  double share_of(std::size_t n, const Point2& p) const {
    const double dx = end(n)[0] - ring_[n][0];
    const double dy = end(n)[1] - ring_[n][1];
    return ((p[0] - ring_[n][0]) * dx + (p[1] - ring_[n][1]) * dy) / (dx * dx + dy * dy);
  }
  /// A corner of one edge that lies on the other.
  void touch(std::size_t n, const Point2& p) {
    const double share = share_of(n, p);
    if (cross(ring_[n], end(n), p) == 0 && share > 0 && share < 1) {
      on_edge_[n].emplace_back(share, p);
    }
  }
  void meet(std::size_t n, std::size_t m) {
    const Point2& a = ring_[n];
    const Point2& b = end(n);
    const Point2& c = ring_[m];
    const Point2& d = end(m);
    const double c_side = cross(a, b, c);
    const double d_side = cross(a, b, d);
    const double a_side = cross(c, d, a);
    const double b_side = cross(c, d, b);
    if (c_side * d_side < 0 && a_side * b_side < 0) {
      const double share = c_side / (c_side - d_side);
      const Point2 at{c[0] + share * (d[0] - c[0]), c[1] + share * (d[1] - c[1])};
      on_edge_[n].emplace_back(share_of(n, at), at);
      on_edge_[m].emplace_back(share, at);
      return;
    }
    touch(n, c);
    touch(n, d);
    touch(m, a);
    touch(m, b);
  }

  const Ring& ring_;
  std::vector<std::vector<std::pair<double, Point2>>> on_edge_;
};

/// The simple loops of a ring that meets itself: every point that the ring encloses, counted by
/// turns or by crossings, lies in one of them.
void add_loops(const Ring& ring, std::vector<Polygon>& to) {
  constexpr std::size_t kMaxCorners = 20000;
  const auto take = [&](Ring loop) {
    loop = without_repeats(loop);
    if (loop.size() < 3 || is_flat({loop, {}})) {
      return;
    }
    to.push_back({polygon_problem({loop, {}}).empty() ? loop : hull(loop), {}});
  };
  if (ring.size() > kMaxCorners) {
    take(hull(ring));
    return;
  }
  Ring path;
  std::map<Point2, std::size_t> at;
  for (const Point2& p : Corners(ring).with_meetings()) {
    if (const auto before = at.find(p); before != at.end()) {
      const std::size_t first = before->second;
      take(Ring(path.begin() + std::ptrdiff_t(first), path.end()));
      for (std::size_t n = first + 1; n < path.size(); ++n) {
        at.erase(path[n]);
      }
      path.resize(first + 1);
    } else {
      at[p] = path.size();
      path.push_back(p);
    }
  }
  take(path);
}

/// True if the part is a corner within reach of an end of the arc.
bool is_at(const OutlinePart& part, const OutlineArc& arc, double share, double reach) {
  const auto* corner = std::get_if<Point2>(&part);
  return corner != nullptr &&
         geodesic_course(*corner, geodesic_end(arc.centre, arc.from_deg + share * arc.sweep_deg,
                                               arc.max_radius_m))
                 .metres <= reach;
}

/// The outline with one of the two places where an arc and the corner beside it are that near.
enum class Keep { arcs, corners };
Outline without_gaps(const Outline& outline, double reach, Keep keep) {
  Outline result = outline;
  std::vector<bool> drop(outline.size());
  for (std::size_t n = 0; n < outline.size(); ++n) {
    auto* arc = std::get_if<OutlineArc>(&result[n]);
    if (arc == nullptr) {
      continue;
    }
    const std::size_t before = (n + outline.size() - 1) % outline.size();
    const std::size_t after = (n + 1) % outline.size();
    const bool near_start = is_at(outline[before], *arc, 0, reach);
    const bool near_end = is_at(outline[after], *arc, 1, reach);
    if (keep == Keep::arcs) {
      drop[before] = drop[before] || near_start;
      drop[after] = drop[after] || near_end;
    } else {
      arc->has_start = !near_start;
      arc->has_end = !near_end;
    }
  }
  Outline kept;
  for (std::size_t n = 0; n < result.size(); ++n) {
    if (!drop[n]) {
      kept.push_back(result[n]);
    }
  }
  return kept;
}

}  // namespace

void expect_lonlat(const Point2& p) {
  if (!(std::abs(p[0]) <= 180 && std::abs(p[1]) <= 90)) {
    throw Error("expected a longitude in [-180, 180] and a latitude in [-90, 90], found " +
                std::to_string(p[0]) + ", " + std::to_string(p[1]));
  }
}

void expect_radius(double metres) {
  constexpr double kMax = 1e6;
  if (!(metres > 0 && metres <= kMax)) {
    throw Error("expected a radius between 0 and 1000 km, found " + std::to_string(metres) + " m");
  }
}

void expect_bearing(double degrees) {
  constexpr double kMax = 720;
  if (!(std::abs(degrees) <= kMax)) {
    throw Error("expected a bearing between -720 and 720 degrees, found " +
                std::to_string(degrees));
  }
}

bool is_simple(const Outline& outline) {
  const auto simple = [](const Outline& candidate) {
    return polygon_problem({fitted_ring(candidate, false), {}}).empty();
  };
  return simple(without_gaps(outline, kSamePlace, Keep::arcs)) ||
         simple(without_gaps(outline, kGap, Keep::arcs));
}

std::vector<Polygon> cover_of(const Outline& given, const std::string& zone, Doubts& doubts) {
  const Outline outline = without_gaps(given, kSamePlace, Keep::arcs);
  Ring ring = fitted_ring(outline, false);
  if (ring.size() < 3 || is_flat({ring, {}})) {
    doubts.add(kNoArea, zone);
    return {};
  }
  if (polygon_problem({ring, {}}).empty()) {
    return {{std::move(ring), {}}};
  }
  // Together these two cover what lies in the gaps between arcs and corners.
  Ring by_arcs = fitted_ring(without_gaps(outline, kGap, Keep::arcs), false);
  Ring by_corners = fitted_ring(without_gaps(outline, kGap, Keep::corners), false);
  if (has_arcs(outline) && polygon_problem({by_arcs, {}}).empty() &&
      polygon_problem({by_corners, {}}).empty()) {
    return {{std::move(by_arcs), {}}, {std::move(by_corners), {}}};
  }
  // Which side of an arc is the zone's is then unknown: both are closed.
  std::vector<Polygon> loops;
  add_loops(ring_of(outline, [](const OutlineArc&) { return Chords::outer; }), loops);
  if (has_arcs(outline)) {
    add_loops(ring_of(outline, [](const OutlineArc&) { return Chords::inner; }), loops);
  }
  if (loops.empty()) {
    doubts.add(kNoArea, zone);
    return {};
  }
  doubts.add("outline meets itself, closed in all of its loops", zone);
  return loops;
}

Enclosed enclosed_by(const Polygon& rings) {
  Enclosed result{{}, polygon_problem(rings)};
  if (result.problem.empty()) {
    result.polygons.push_back(rings);
  } else if (polygon_problem({rings.outline, {}}).empty()) {
    Doubts holes;
    result.polygons.push_back({rings.outline, {}});
    cut_holes(result.polygons.front(), rings.holes, "", holes);
  } else {
    add_loops(rings.outline, result.polygons);
  }
  if (result.polygons.empty() && !rings.holes.empty()) {
    throw Error(result.problem);
  }
  return result;
}

Ring ring_within(const Outline& outline) { return fitted_ring(outline, true); }

Ring circle_ring(const Point2& centre, double radius_m, bool within) {
  expect_radius(radius_m);
  const int steps = std::max(8, int(std::ceil(kPi / half_step(radius_m))));
  const double distance =
      within ? std::max(radius_m - kEdge, radius_m / 2) : radius_m / std::cos(kPi / steps) + kEdge;
  Ring ring;
  for (int n = 0; n < steps; ++n) {
    ring.push_back(geodesic_end(centre, 360.0 * n / steps, distance));
  }
  return continuous(ring);
}

void cut_holes(Polygon& polygon, const std::vector<Ring>& holes, const std::string& zone,
               Doubts& doubts) {
  const auto with = [&](std::vector<Ring> cut) {
    for (Ring& hole : cut) {
      hole = without_repeats(hole);
    }
    return unfolded(Polygon{polygon.outline, std::move(cut)});
  };
  const auto fit = [&](const std::vector<Ring>& cut) { return polygon_problem(with(cut)).empty(); };
  const auto tell = [&] { doubts.add("hole that is no part of the zone, closed", zone); };
  if (holes.empty()) {
    return;
  }
  if (Polygon all = with(holes); polygon_problem(all).empty()) {
    polygon = std::move(all);
    return;
  }
  std::vector<Ring> sound;
  std::copy_if(holes.begin(), holes.end(), std::back_inserter(sound),
               [&](const Ring& hole) { return fit({hole}); });
  if (sound.size() < holes.size()) {
    tell();
  }
  if (!fit(sound)) {  // what two holes share may be closed: neither is cut
    constexpr std::size_t kMaxCompared = 100;
    std::vector<Ring> alone;
    for (std::size_t n = 0; n < sound.size() && sound.size() <= kMaxCompared; ++n) {
      bool is_alone = true;
      for (std::size_t m = 0; m < sound.size() && is_alone; ++m) {
        is_alone = m == n || fit({sound[n], sound[m]});
      }
      if (is_alone) {
        alone.push_back(sound[n]);
      }
    }
    sound = std::move(alone);
    tell();
  }
  if (!sound.empty()) {
    polygon = with(std::move(sound));
  }
}
}  // namespace altiplan::formats
