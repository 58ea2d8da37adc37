// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/kit/lattice/lattice.hpp"
#include "altiplan/kit/lattice/line_of_sight.hpp"
#include "altiplan/kit/lattice/move_rules.hpp"
#include "altiplan/kit/sampling/leg_rules.hpp"
#include "altiplan/planner.hpp"
#include "planes.hpp"

namespace altiplan::slicing {

/// A point of a plane, and the length of the path through it.
struct Candidate {
  double cost;
  std::uint32_t index;  ///< index of its cell

  /// For a heap whose top has the minimum cost, among equals the minimum index.
  friend bool operator<(const Candidate& a, const Candidate& b) {
    return a.cost != b.cost ? a.cost > b.cost : a.index > b.index;
  }
};

/// One plan. All constructor arguments must outlive it.
class Search {
 public:
  Search(const Request& request, const kit::Lattice& lattice, const Planes& planes,
         std::vector<Candidate>& candidates)
      : request_(request),
        lattice_(lattice),
        planes_(planes),
        grid_(kit::occupancy(request, lattice)),
        rules_(request),
        watch_(request.budget),
        goal_(request.goal.position),
        candidates_(candidates) {}

  PlanResult run() {
    route_ = {request_.start.position};
    if (planes_.count == 0 && !look_at(goal_, 0)) {
      return given_up(0);
    }
    for (int i = 0; i < planes_.count; ++i) {
      std::optional<Vec3> p_i = on_line(i);
      if (!look_at(*p_i, i)) {
        p_i = min_way_round(i);
        ++moved_;
      }
      if (!p_i) {
        const bool at_an_end = request_.goal.reached_at(route_.back()) && !is_too_long(length_);
        return at_an_end && !spent_ ? solved() : given_up(i);
      }
      length_ += (*p_i - route_.back()).norm();
      parent_ = node_;
      route_.push_back(*p_i);
    }
    if (!ends_early_) {
      route_.push_back(goal_);
    }
    return solved();
  }

 private:
  bool is_last(int plane) const { return plane + 1 >= planes_.count; }

  /// Intersection of the line from the last point to the goal with a plane; after the last one, the
  /// goal.
  Vec3 on_line(int plane) const {
    if (plane >= planes_.count) {
      return goal_;
    }
    const int axis = planes_.axis;
    Cell cell{};
    cell[std::size_t(axis)] = planes_.cell(plane);
    const double at = lattice_.spec().centre(cell)[axis];
    const Vec3 way = goal_ - route_.back();
    Vec3 p = route_.back() + (at - route_.back()[axis]) / way[axis] * way;
    p[axis] = at;
    return p;
  }

  /// True if the route may continue to a point of the plane, from the last plane also to the goal.
  bool look_at(const Vec3& p, int plane) {
    spent_ = spent_ || watch_.spent(std::uint64_t(looked_at_));
    if (spent_) {
      return false;
    }
    node_ = looked_at_++;
    const Vec3& from = route_.back();
    const double length = length_ + (p - from).norm();
    const double way = length + (goal_ - p).norm();
    if (request_.trace != nullptr) {
      request_.trace->add({TraceEvent::Kind::expanded, node_, parent_, p, way});
    }
    if (is_too_long(way - request_.goal.tolerance_m) || !leg_free(before(), from, p)) {
      return false;
    }
    if (!is_last(plane)) {
      return true;
    }
    if (!is_too_long(way) && (p == goal_ || leg_free(onward(before(), from), p, goal_))) {
      return true;
    }
    if (!within_tolerance_ && request_.goal.reached_at(p) && !is_too_long(length)) {
      within_tolerance_ = p;
    }
    return false;
  }

  bool is_too_long(double length) {
    const bool is = length > request_.limits.max_route_length + kLengthTolerance;
    too_long_ = too_long_ || is;
    return is;
  }

  /// True if a leg satisfies every constraint and, if it joins the centres of two cells, intersects
  /// no blocked one.
  bool leg_free(const std::optional<Approach>& before, const Vec3& a, const Vec3& b) {
    const kit::Lattice::Link from = lattice_.nearest(a);
    const kit::Lattice::Link to = lattice_.nearest(b);
    if (from.length == 0 && to.length == 0 && !kit::line_of_sight(*grid_, from.cell, to.cell)) {
      ++out_of_sight_;
      return false;
    }
    return rules_.ok(before, a, b);
  }

  /// The reachable point of the plane that minimises |p_(i-1) p_i| + |p_i p_(i+1)|, where p_(i+1)
  /// is the line's on the next plane. If no point of the last plane leads on to the goal, the
  /// minimum one within its tolerance.
  std::optional<Vec3> min_way_round(int plane) {
    const Way way{route_.back(), on_line(plane + 1)};
    const double farthest = farthest_on(plane, way);
    free_cells_ = 0;
    // Few points need checking where the plane is free: rings of them, ever wider.
    double inner = 0;
    double outer = way.straight();
    for (double wider = lattice_.spec().cell.norm(); inner < farthest; wider *= 4) {
      outer += wider;
      gather(plane, way, inner, outer);
      free_cells_ += candidates_.size();
      std::make_heap(candidates_.begin(), candidates_.end());
      for (auto end = candidates_.end(); end != candidates_.begin() && !spent_; --end) {
        std::pop_heap(candidates_.begin(), end);
        const Vec3 p = lattice_.position(lattice_.cell((end - 1)->index));
        if (look_at(p, plane)) {
          return p;
        }
      }
      inner = outer;
    }
    ends_early_ = !spent_ && within_tolerance_;
    return ends_early_ ? within_tolerance_ : std::nullopt;
  }

  /// The path from one point to another via a third.
  struct Way {
    Vec3 from;
    Vec3 to;
    double over(const Vec3& p) const { return (p - from).norm() + (to - p).norm(); }
    double straight() const { return (to - from).norm(); }
  };

  /// Cells of a plane: the first, and one past the last, on each axis.
  std::pair<Cell, Cell> cells_of(int plane) const {
    const auto axis = std::size_t(planes_.axis);
    std::pair<Cell, Cell> cells{{0, 0, 0}, lattice_.spec().counts};
    cells.first[axis] = planes_.cell(plane);
    cells.second[axis] = planes_.cell(plane) + 1;
    return cells;
  }

  /// The longest path via a point of the plane: as path lengths are convex, via a corner.
  double farthest_on(int plane, const Way& way) const {
    const auto [low, high] = cells_of(plane);
    double farthest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      Cell cell = low;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        cell[axis] = (corner >> axis & 1) != 0 ? high[axis] - 1 : low[axis];
      }
      farthest = std::max(farthest, way.over(lattice_.position(cell)));
    }
    return farthest;
  }

  /// The plane's free cells via which the path is longer than `inner`, and not longer than `outer`.
  void gather(int plane, const Way& way, double inner, double outer) {
    auto [low, high] = cells_of(plane);
    const GridSpec& spec = lattice_.spec();
    // No such path leads farther from the middle of its ends than half its length.
    const Vec3 middle = ((way.from + way.to) / 2 - spec.origin).cwiseQuotient(spec.cell);
    const Vec3 reach = Vec3::Constant(outer / 2).cwiseQuotient(spec.cell);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double from = std::floor(middle[int(axis)] - reach[int(axis)]) - 1;
      const double to = std::ceil(middle[int(axis)] + reach[int(axis)]) + 1;
      low[axis] = int(std::max(from, double(low[axis])));
      high[axis] = int(std::min(to, double(high[axis])));
    }
    candidates_.clear();
    for (int k = low[2]; k < high[2]; ++k) {
      for (int j = low[1]; j < high[1]; ++j) {
        for (int i = low[0]; i < high[0]; ++i) {
          const Cell cell = {i, j, k};
          const double cost = way.over(lattice_.position(cell));
          if (cost > inner && cost <= outer && !grid_->blocked(cell)) {
            candidates_.push_back({cost, lattice_.index(cell)});
          }
        }
      }
    }
  }

  std::optional<Approach> before() const {
    return approach(route_, route_.size() - 1, request_.before_start());
  }

  /// Removes points on the straight line from the point before to the one after, if the changed
  /// legs satisfy every constraint.
  void straighten() {
    Polyline kept = {route_.front()};
    for (std::size_t i = 1; i + 1 < route_.size(); ++i) {
      const Vec3& a = kept.back();
      const std::optional<Approach> before =
          approach(kept, kept.size() - 1, request_.before_start());
      const bool idle =
          point_leg_distance(route_[i], a, route_[i + 1]) <= kLengthTolerance / 2 &&
          rules_.ok(before, a, route_[i + 1]) &&
          (i + 2 == route_.size() || rules_.ok(onward(before, a), route_[i + 1], route_[i + 2]));
      if (!idle) {
        kept.push_back(route_[i]);
      }
    }
    kept.push_back(route_.back());
    route_ = std::move(kept);
  }

  PlanResult solved() {
    straighten();
    PlanResult result;
    result.status = PlanStatus::solved;
    result.message = "a route of " + std::to_string(length(route_)) + " m through " +
                     std::to_string(planes_.count) + " planes, moved off the line on " +
                     std::to_string(moved_) + " of them";
    result.route = std::move(route_);
    result.counters = counters();
    return result;
  }

  PlanResult given_up(int plane) {
    PlanResult result;
    result.status = !spent_              ? PlanStatus::no_route
                    : watch_.cancelled() ? PlanStatus::cancelled
                                         : PlanStatus::timed_out;
    result.budget_hit = spent_;
    result.message = !spent_              ? "no route: " + why(plane)
                     : watch_.cancelled() ? "cancelled: " + where(plane)
                                          : "the budget was used up: " + where(plane);
    result.counters = counters();
    return result;
  }

  std::string where(int plane) const {
    const char axis = "xyz"[planes_.axis];
    const auto metres = [](double value) { return std::to_string(std::llround(value)); };
    if (planes_.count == 0) {
      return std::string("no plane lies between start and goal, at ") + axis + " = " +
             metres(route_.back()[planes_.axis]) + " and " + metres(goal_[planes_.axis]) + " m";
    }
    const Vec3& from = route_.back();
    return "on plane " + std::to_string(plane + 1) + " of " + std::to_string(planes_.count) +
           ", at " + axis + " = " + metres(on_line(plane)[planes_.axis]) + " m, from (" +
           metres(from.x()) + ", " + metres(from.y()) + ", " + metres(from.z()) + ")";
  }

  std::string why(int plane) const {
    std::string text = where(plane);
    if (planes_.count == 0) {
      text += ", and the straight leg is not free";
    } else {
      text += " none of " + std::to_string(free_cells_) + " free cells can be reached";
      text += is_last(plane) ? " and continued to the goal" : "";
    }
    std::string refusals =
        out_of_sight_ == 0 ? "" : "blocked cells (" + std::to_string(out_of_sight_) + ")";
    const std::string rules = rules_.refusals();
    refusals += (refusals.empty() || rules.empty() ? "" : ", ") + rules;
    text += refusals.empty() ? "" : "; refused legs: " + refusals;
    return text + (too_long_ ? "; some would make the route longer than route_length" : "");
  }

  Counters counters() const {
    return {{"expanded", looked_at_},
            {"moves_checked", rules_.checked() + out_of_sight_},
            {"lattice_cells", std::int64_t(lattice_.size())},
            {"planes", planes_.count},
            {"planes_moved", moved_}};
  }

  const Request& request_;
  const kit::Lattice& lattice_;
  const Planes planes_;
  std::shared_ptr<const VoxelGrid> grid_;
  kit::LegRules rules_;
  BudgetWatch watch_;
  const Vec3 goal_;
  std::vector<Candidate>& candidates_;
  Polyline route_;     ///< p_0 … p_(i-1)
  double length_ = 0;  ///< its length
  std::int64_t looked_at_ = 0;
  std::int64_t node_ = -1;                ///< in the trace: the last point examined,
  std::int64_t parent_ = -1;              ///< and the last of the route
  std::int64_t out_of_sight_ = 0;         ///< legs between centres that blocked cells obstruct
  std::int64_t moved_ = 0;                ///< planes on which the line's point was not free
  std::size_t free_cells_ = 0;            ///< of the last plane where it was not
  std::optional<Vec3> within_tolerance_;  ///< first point of the last plane that is an end
  bool ends_early_ = false;               ///< at that point
  bool spent_ = false;
  bool too_long_ = false;
};
}  // namespace altiplan::slicing
