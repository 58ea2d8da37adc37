// SPDX-License-Identifier: Apache-2.0
//
// Random maps for planners in 2-D: bars, blocks and circles that keep apart, after the map of paper
// 004 (Li Rongsheng et al., "Path planning for flight vehicles based on improved ACO", figures 6 to
// 8), which is a single figure.
#include "altiplan/environment.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

using Range = std::array<double, 2>;
using Point2 = std::array<double, 2>;

struct Params {
  Point2 extent_m{1000, 660};
  int bars = 2;
  int bars_across = 2;
  Range bar_length_m{260, 400};
  Range bar_width_m{30, 60};
  double bend_deg = 60;
  int blocks = 4;
  Range block_reach_m{105, 155};
  int circles = 4;
  Range radius_m{58, 90};
  double gap_m = 25;
  std::vector<Point2> clear_of_m{{30, 30}, {970, 630}};
  double clear_m = 60;
  std::optional<std::int64_t> seed;

  void describe(Fields& f) {
    f("extent_m", extent_m)
        .unit("m")
        .range(1, 1e9)
        .doc("east and north sides of the rectangle, from the origin, that contains all zones");
    f("bars", bars).range(0, 1000).doc("number of bars, each with a bend in its middle");
    f("bars_across", bars_across)
        .range(0, 1000)
        .doc(
            "number of bars, generated first, that cross the straight line between the first two "
            "points of clear_of_m");
    f("bar_length_m", bar_length_m)
        .unit("m")
        .range(1e-3, 1e9)
        .doc("minimum and maximum length of a bar");
    f("bar_width_m", bar_width_m)
        .unit("m")
        .range(1e-3, 1e9)
        .doc("minimum and maximum width of a bar");
    f("bend_deg", bend_deg).unit("deg").range(0, 120).doc("maximum bend of a bar");
    f("blocks", blocks).range(0, 1000).doc("number of polygons of 3 to 6 corners");
    f("block_reach_m", block_reach_m)
        .unit("m")
        .range(1e-3, 1e9)
        .doc(
            "minimum and maximum distance from a block's middle to its corners; each corner is "
            "at 0.7 to 1 of it");
    f("circles", circles).range(0, 1000).doc("number of circles");
    f("radius_m", radius_m)
        .unit("m")
        .range(1e-3, 1e9)
        .doc("minimum and maximum radius of a circle");
    f("gap_m", gap_m)
        .unit("m")
        .at_least(0)
        .doc("minimum distance between zones, and from the rectangle's sides");
    f("clear_of_m", clear_of_m)
        .unit("m")
        .doc("points to keep clear of zones, such as start and goal");
    f("clear_m", clear_m).unit("m").at_least(0).doc("minimum distance of zones from these points");
    f("seed", seed).at_least(0).doc("random seed of the zones; default: the run's seed");
    for (const Range& range : {bar_length_m, bar_width_m, block_reach_m, radius_m}) {
      f.check(range[0] <= range[1], "give the minimum before the maximum");
    }
    f.check(bars_across <= bars, "bars_across must not exceed bars");
    f.check(bars_across == 0 || clear_of_m.size() > 1,
            "bars_across needs two points in clear_of_m");
    // Else the inner corner of a bend lies beyond the bar's end, and its outline intersects itself.
    f.check(bars == 0 || bar_length_m[0] > bar_width_m[1] * std::tan(bend_deg / 2 * kPi / 180),
            "bars are too short for their width and bend");
  }
};

/// Generates one map; the order of the random numbers is part of the maps' definition.
class Draw {
 public:
  Draw(const Params& params, std::uint64_t seed) : params_(params), random_(seed) {}

  std::vector<Shape> map() {
    for (int n = 0; n < kMaps; ++n) {
      std::vector<Shape> zones;
      boxes_.clear();
      if (add(params_.bars_across, &Draw::bar, zones, true) &&
          add(params_.bars - params_.bars_across, &Draw::bar, zones) &&
          add(params_.blocks, &Draw::block, zones) && add(params_.circles, &Draw::circle, zones)) {
        return zones;
      }
    }
    throw Error("random_zones: a zone does not fit in " + std::to_string(kMaps) + " maps and " +
                std::to_string(kTries) + " positions each; expected fewer or smaller zones");
  }

 private:
  static constexpr int kMaps = 100;
  static constexpr int kTries = 1000;

  /// Each zone is regenerated until it fits; false if none does.
  bool add(int count, Shape (Draw::*draw)(), std::vector<Shape>& zones, bool across = false) {
    for (int n = 0; n < count; ++n) {
      int tries = 0;
      Shape zone = (this->*draw)();
      while ((!has_room(zone, zones) || (across && !is_across(zone))) && ++tries < kTries) {
        zone = (this->*draw)();
      }
      if (tries == kTries) {
        return false;
      }
      boxes_.push_back(bounds(zone));
      zones.push_back(std::move(zone));
    }
    return true;
  }

  double in(const Range& range) { return range[0] + (range[1] - range[0]) * random_.uniform(); }
  Point2 middle() {
    const double x = params_.extent_m[0] * random_.uniform();
    const double y = params_.extent_m[1] * random_.uniform();
    return {x, y};
  }
  static Point2 from(const Point2& p, double distance, double angle) {
    return {p[0] + distance * std::cos(angle), p[1] + distance * std::sin(angle)};
  }

  /// Two halves that meet in the middle, each at half the bend from the bar's direction.
  Shape bar() {
    const Point2 at = middle();
    const double direction = 2 * kPi * random_.uniform();
    const double length = in(params_.bar_length_m);
    const double width = in(params_.bar_width_m);
    const double half_bend = in({-1, 1}) * params_.bend_deg / 2 * kPi / 180;
    const Point2 ahead = from(at, length / 2, direction + half_bend);
    const Point2 behind = from(at, length / 2, direction + kPi - half_bend);
    Prism prism;
    for (const double side : {+1.0, -1.0}) {
      const double left = side * width / 2;
      const Point2 a = from(behind, left, direction - half_bend + kPi / 2);
      const Point2 b = from(at, left / std::cos(half_bend), direction + kPi / 2);
      const Point2 c = from(ahead, left, direction + half_bend + kPi / 2);
      if (side > 0) {
        prism.outline = {a, b, c};
      } else {
        prism.outline.insert(prism.outline.end(), {c, b, a});
      }
    }
    return prism;
  }

  /// A polygon with its corners in order around the middle, convex or not.
  Shape block() {
    const Point2 at = middle();
    const int corners = 3 + int(4 * random_.uniform());
    const double turn = 2 * kPi * random_.uniform();
    const double reach = in(params_.block_reach_m);
    Prism prism;
    for (int n = 0; n < corners; ++n) {
      const double angle = turn + 2 * kPi * (n + in({-0.2, 0.2})) / corners;
      const double share = in({0.7, 1});
      prism.outline.push_back(from(at, reach * share, angle));
    }
    return prism;
  }

  Shape circle() {
    const Point2 at = middle();
    Cylinder cylinder;
    cylinder.x = at[0];
    cylinder.y = at[1];
    cylinder.radius = in(params_.radius_m);
    return cylinder;
  }

  bool has_room(const Shape& zone, const std::vector<Shape>& others) const {
    const Box box = bounds(zone);
    for (int axis = 0; axis < 2; ++axis) {
      if (box.min[axis] < params_.gap_m ||
          box.max[axis] > params_.extent_m[std::size_t(axis)] - params_.gap_m) {
        return false;
      }
    }
    for (const Point2& p : params_.clear_of_m) {
      if (signed_distance(zone, {p[0], p[1], 0}) < params_.clear_m) {
        return false;
      }
    }
    for (std::size_t n = 0; n < others.size(); ++n) {
      if (boxes_come_near(box, boxes_[n]) && nearer_than_gap(zone, others[n])) {
        return false;
      }
    }
    return true;
  }

  bool is_across(const Shape& zone) const {
    const Point2& a = params_.clear_of_m[0];
    const Point2& b = params_.clear_of_m[1];
    return leg_distance(zone, {a[0], a[1], 0}, {b[0], b[1], 0}) == 0;
  }

  /// Separates most zones, at the lowest cost.
  bool boxes_come_near(const Box& a, const Box& b) const {
    const double gap = params_.gap_m + kLengthTolerance;
    return a.min.x() <= b.max.x() + gap && b.min.x() <= a.max.x() + gap &&
           a.min.y() <= b.max.y() + gap && b.min.y() <= a.max.y() + gap;
  }

  /// Circles come last: only polygons precede a polygon. Each one's edges are checked against the
  /// other, which may lie inside.
  bool nearer_than_gap(const Shape& zone, const Shape& other) const {
    if (const auto* cylinder = std::get_if<Cylinder>(&zone)) {
      return signed_distance(other, {cylinder->x, cylinder->y, 0}) <
             cylinder->radius + params_.gap_m;
    }
    return edges_come_near(zone, other) || edges_come_near(other, zone);
  }
  bool edges_come_near(const Shape& polygon, const Shape& to) const {
    const auto& outline = std::get<Prism>(polygon).outline;
    for (std::size_t n = 0; n < outline.size(); ++n) {
      const Point2& a = outline[n];
      const Point2& b = outline[(n + 1) % outline.size()];
      if (leg_distance(to, {a[0], a[1], 0}, {b[0], b[1], 0}) <= params_.gap_m) {
        return true;
      }
    }
    return false;
  }

  const Params& params_;
  SplitMix64 random_;
  std::vector<Box> boxes_;  ///< of the zones so far
};

std::vector<Shape> draw(const Params& params, const Site& site) {
  RandomStream of_run = site.random;
  return Draw(params, params.seed ? std::uint64_t(*params.seed) : of_run()).map();
}

class RandomZones final : public kit::ShapeLayer {
 public:
  RandomZones(const Params& params, const Site& site) : ShapeLayer(draw(params, site)) {}

 private:
  std::optional<Drawing> do_drawing() const override {
    return kit::drawing_of(set().shapes(), Drawn::Role::keep_out);
  }
};
}  // namespace

ALTIPLAN_PLUGIN(Environment, "random_zones", RandomZones, Params,
                "random bars, blocks and circles of unlimited height over a rectangle, for "
                "planners in 2-D (paper 004)")
