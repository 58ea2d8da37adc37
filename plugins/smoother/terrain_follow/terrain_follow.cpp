// SPDX-License-Identifier: Apache-2.0
//
// The heights of a route whose plan stays: fewest waypoints through the band of permitted heights.
//
// Citations: H. Imai, M. Iri: Polygonal approximations of a curve, formulations and algorithms, in
//   Computational Morphology, 1988 (fewest pieces of a chain within a tolerance band). S. Suri: A
//   linear time algorithm for minimum link paths inside a simple polygon, Computer Vision, Graphics
//   and Image Processing 35, 1986.
// Guarantees: of all routes over the same plan with waypoints at its corners and at stations
//   between them, at heights of a grid, within the band, the one with the fewest waypoints, and of
//   those with the least climb and descent. Every leg is valid as the judge decides it. Not so if a
//   leg is refused for what precedes it: the leg is then left out, whatever precedes it.
// Complexity: O(stations² heights²) per round; a round for each set of legs that are refused.
// Deviations: limits are known at columns only, and between them from the judge (design.md).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "altiplan/check.hpp"
#include "altiplan/kit/smoothing/corners.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/smoother.hpp"
#include "fewest_legs.hpp"

namespace {
using namespace altiplan;
using terrain_follow::Band;
using terrain_follow::Column;
using terrain_follow::FewestLegs;
using terrain_follow::LegLimits;
using terrain_follow::Node;
using terrain_follow::Plan;
using terrain_follow::Station;

struct Params {
  double station_m = 25;
  double height_step_m = 0.5;

  void describe(Fields& f) {
    f("station_m", station_m)
        .unit("m")
        .range(0.1, 100000)
        .doc("maximum distance between the places where a waypoint may be");
    f("height_step_m", height_step_m)
        .unit("m")
        .range(0.01, 1000)
        .doc(
            "the heights of waypoints are multiples of it, except at the ends and where none is "
            "permitted; of twice, four times … it where more than 128 are permitted");
  }
};

/// One route's way into the band.
class Following {
 public:
  Following(const Polyline& route, const Request& request, const Params& params)
      : route_(route),
        request_(request),
        params_(params),
        watch_(request.budget),
        plan_(route),
        band_(request, plan_, route) {}

  /// Empty if there is none, or none was found. Routes whose legs are valid each by itself are
  /// offered to `is_good`.
  template <class IsGood>
  Polyline lowest_count(const IsGood& is_good) {
    const std::vector<Station> stations = find_stations();
    FewestLegs legs(stations, columns_, limits());
    while (rounds_ < kMaxRounds && forbidding_ < kMaxForbidding && !is_spent()) {
      ++rounds_;
      const std::vector<Node> nodes = legs.solve();
      Polyline found = points(nodes, legs);
      if (nodes.empty() || (all_valid(nodes, found, legs) && is_good(found))) {
        return found;
      }
      forbid_followers(nodes, found, legs);
    }
    return {};
  }
  std::int64_t rounds() const { return rounds_; }
  std::int64_t checked() const { return std::int64_t(checked_); }
  bool budget_hit() const { return budget_hit_; }

 private:
  static constexpr int kMaxRounds = 100;
  static constexpr int kMaxForbidding = 16;  ///< rounds that forbade one leg or another
  static constexpr int kMaxHeights = 128;    ///< per station
  static constexpr int kColumns = 4;         ///< per station, to begin with

  bool is_spent() { return budget_hit_ = budget_hit_ || watch_.spent(checked_); }

  std::vector<Station> find_stations() {
    std::vector<Station> all;
    const std::vector<double>& corners = plan_.corners();
    for (std::size_t c = 0; c + 1 < corners.size() && !is_spent(); ++c) {
      const double length = corners[c + 1] - corners[c];
      const int count = int(std::ceil(length / params_.station_m - 1e-9));
      for (int n = 0; n < count && !is_spent(); ++n) {
        for (int k = 0; k < kColumns; ++k) {
          add_column(corners[c] + length * (n + double(k) / kColumns) / count);
          if (k == 0) {
            all.push_back(station(columns_.back(), n == 0));
          }
        }
      }
    }
    add_column(plan_.length());
    all.push_back(station(columns_.back(), true));
    all.front().heights = {route_.front().z()};
    all.back().heights = {route_.back().z()};
    return all;
  }

  void add_column(double s) {
    columns_.push_back(band_.column(s));
    ++checked_;
  }

  Station station(const Column& column, bool is_corner) const {
    Station station{column.s, is_corner, {}};
    double step = params_.height_step_m;
    while (column.high - column.low > kMaxHeights * step) {
      step *= 2;
    }
    for (double n = std::ceil(column.low / step); n * step <= column.high; ++n) {
      station.heights.push_back(n * step);
    }
    if (station.heights.empty() && column.low <= column.high) {
      station.heights.push_back((column.low + column.high) / 2);
    }
    return station;
  }

  LegLimits limits() const {
    const Limits& limits = request_.limits;
    const auto slope = [&](double angle) {
      return angle >= kPi / 2 || !request_.wind.is_calm() ? kInfinity
                                                          : std::tan(angle + kAngleTolerance);
    };
    return {slope(limits.max_climb), slope(limits.max_descent()), limits.min_leg, limits.max_leg};
  }

  Vec3 point(const Node& node, const FewestLegs& legs) const {
    if (node.station == 0) {
      return route_.front();
    }
    return node.station + 1 == legs.stations().size()
               ? route_.back()
               : plan_.at(legs.stations()[node.station].s, legs.height(node));
  }

  Polyline points(const std::vector<Node>& nodes, const FewestLegs& legs) const {
    Polyline all;
    for (const Node& node : nodes) {
      all.push_back(point(node, legs));
    }
    return all;
  }

  /// True if the judge admits all legs; else the problem is tightened where it refuses one.
  bool all_valid(const std::vector<Node>& nodes, const Polyline& found, FewestLegs& legs) {
    bool is_valid = true;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      ++checked_;
      if (!leg_ok(std::nullopt, found[i], found[i + 1], request_)) {
        is_valid = false;
        tighten(nodes[i], nodes[i + 1], found[i], found[i + 1], legs);
      }
    }
    return is_valid;
  }

  /// Forbids legs that are refused for what precedes them alone.
  void forbid_followers(const std::vector<Node>& nodes, const Polyline& found, FewestLegs& legs) {
    bool is_any = false;
    std::optional<Approach> before = request_.before_start(route_.front());
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      const Vec3& a = found[i];
      const Vec3& b = found[i + 1];
      if (!leg_ok(before, a, b, request_) && leg_ok(std::nullopt, a, b, request_)) {
        legs.forbid(nodes[i], nodes[i + 1]);
        is_any = true;
      }
      before = onward(before, Leg::straight(a, b));
    }
    forbidding_ += is_any;
  }

  /// Adds columns where the leg is refused for its place, and between the columns that it passes;
  /// forbids it if those admit it.
  void tighten(const Node& from, const Node& to, const Vec3& a, const Vec3& b, FewestLegs& legs) {
    constexpr double kFinest = 1;  // metres between columns
    const double s0 = legs.stations()[from.station].s;
    const double s1 = legs.stations()[to.station].s;
    if (!refused_.insert({from, to}).second || band_.permits(a, b)) {
      legs.forbid(from, to);
      ++forbidding_;
      return;
    }
    const double t = refused_share(a, b);
    const Column column = band_.column(s0 + t * (s1 - s0));
    const double z = a.z() + t * (b.z() - a.z());
    if (z >= column.low && z <= column.high) {
      legs.forbid(from, to);  // refused between heights that are permitted
    }
    std::vector<Column> more{column};
    for (std::size_t k = 0; k + 1 < legs.columns().size(); ++k) {
      const double here = legs.columns()[k].s;
      const double next = legs.columns()[k + 1].s;
      if (here >= s0 && next <= s1 && next - here > kFinest) {
        more.push_back(band_.column((here + next) / 2));
        ++checked_;
      }
    }
    for (const Column& each : more) {
      legs.add(each);
    }
  }

  /// Where the leg is refused for its place, by halving.
  double refused_share(const Vec3& a, const Vec3& b) const {
    constexpr double kShort = 1e-3;  // metres
    double begin = 0;
    double end = 1;
    while ((end - begin) * (b - a).norm() > kShort) {
      const double middle = (begin + end) / 2;
      const bool first = !band_.permits(a + begin * (b - a), a + middle * (b - a));
      (first ? end : begin) = middle;
    }
    return (begin + end) / 2;
  }

  const Polyline& route_;
  const Request& request_;
  const Params& params_;
  BudgetWatch watch_;
  Plan plan_;
  Band band_;
  std::vector<Column> columns_;
  std::set<std::pair<Node, Node>> refused_;
  std::uint64_t checked_ = 0;
  std::int64_t rounds_ = 0;
  int forbidding_ = 0;
  bool budget_hit_ = false;
};

struct Effort {
  double climb = 0;
  double sink = 0;
};

Effort effort_of(const Polyline& route) {
  Effort effort;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    const double rise = route[i + 1].z() - route[i].z();
    (rise > 0 ? effort.climb : effort.sink) += std::abs(rise);
  }
  return effort;
}

class TerrainFollow final : public Smoother {
 public:
  explicit TerrainFollow(const Params& params) : params_(params) {}

 private:
  PlanResult do_smooth(const Polyline& route, const Request& request) const override {
    PlanResult result;
    result.status = PlanStatus::solved;
    result.route = route;
    const bool is_level = request.level_m.has_value();
    if (is_level || (Plan::span(route) <= kLengthTolerance)) {
      result.message = is_level ? "level flight: the route is unchanged"
                                : "the route is vertical: it is unchanged";
      return result;
    }
    Following following(route, request, params_);
    const Polyline found = following.lowest_count(
        [&](const Polyline& offered) { return is_within(offered, route, request); });
    result.budget_hit = following.budget_hit();
    result.counters = {{"expanded", following.checked()}, {"rounds", following.rounds()}};
    if (found.empty()) {
      result.message = result.budget_hit ? "the budget was used up: the route is unchanged"
                                         : "no heights were found over the route's plan that "
                                           "satisfy all constraints: the route "
                                           "is unchanged";
    } else if (!is_better(found, route, request)) {
      result.message = "the route has as few waypoints, and climbs as little: it is unchanged";
    } else {
      result.message = sentence(route, found);
      result.route = found;
    }
    return result;
  }

  /// True if the route violates no constraint by more than the one before.
  static bool is_within(const Polyline& found, const Polyline& route, const Request& request) {
    return kit::Excess(check(found, request).violations)
        .within(kit::Excess(check(route, request).violations));
  }

  static bool is_better(const Polyline& found, const Polyline& route, const Request& request) {
    const Effort now = effort_of(found);
    const Effort before = effort_of(route);
    return found.size() < route.size() ||
           (found.size() == route.size() &&
            now.climb + now.sink < before.climb + before.sink - kLengthTolerance) ||
           !check(route, request).ok();
  }

  static std::string sentence(const Polyline& route, const Polyline& found) {
    const Effort before = effort_of(route);
    const Effort now = effort_of(found);
    char text[200];
    std::snprintf(text, sizeof text,
                  "%zu waypoints for %zu; climbs %.1f m and sinks %.1f m, before %.1f and %.1f m",
                  found.size(), route.size(), now.climb, now.sink, before.climb, before.sink);
    return text;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Smoother, "terrain_follow", TerrainFollow, Params,
                "fewest waypoints through the permitted heights over the route's plan")
