// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "altiplan/error.hpp"
#include "altiplan/flown_route.hpp"
#include "altiplan/formats/polygon.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/kit/over_ground.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/request.hpp"
#include "altiplan/task.hpp"
#include "altiplan/world.hpp"
#include "clearance.hpp"
#include "flights.hpp"

namespace altiplan::cover {
namespace {

struct Params {
  formats::Ring outline_m{{0, 0}, {100, 0}, {100, 100}, {0, 100}};
  std::vector<formats::Ring> holes_m;
  double spacing_m = 3;
  bool closed = true;
  std::optional<double> capacity_s;
  double height_m = 0;
  std::optional<double> above_ground_m;
  double tolerance_m = 2;
  double clearance_m = 0;
  int attempts = 3;

  void describe(Fields& f) {
    f("outline_m", outline_m).unit("m").min_items(3).doc("corners [x, y], in either sense");
    f("holes_m", holes_m).unit("m").doc("islands, which are neither covered nor crossed");
    f("spacing_m", spacing_m)
        .unit("m")
        .greater_than(0)
        .doc("distance of lines: each covers half of it to both sides, and around its ends");
    f("closed", closed).doc("true: without a goal the tour ends where it began");
    f("capacity_s", capacity_s)
        .unit("s")
        .greater_than(0)
        .doc("longest flight of a closed tour: several begin and end at one place; default: any");
    f.check(closed || !capacity_s, "capacity_s is for a closed tour");
    f("height_m", height_m)
        .unit("m")
        .doc("height of the passes above sea level; with level_flight_at_m that");
    f("above_ground_m", above_ground_m)
        .unit("m")
        .greater_than(0)
        .doc("height of the passes and joins above the ground instead");
    f("tolerance_m", tolerance_m)
        .unit("m")
        .greater_than(0)
        .doc("with above_ground_m: how far the height may be off it");
    f("clearance_m", clearance_m)
        .unit("m")
        .at_least(0)
        .doc("distance of the tour from islands, within which nothing is covered either");
    f("attempts", attempts).range(1, 1000).doc("patterns of lines that are tried");
  }
};

/// Share of the area that may stay uncovered, as slivers beside slanted edges.
constexpr double kUncovered = 9e-5;

Ring2 points_of(const formats::Ring& ring) {
  Ring2 points;
  for (const formats::Point2& p : formats::without_repeats(ring)) {
    points.emplace_back(p[0], p[1]);
  }
  return points;
}

class Cover final : public Task {
 public:
  Cover(const Params& params, const Site& site)
      : params_(params), area_(area_of(params)), height_m_(params.height_m) {
    if (params.above_ground_m) {
      world_ = *site.before;
    }
    const double level = site.volume.min.z();
    if (std::isfinite(level) && level == site.volume.max.z()) {
      height_m_ = level;
    }
  }

 private:
  static Area area_of(const Params& params) {
    const std::string problem = formats::polygon_problem({params.outline_m, params.holes_m});
    if (!problem.empty()) {
      const bool is_outline = !formats::polygon_problem({params.outline_m, {}}).empty();
      throw ParameterError(is_outline ? "outline_m" : "holes_m", "the area: " + problem);
    }
    formats::Polygon area{params.outline_m, params.holes_m};
    if (params.clearance_m > 0 && !area.holes.empty()) {
      const std::vector<formats::Polygon> parts = clear_of_islands(area, params.clearance_m);
      if (parts.size() != 1) {
        throw ParameterError(
            "clearance_m", parts.empty()
                               ? "the islands leave nothing to cover"
                               : "the islands and their clearance cut the area into " +
                                     std::to_string(parts.size()) + " parts: cover each by itself");
      }
      area = parts.front();
    }
    std::vector<Ring2> islands;
    for (const formats::Ring& hole : area.holes) {
      islands.push_back(points_of(hole));
    }
    return {points_of(area.outline), std::move(islands)};
  }

  Box do_bounds() const override {
    double low = height_m_;
    double high = height_m_;
    if (params_.above_ground_m) {  // over any ground of the Earth
      low = -1000;
      high = 10'000 + *params_.above_ground_m;
    }
    return {{area_.min().x(), area_.min().y(), low}, {area_.max().x(), area_.max().y(), high}};
  }

  std::shared_ptr<const Environment> do_obstacles() const override {
    if (params_.holes_m.empty()) {
      return nullptr;
    }
    std::vector<Shape> islands;
    for (const formats::Ring& hole : params_.holes_m) {
      Prism island;
      island.outline = hole;
      islands.emplace_back(std::move(island));
    }
    return std::make_shared<kit::ShapeLayer>(std::move(islands));
  }

  TaskOrder do_order(const Request& request, const TaskEnds& ends) const override {
    TaskOrder order;
    const auto flat = [](const Vec3& p) { return Point2(p.x(), p.y()); };
    const Vehicle& vehicle = request.vehicle;
    const bool stops = !vehicle.wing && !vehicle.acceleration.corner_radius_m;
    Problem problem{area_,
                    params_.spacing_m,
                    {request.air_speed(), stops ? vehicle.acceleration.mps2 : kInfinity},
                    params_.closed && !(ends.goal && !ends.start),
                    {},
                    {},
                    kUncovered};
    // Of an end beside the area the order knows where it enters.
    const auto within = [&](const Vec3& end) {
      const Point2 p = flat(end);
      return area_.is_outside(p) ? area_.nearest(p) : p;
    };
    if (ends.start) {
      problem.start = within(*ends.start);
    }
    if (ends.goal) {
      problem.goal = within(*ends.goal);
      problem.closed = false;
    }
    for (const auto& end : {problem.start, problem.goal}) {
      if (end && !area_.sees(*end, *end)) {
        order.status = PlanStatus::invalid_problem;
        order.message = "the start and the goal must lie outside the islands of the area";
        return order;
      }
    }
    BudgetWatch watch(request.budget);
    RandomStream random = request.random;
    const Sweep found = sweep(problem, params_.attempts, random(),
                              [&](std::uint64_t iterations) { return watch.spent(iterations); });
    order.counters = {{"expanded", std::int64_t(found.iterations)}};
    order.budget_hit = !found.is_complete;
    if (found.flown.points.empty()) {
      if (found.is_complete) {
        order.message = "the area is too small for a line: lower spacing_m";
        return order;
      }
      order.status = watch.cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out;
      order.message = "the budget ended before the first tour";
      return order;
    }
    fill(order, problem, found, request, ends);
    return order;
  }

  /// Brings a line to its height, unless it has that: over the ground. Its ends may be none of its
  /// own.
  Polyline at_height(const Polyline& line) const {
    return params_.above_ground_m
               ? kit::over_ground(line, world_, *params_.above_ground_m, params_.tolerance_m)
               : line;
  }

  /// Passes and joins over the ground; returns the waypoints.
  Polyline raise(TaskOrder& order, const TaskEnds& ends) const {
    Polyline flown;
    const auto join = [&](Polyline& between, const Vec3& to) {
      if (flown.empty()) {
        flown.push_back(ends.start.value_or(to));
      }
      Polyline line{flown.back()};
      line.insert(line.end(), between.begin(), between.end());
      line.push_back(to);
      line = at_height(line);
      between.assign(line.begin() + 1, line.end() - 1);
      flown.insert(flown.end(), between.begin(), between.end());
    };
    for (Pass& pass : order.passes) {
      pass.points = at_height(pass.points);
      join(pass.join, pass.points.front());
      flown.insert(flown.end(), pass.points.begin(), pass.points.end());
    }
    const Vec3 end = order.last(ends);
    join(order.last_join, end);
    flown.push_back(end);
    return without_repeats(flown);
  }

  /// The tour as one flight, from a pass on if it may begin anywhere.
  Flight whole(const Sweep& found, const TaskEnds& ends) const {
    Flight flight{found.flown.points, found.needed};
    if (params_.closed && !ends.start && !ends.goal) {
      const auto first =
          std::find(flight.needed.begin(), flight.needed.end(), char(1)) - flight.needed.begin();
      flight.points.pop_back();
      std::rotate(flight.points.begin(), flight.points.begin() + first, flight.points.end());
      std::rotate(flight.needed.begin(), flight.needed.begin() + first, flight.needed.end());
      flight.points.push_back(flight.points.front());
      return flight;
    }
    while (!ends.start && !flight.needed.front()) {  // an open tour begins and ends with a pass
      flight.points.erase(flight.points.begin());
      flight.needed.erase(flight.needed.begin());
    }
    while (!ends.goal && !params_.closed && !flight.needed.back()) {
      flight.points.pop_back();
      flight.needed.pop_back();
    }
    return flight;
  }

  /// Adds a flight's passes, the legs that cover what no other does; the others join them.
  void add(Flight flight, const TaskEnds& ends, TaskOrder& order) const {
    Polyline flown;
    for (const Point2& p : flight.points) {
      flown.emplace_back(p.x(), p.y(), height_m_);
    }
    // A start or goal at another height is joined to the passes' own.
    if (ends.start && *ends.start != flown.front()) {
      flown.insert(flown.begin(), *ends.start);
      flight.needed.insert(flight.needed.begin(), 0);
    }
    const Vec3 end = ends.goal.value_or(params_.closed ? flown.front() : flown.back());
    if (end != flown.back()) {
      flown.push_back(end);
      flight.needed.push_back(0);
    }
    for (std::size_t i = 0; i < flight.needed.size(); ++i) {
      const bool goes_on = i > 0 && bool(flight.needed[i - 1]) == bool(flight.needed[i]);
      if (!flight.needed[i]) {
        if (goes_on) {
          order.last_join.push_back(flown[i]);
        }
      } else if (goes_on) {
        order.passes.back().points.push_back(flown[i + 1]);
      } else {
        order.passes.push_back({{flown[i], flown[i + 1]}, std::exchange(order.last_join, {})});
      }
    }
  }

  void fill(TaskOrder& order, const Problem& problem, const Sweep& found, const Request& request,
            const TaskEnds& ends) const {
    std::vector<Flight> flights{whole(found, ends)};
    const double capacity_s = params_.capacity_s.value_or(kInfinity);
    if (found.flown.time_s > capacity_s) {
      flights = flights_of(problem, found, capacity_s);
      if (flights.empty()) {
        order.message = "no flight of capacity_s covers the farthest pass and returns";
        return;
      }
    }
    for (const Flight& flight : flights) {
      if (flights.size() > 1) {  // all begin where the first does
        const Vec3 home =
            ends.start.value_or(Vec3(flight.points[0].x(), flight.points[0].y(), height_m_));
        order.passes.push_back({{home}, std::exchange(order.last_join, {}), true});
      }
      add(flight, ends, order);
    }
    order.status = PlanStatus::solved;
    order.closes = params_.closed;
    order.time_s = flown_time(Route(raise(order, ends)), request);
    // Of other speeds than the vehicle's own nothing is known, nor of ends beside the area.
    const auto is_beside = [&](const std::optional<Vec3>& end) {
      return end && area_.is_outside({end->x(), end->y()});
    };
    const bool is_bounded = request.wind.is_calm() && request.vehicle.speed_near.empty() &&
                            !is_beside(ends.start) && !is_beside(ends.goal);
    order.bound_s = is_bounded ? std::min(found.bound_s, order.time_s) : 0;
  }

  Params params_;
  Area area_;
  double height_m_;
  World world_;  ///< with above_ground_m
};
}  // namespace
}  // namespace altiplan::cover

ALTIPLAN_PLUGIN(Task, "cover", altiplan::cover::Cover, altiplan::cover::Params,
                "covers an area with islands by parallel rows, in a tour of least time")
