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
#include "areas.hpp"
#include "flights.hpp"
#include "given.hpp"
#include "sweep.hpp"
#include "wing_rows.hpp"

namespace altiplan::cover {
namespace {

/// Share of the area that may stay uncovered, as slivers beside slanted edges.
constexpr double kUncovered = 9e-5;

Point2 flat(const Vec3& p) { return {p.x(), p.y()}; }

class Cover final : public Task {
 public:
  Cover(const Params& params, const Site& site) : params_(params), height_m_(params.height_m) {
    const std::vector<Given> given = given_areas(params);
    for (const Given& area : given) {
      areas_.push_back(area_of(area, params.clearance_m));
      outlines_.push_back(area_of({area.name, area.key, {area.polygon.outline, {}}}, 0));
      names_.push_back(area.name);
    }
    expect_apart(given);
    if (params.above_ground_m) {
      world_ = *site.before;
    }
    const double level = site.volume.min.z();
    if (std::isfinite(level) && level == site.volume.max.z()) {
      height_m_ = level;
    }
  }

 private:
  Box do_bounds() const override {
    double low = height_m_;
    double high = height_m_;
    if (params_.above_ground_m) {  // over any ground of the Earth
      low = -1000;
      high = 10'000 + *params_.above_ground_m;
    }
    Box box = Box::empty();
    for (const Area& area : outlines_) {
      const double row = params_.beyond_m > 0 ? params_.beyond_m + params_.spacing_m / 2 : 0;
      const Point2 beyond = Point2::Constant(row);
      const Point2 min = area.min() - beyond;
      const Point2 max = area.max() + beyond;
      box = box.with({min.x(), min.y(), low});
      box = box.with({max.x(), max.y(), high});
    }
    return box;
  }

  std::shared_ptr<const Environment> do_obstacles() const override {
    std::vector<Shape> islands;
    for (const Given& area : given_areas(params_)) {
      for (const formats::Ring& hole : area.polygon.holes) {
        Prism island;
        island.outline = hole;
        islands.emplace_back(std::move(island));
      }
    }
    if (islands.empty()) {
      return nullptr;
    }
    return std::make_shared<kit::ShapeLayer>(std::move(islands));
  }

  /// Steepest over the ground, both ways, that the limits through the air allow in any wind.
  static double slope_of(const Request& request) {
    const double angle = std::min(
        {request.limits.max_slope(), request.vehicle.wing->climb, request.vehicle.wing->sink});
    const double speed = request.air_speed();
    const double strongest = request.wind.max_speed();
    constexpr double kRounding = 0.999;
    return kRounding * std::tan(angle) * speed / (speed + strongest);
  }

  /// Rows alone: a planner turns from each to the next.
  TaskOrder order_of_wing(const Request& request, const TaskEnds& ends) const {
    TaskOrder order;
    if (params_.capacity_s) {
      order.status = PlanStatus::invalid_problem;
      order.message = "capacity_s: an aeroplane covers areas in one flight";
      return order;
    }
    const auto place = [](const std::optional<Vec3>& end) {
      return end ? std::optional(flat(*end)) : std::nullopt;
    };
    const double radius =
        std::max(request.limits.min_turn_radius, request.vehicle.wing->turn_radius());
    const auto goal = ends.goal || !params_.closed ? ends.goal : ends.start;
    WingProblem problem{{},          params_.spacing_m, params_.beyond_m, radius, place(ends.start),
                        place(goal), params_.closed};
    for (std::size_t i = 0; i < areas_.size(); ++i) {
      problem.fields.push_back({areas_[i], outlines_[i]});
    }
    BudgetWatch watch(request.budget);
    RandomStream random = request.random;
    const double slope = slope_of(request);
    // Waypoints where a row begins and ends, between the leads.
    const auto pass_of = [&](const WingRow& row) {
      const Point2 lead = params_.beyond_m / row.length() * (row.line.b - row.line.a);
      Polyline pass;
      const auto add = [&](const Point2& p) { pass.emplace_back(p.x(), p.y(), height_m_); };
      add(row.line.a);
      if (row.leads[0]) {
        add(row.line.a + lead);
      }
      if (row.leads[1]) {
        add(row.line.b - lead);
      }
      add(row.line.b);
      return params_.above_ground_m ? kit::over_ground(pass, world_, *params_.above_ground_m,
                                                       params_.tolerance_m, slope)
                                    : pass;
    };
    const auto refusal = [&](const WingRow& row) -> std::string {
      try {
        pass_of(row);
        return "";
      } catch (const Error& error) {
        return error.what();
      }
    };
    const WingRows found = wing_rows(problem, params_.attempts, random(), refusal,
                                     [&](std::uint64_t rows) { return watch.spent(rows); });
    order.counters = {{"expanded", std::int64_t(found.iterations)}};
    order.budget_hit = !found.is_complete;
    if (found.rows.empty()) {
      order.status = !found.is_complete
                         ? watch.cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out
                         : PlanStatus::no_route;
      order.message = !found.is_complete      ? "the budget ended before the first tour"
                      : found.message.empty() ? "there is no place for a row: lower spacing_m"
                                              : found.message;
      return order;
    }
    for (const WingRow& row : found.rows) {
      order.passes.push_back({pass_of(row)});
    }
    order.status = PlanStatus::solved;
    order.closes = params_.closed;
    order.time_s = flown_time(order.route(ends, request), request);
    return order;  // nothing is known of other orders: the bound stays 0
  }

  TaskOrder do_order(const Request& request, const TaskEnds& ends) const override {
    if (request.vehicle.wing) {
      return order_of_wing(request, ends);
    }
    TaskOrder order;
    const Vehicle& vehicle = request.vehicle;
    const bool stops = !vehicle.acceleration.corner_radius_m;
    const LegTime time{request.air_speed(), stops ? vehicle.acceleration.mps2 : kInfinity};
    const auto place = [](const std::optional<Vec3>& end) {
      return end ? std::optional(flat(*end)) : std::nullopt;
    };
    BudgetWatch watch(request.budget);
    RandomStream random = request.random;
    std::uint64_t iterations = 0;
    double bound_s = 0;
    Tour tour;
    for (const Stage& stage :
         stages_of(areas_, place(ends.start), place(ends.goal), params_.closed)) {
      const std::string& name = names_[std::size_t(stage.area - areas_.data())];
      const Problem problem{*stage.area, params_.spacing_m, time,      stage.closed,
                            stage.start, stage.goal,        kUncovered};
      for (const auto& end : {problem.start, problem.goal}) {
        if (end && !stage.area->sees(*end, *end)) {
          order.status = PlanStatus::invalid_problem;
          order.message = "the start and the goal must lie outside the islands of the area";
          return order;
        }
      }
      const Sweep found = sweep(problem, params_.attempts, random(),
                                [&](std::uint64_t more) { return watch.spent(iterations + more); });
      iterations += found.iterations;
      order.counters = {{"expanded", std::int64_t(iterations)}};
      order.budget_hit = order.budget_hit || !found.is_complete;
      if (found.flown.points.empty()) {
        if (found.is_complete) {
          order.message = name + " is too small for a line: lower spacing_m";
          return order;
        }
        order.status = watch.cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out;
        order.message = "the budget ended before the first tour";
        return order;
      }
      for (std::size_t i = 0; i < found.flown.points.size(); ++i) {
        tour.go_to(found.flown.points[i], i == 0 ? char(0) : found.needed[i - 1]);
        tour.within.resize(tour.points.size(), stage.area);
      }
      bound_s = found.bound_s;
    }
    fill(order, std::move(tour), time, request, ends);
    // Of other speeds than the vehicle's own nothing is known, nor of ends beside the area, nor of
    // several.
    const auto is_beside = [&](const std::optional<Vec3>& end) {
      return end && areas_[0].is_outside(flat(*end));
    };
    const bool is_bounded = areas_.size() == 1 && request.vehicle.speed_near.empty() &&
                            !is_beside(ends.start) && !is_beside(ends.goal);
    order.bound_s = is_bounded ? std::min(bound_s, order.time_s) : 0;
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
      line = without_repeats(at_height(line));
      between.assign(line.begin() + 1, line.end() - (line.size() > 1 ? 1 : 0));
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
  Flight whole(Flight flight, const TaskEnds& ends) const {
    if (params_.closed && !ends.start && !ends.goal) {
      flight.go_to(Point2(flight.points.front()), 0);
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

  /// The tour as a closed one from home on: the start, or of several areas where it begins.
  static Tour from_home(Tour tour, const TaskEnds& ends) {
    const Point2 home = ends.start ? flat(*ends.start) : tour.points.front();
    if (home != tour.points.front()) {
      tour.points.insert(tour.points.begin(), home);
      tour.needed.insert(tour.needed.begin(), 0);
      tour.within.insert(tour.within.begin(), nullptr);
    }
    tour.go_to(home, 0);
    tour.within.resize(tour.points.size(), tour.within.front());
    return tour;
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

  void fill(TaskOrder& order, Tour tour, const LegTime& time, const Request& request,
            const TaskEnds& ends) const {
    std::vector<Flight> flights{whole(tour, ends)};
    if (params_.capacity_s) {
      tour = from_home(std::move(tour), ends);
      if (tour.seconds(time) > *params_.capacity_s) {
        flights = flights_of(tour, time, areas_.size() == 1 && !ends.start, *params_.capacity_s);
      }
    }
    if (flights.empty()) {
      order.message = "no flight of capacity_s covers the farthest pass and returns";
      return;
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
  }

  Params params_;
  std::vector<Area> areas_;
  std::vector<Area> outlines_;  ///< of each, without islands and their clearance
  std::vector<std::string> names_;
  double height_m_;
  World world_;  ///< with above_ground_m
};
}  // namespace
}  // namespace altiplan::cover

ALTIPLAN_PLUGIN(Task, "cover", altiplan::cover::Cover, altiplan::cover::Params,
                "covers an area with islands by parallel rows, in a tour of least time")
