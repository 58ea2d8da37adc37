// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/kit/lattice/lattice.hpp"
#include "altiplan/measures.hpp"
#include "altiplan/planner.hpp"
#include "anya_parts.hpp"
#include "anya_search.hpp"

namespace altiplan::anya {

/// One plan: joins the ends of the route to the cells, searches, and makes a result of that.
class Plan {
 public:
  /// All arguments must outlive it.
  Plan(const Request& request, const kit::Lattice& lattice, const VoxelGrid& grid, Corner rule,
       std::size_t max_bytes, Memory& memory)
      : request_(request),
        lattice_(lattice),
        grid_(grid),
        level_(grid, lattice.spec().cell),
        rule_(rule),
        max_bytes_(max_bytes),
        memory_(memory),
        watch_(request.budget) {}

  PlanResult result() {
    const std::vector<Target> starts = joined(request_.start.position);
    PlanResult exact = search(starts, joined(request_.goal.position), true);
    if (exact.status != PlanStatus::no_route) {
      return exact;
    }
    const std::vector<Target> near_goal = within_tolerance();
    return near_goal.empty() ? exact : search(starts, near_goal, false);
  }

 private:
  /// Coordinates on the level; what differs from a centre or a corner by rounding alone is one.
  Point place(const Vec3& p) const {
    const GridSpec& spec = lattice_.spec();
    const auto along = [&](int axis) {
      const double at = (p[axis] - spec.origin[axis]) / spec.cell[axis];
      const double half = std::round(2 * at) / 2;
      return std::abs(at - half) < 1e-9 ? half : at;
    };
    return {along(0), along(1)};
  }
  Vec3 position(double x, double y) const {
    const GridSpec& spec = lattice_.spec();
    return {spec.origin.x() + x * spec.cell.x(), spec.origin.y() + y * spec.cell.y(),
            request_.start.position.z()};
  }

  /// The point as an end of a search; it has no parts if no cell that it touches is free.
  Target target(const Point& at, double g) const {
    Target target{at, g, {}};
    if (!(at.y >= 0 && at.y <= level_.height())) {
      return target;
    }
    for (int row = at.y == int(at.y) ? int(at.y) - 1 : int(at.y); row <= int(at.y); ++row) {
      if (const std::optional<Run> run = level_.run_at(row, at.x)) {
        target.parts.push_back({row, *run});
      }
    }
    return target;
  }

  /// Visits the centres of the free ones of the nine cells around a point.
  template <class Visit>
  void for_each_centre(const Vec3& p, const Visit& visit) const {
    const Cell own = lattice_.nearest(p).cell;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell cell{own[0] + dx, own[1] + dy, 0};
        if (lattice_.spec().holds(cell) && !grid_.blocked(cell)) {
          visit(lattice_.position(cell));
        }
      }
    }
  }

  /// Where an end of the route joins the cells: itself in or beside a free one, else at the centres
  /// around it to which a straight leg leads.
  std::vector<Target> joined(const Vec3& p) const {
    if (Target own = target(place(p), 0); !own.parts.empty()) {
      return {std::move(own)};
    }
    std::vector<Target> all;
    for_each_centre(p, [&](const Vec3& centre) {
      if (leg_ok(std::nullopt, p, centre, request_) && leg_ok(std::nullopt, centre, p, request_)) {
        all.push_back(target(place(centre), (centre - p).norm()));
      }
    });
    return all;
  }

  /// Centres to end at instead of the goal itself.
  std::vector<Target> within_tolerance() const {
    std::vector<Target> all;
    const Vec3& goal = request_.goal.position;
    for_each_centre(goal, [&](const Vec3& centre) {
      if ((centre - goal).norm() > kLengthTolerance && request_.goal.reached_at(centre)) {
        all.push_back(target(place(centre), 0));
      }
    });
    return all;
  }

  /// `exact`: the route ends at the goal's position, else at the target that it reaches.
  PlanResult search(const std::vector<Target>& starts, const std::vector<Target>& targets,
                    bool exact) {
    Search search(level_, rule_, targets, watch_, max_bytes_, memory_, effort_);
    if (!targets.empty()) {
      for (const Target& start : starts) {
        search.start(start.at, start.g);
      }
    }
    const Search::End end = search.run([&](std::uint32_t root, double f) {
      if (request_.trace != nullptr) {
        const Root& from = search.root(root);
        request_.trace->add({TraceEvent::Kind::expanded, std::int64_t(root),
                             from.parent == Search::kNone ? -1 : std::int64_t(from.parent),
                             position(from.x, from.y), f});
      }
    });
    PlanResult result;
    if (end == Search::End::found) {
      result.status = PlanStatus::solved;
      result.route = route(search, targets[search.goal().target], exact);
      result.message = "a route of " + whole(length(result.route)) + " m";
    } else {
      result = without_route(search, end,
                             starts.empty()    ? "start"
                             : targets.empty() ? "goal"
                                               : nullptr);
    }
    result.message += ", " + std::to_string(effort_.expanded) + " intervals expanded";
    result.counters = {{"expanded", std::int64_t(effort_.expanded)},
                       {"generated", effort_.generated},
                       {"lattice_cells", std::int64_t(lattice_.size())}};
    return result;
  }

  Polyline route(const Search& search, const Target& target, bool exact) const {
    std::vector<Point> points{target.at};  // from the last on
    const auto add = [&](const Point& p) {
      if (const std::size_t count = points.size(); count > 1) {
        const Point& b = points[count - 1];
        const Point& a = points[count - 2];
        if ((b.x - a.x) * (p.y - b.y) == (b.y - a.y) * (p.x - b.x)) {
          points.pop_back();
        }
      }
      points.push_back(p);
    };
    const Node& goal = search.goal();
    if (goal.bends) {
      add({goal.from, double(goal.line)});
    }
    for (std::uint32_t n = goal.root; n != Search::kNone; n = search.root(n).parent) {
      add({search.root(n).x, search.root(n).y});
    }
    Polyline route{request_.start.position};
    const auto is_at = [&](const Vec3& end, const Point& p) {
      const Point at = place(end);
      return at.x == p.x && at.y == p.y;
    };
    for (std::size_t n = points.size(); n-- > 0;) {
      const bool is_start = n + 1 == points.size() && is_at(request_.start.position, points[n]);
      const bool is_goal = n == 0 && exact && is_at(request_.goal.position, points[n]);
      if (!is_start && !is_goal) {
        route.push_back(position(points[n].x, points[n].y));
      }
    }
    if (exact) {
      route.push_back(request_.goal.position);
    }
    return route;
  }

  static std::string whole(double value) { return std::to_string(std::llround(value)); }

  /// The result of a search that did not reach the goal, with the reason; `apart` is the end of the
  /// route that no leg joins to the cells.
  PlanResult without_route(const Search& search, Search::End end, const char* apart) const {
    PlanResult result;
    result.budget_hit = end == Search::End::spent;
    result.status = !result.budget_hit   ? PlanStatus::no_route
                    : watch_.cancelled() ? PlanStatus::cancelled
                                         : PlanStatus::timed_out;
    result.message = !result.budget_hit     ? "no route"
                     : watch_.cancelled()   ? "cancelled"
                     : search.memory_full() ? "the memory allowed was used up"
                                            : "the budget was used up";
    if (apart != nullptr) {
      result.message += std::string(": the ") + apart + " cannot join the lattice";
    } else {
      const Vec3 at = position(search.nearest().x, search.nearest().y);
      result.message += ": the turn nearest to the goal is at " + request_.place_text(at) + ", " +
                        whole((at - request_.goal.position).norm()) + " m from it" +
                        (result.budget_hit ? "" : "; blocked cells bar every path on");
    }
    // Cells farther from the goal than its neighbours were not looked for.
    result.proved = result.status == PlanStatus::no_route &&
                    request_.goal.tolerance_m < lattice_.spec().cell.head<2>().minCoeff();
    return result;
  }

  const Request& request_;
  const kit::Lattice& lattice_;
  const VoxelGrid& grid_;
  Level level_;
  Corner rule_;
  std::size_t max_bytes_;
  Memory& memory_;
  BudgetWatch watch_;
  Search::Effort effort_;
};
}  // namespace altiplan::anya
