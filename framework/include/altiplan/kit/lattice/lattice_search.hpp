// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/kit/lattice/lattice.hpp"
#include "altiplan/kit/lattice/move_rules.hpp"
#include "altiplan/kit/lattice/route_costs.hpp"
#include "altiplan/kit/lattice/step_costs.hpp"
#include "altiplan/planner.hpp"

/// \file What best-first searches over the cells of a lattice have in common: their settings, the
/// estimate of the way to go, and what they say in the end.
namespace altiplan::kit {

enum class Heuristic { octile, euclidean, manhattan, zero };

/// What a node of the search is where a rule looks at two legs.
enum class SearchState {
  parent,            ///< a cell, reached from one parent
  cell_and_heading,  ///< a cell and the direction in which it is reached
  automatic,         ///< the first, and the second where that finds nothing
};

struct SearchSettings {
  Vec3 cell_m{50, 50, 10};
  Neighbourhood neighbours = Neighbourhood::all;
  CornerRule corner = CornerRule::any;
  MoveCheck moves = MoveCheck::exact;
  StepCosts::Scale costs = StepCosts::Scale::fine;
  Heuristic heuristic = Heuristic::octile;
  double weight_g = 0.5;
  double weight_h = 0.5;
  SearchState state = SearchState::automatic;
  CostWeights cost;
  bool anytime = false;
  std::size_t max_bytes = ~std::size_t{0};

  /// How many times the length of a step the heuristic may fall along it.
  double stretch() const {
    return heuristic == Heuristic::zero        ? 0
           : heuristic == Heuristic::manhattan ? std::sqrt(3.0)
                                               : 1;
  }
  /// Whether no node's best way is found only after the node was closed.
  bool consistent() const {
    return weight_h <= weight_g && heuristic != Heuristic::manhattan &&
           (cost.length_alone() || cost.accumulate == Accumulate::length);
  }
};

/// The cost of the way between a cell and an end of the route, by the heuristic, and how that end
/// joins the lattice.
class Estimate {
 public:
  Estimate(const SearchSettings& settings, const Lattice& lattice, const Vec3& end,
           double tolerance_m, double cost_per_metre)
      : heuristic_(settings.heuristic),
        lattice_(lattice),
        end_(end),
        tolerance_m_(tolerance_m),
        per_metre_(cost_per_metre),
        links_(lattice.links(end)) {
    // A link counts only where no other is on a way from it to the end that is as short.
    for (const Lattice::Link& link : links_) {
      bool needed = true;
      for (const Lattice::Link& other : ends_) {
        needed = needed && link.length < lattice.distance(link.cell, other.cell) + other.length;
      }
      if (needed) {
        ends_.push_back(link);
      }
    }
  }

  /// Lower bound of the cost (but for `manhattan`).
  double operator()(const Cell& c) const { return per_metre_ * metres(c); }
  /// Lower bound, whatever the heuristic.
  double at_least(const Vec3& p) const {
    return per_metre_ * std::max(0.0, (p - end_).norm() - tolerance_m_);
  }
  const std::vector<Lattice::Link>& links() const { return links_; }
  /// The cell's link to the end, or null.
  const Lattice::Link* link_of(const Cell& c) const {
    for (const Lattice::Link& link : links_) {
      if (link.cell == c) {
        return &link;
      }
    }
    return nullptr;
  }

 private:
  double metres(const Cell& c) const {
    switch (heuristic_) {
      case Heuristic::octile: {
        if (ends_.empty()) {  // only the goal's tolerance is on the lattice
          return std::max(0.0, (lattice_.position(c) - end_).norm() - tolerance_m_);
        }
        double least = kInfinity;
        for (const Lattice::Link& end : ends_) {
          least = std::min(least, lattice_.distance(c, end.cell) + end.length);
        }
        return least;
      }
      case Heuristic::euclidean:
        return (lattice_.position(c) - end_).norm();
      case Heuristic::manhattan:
        return (lattice_.position(c) - end_).lpNorm<1>();
      case Heuristic::zero:
        break;
    }
    return 0;
  }

  Heuristic heuristic_;
  const Lattice& lattice_;
  Vec3 end_;
  double tolerance_m_;
  double per_metre_;
  std::vector<Lattice::Link> links_;
  std::vector<Lattice::Link> ends_;
};

/// Lowest place of a search: of the lattice, or an end of the route.
inline double lowest(const Request& request, const Lattice& lattice) {
  return std::min(
      {lattice.position({0, 0, 0}).z(), request.start.position.z(), request.goal.position.z()});
}

/// What a search has done so far.
struct SearchStats {
  std::uint64_t expanded = 0;
  std::int64_t generated = 0;
  Vec3 nearest{0, 0, 0};  ///< of the expanded cells to the goal
  bool memory_full = false;
  bool too_long = false;  ///< route_length refused something
};

inline Counters counters(const SearchStats& progress, const Lattice& lattice, const MoveRules& rules) {
  return {{"expanded", std::int64_t(progress.expanded)},
          {"generated", progress.generated},
          {"moves_checked", rules.moves_checked()},
          {"lattice_cells", std::int64_t(lattice.size())}};
}

/// Says why there is no route: how far the search came, and what stopped it.
inline std::string explanation(PlanStatus status, const SearchStats& progress, const Request& request,
                               const Lattice& lattice, const MoveRules& rules) {
  std::string text = status == PlanStatus::no_route    ? "no route"
                     : status == PlanStatus::cancelled ? "cancelled"
                     : progress.memory_full            ? "the memory allowed was used up"
                                                       : "the budget was used up";
  text += ": " + std::to_string(progress.expanded) + " of " + std::to_string(lattice.size()) +
          " cells expanded";
  if (progress.expanded > 0) {
    const Vec3& at = progress.nearest;
    const auto whole = [](double value) { return std::to_string(std::llround(value)); };
    text += ", the nearest to the goal at (" + whole(at.x()) + ", " + whole(at.y()) + ", " +
            whole(at.z()) + "), " + whole((at - request.goal.position).norm()) + " m from it";
  } else if (status == PlanStatus::no_route) {
    text += ", the start cannot join the lattice";
  }
  const std::string refusals = rules.refusals();
  if (!refusals.empty()) {
    text += "; refused moves: " + refusals;
  }
  if (progress.too_long) {
    text += "; parts of the search left out by route_length";
  }
  return text;
}

/// The route from the start over the cells that led to `last`: `step_to(index, likely)` is the
/// direction of the step to a cell, kHere at a cell that is linked to the start, and `likely` that
/// of the step after it; `at_start(index)` is whether that link has no length.
template <class StepTo, class AtStart>
Route route_to(std::uint32_t last, const Request& request, const Lattice& lattice,
               const StepTo& step_to, const AtStart& at_start) {
  Route route;
  std::uint32_t index = last;
  for (int d = step_to(index, kHere); d != kHere; d = step_to(index, d)) {
    route.push_back(lattice.position(lattice.cell(index)));
    index = std::uint32_t(std::int64_t(index) - lattice.stride(d));
  }
  if (!at_start(index)) {
    route.push_back(lattice.position(lattice.cell(index)));
  }
  route.push_back(request.start.position);
  std::reverse(route.begin(), route.end());
  return route;
}

/// What one search gave.
struct SearchResult {
  PlanResult result;
  double cost = kInfinity;  ///< of the route
  bool at_goal = false;     ///< not only within its tolerance
  bool parent_mattered = false;
};

/// Adds what a further search has counted; the size of the lattice stays.
inline void add(Counters& all, const Counters& more) {
  if (all.empty()) {
    all = more;
    return;
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name != "lattice_cells") {
      all[i].value += more[i].value;
    }
  }
}

/// The request with what is left of its budget.
inline Request after(const Request& request, const Counters& spent) {
  Request rest = request;
  if (!spent.empty() && rest.budget.max_iterations != ~std::uint64_t{0}) {
    rest.budget.max_iterations -= std::uint64_t(spent.front().value);  // expanded
  }
  return rest;
}

/// The result without the route that it may have.
inline PlanResult without_route(PlanResult result) {
  if (result.status == PlanStatus::solved) {
    result.status = PlanStatus::timed_out;
    result.message =
        "the budget was used up before the goal was reached or known to be out of reach";
    result.route.clear();
  }
  return result;
}

/// Anytime search by restarts: at first the heuristic counts many times, in the end once, and no
/// part of a search that cannot better the best route so far is looked at. `once(settings, request,
/// cost)` is one search for a route that costs less. E. A. Hansen, R. Zhou, Anytime Heuristic
/// Search, JAIR 28, 2007, doi:10.1613/jair.2096; restarts: S. Richter, J. Thayer, W. Ruml, The Joy
/// of Forgetting, ICAPS 2010.
template <class Once>
PlanResult improve(const SearchSettings& settings, const Request& request, const Once& once) {
  std::optional<SearchResult> best;
  Counters spent;
  int searches = 0;
  for (const double inflation : {16.0, 4.0, 2.0, 1.4, 1.0}) {
    SearchSettings inflated = settings;
    inflated.weight_h *= inflation;
    const bool can_improve = best && best->at_goal;
    SearchResult found = once(inflated, after(request, spent), can_improve ? best->cost : kInfinity);
    add(spent, found.result.counters);
    ++searches;
    const bool cut_short = found.result.budget_hit || found.result.status == PlanStatus::cancelled;
    // A route that ends within the tolerance counts only once the goal is known to be out of reach:
    // otherwise more budget could give a longer route.
    const bool counts = found.result.status == PlanStatus::solved && (found.at_goal || !cut_short);
    if (counts && (!best || found.cost < best->cost)) {
      best = std::move(found);
    } else if (!best && (cut_short || found.result.proved || inflation == 1)) {
      found.result.counters = spent;
      return without_route(std::move(found.result));
    }
    if (cut_short) {
      best->result.budget_hit = true;
      break;
    }
  }
  best->result.message += "; the best of " + std::to_string(searches) + " searches";
  best->result.counters = std::move(spent);
  return std::move(best->result);
}

/// Ends the route at the goal; `at_goal`: the last cell's centre is the goal but for rounding.
inline void end_at_goal(Route& route, const Vec3& goal, bool at_goal) {
  if (at_goal && route.size() > 1) {
    route.back() = goal;
  } else {
    route.push_back(goal);
  }
}

inline PlanResult solved(Route route, const SearchStats& progress, const Lattice& lattice,
                         const MoveRules& rules) {
  PlanResult result;
  result.status = PlanStatus::solved;
  result.route = std::move(route);
  result.message = "a route of " + std::to_string(length(result.route)) + " m, " +
                   std::to_string(progress.expanded) + " cells expanded";
  result.counters = counters(progress, lattice, rules);
  return result;
}

/// What every search over the cells of a lattice holds: the problem, its rules and costs, and what
/// has been done so far. All that the constructor is given must outlive it; a route that costs
/// `best_cost` or more is of no use.
class LatticeSearch {
 protected:
  LatticeSearch(const Request& request, const SearchSettings& settings, const Lattice& lattice,
                double best_cost)
      : request_(request),
        settings_(settings),
        lattice_(lattice),
        rules_(request, lattice, settings.moves, settings.corner),
        costs_(settings.cost, request, lowest(request, lattice)),
        to_goal_(settings, lattice, request.goal.position, request.goal.tolerance_m,
                 costs_.min_per_metre()),
        watch_(request.budget),
        start_(request.start.position),
        goal_(request.goal.position),
        longest_(request.limits.max_route_length + kLengthTolerance),
        best_cost_(best_cost) {}

  /// Evaluations that differ by less are equal: far below a metre's share of any route, far above
  /// the rounding of its sum.
  double quantum() const {
    const double of_length = settings_.cost.length > 0 ? std::min(settings_.cost.length, 1.0) : 1;
    return std::max((goal_ - start_).norm(), 1.0) * 1e-12 * of_length *
           std::max(settings_.weight_g, settings_.weight_h);
  }
  /// f = w_g g + w_h h of a cell.
  double evaluation(double g, const Cell& c, const Vec3& at) const {
    return settings_.weight_g * (g + costs_.at(at)) + settings_.weight_h * to_goal_(c);
  }
  double step_cost(int d, const Vec3& a, const Vec3& b) const {
    return costs_.length_alone() ? lattice_.step_length(d)
                                 : costs_.leg(a, b, lattice_.step_length(d));
  }
  double link_cost(const Vec3& a, const Vec3& b, double length) const {
    return length == 0 ? 0 : costs_.leg(a, b, length);
  }
  /// Whether a way of that length to the place is too long, whatever follows.
  bool too_long(double length, const Vec3& at) {
    const bool beyond =
        longest_ < kInfinity && length + (goal_ - at).norm() - request_.goal.tolerance_m > longest_;
    progress_.too_long = progress_.too_long || beyond;
    return beyond;
  }
  /// Whether a way of that cost to the place betters no route known.
  bool exceeds_incumbent(double g, const Vec3& at) const {
    return best_cost_ < kInfinity && g + to_goal_.at_least(at) >= best_cost_;
  }
  /// Whether lengths are to be known beside costs.
  bool keeps_lengths() const { return longest_ < kInfinity && !costs_.length_alone(); }
  /// Whether what was left out as too long is too long on every way.
  bool lengths_prove() const {
    return !progress_.too_long || (settings_.consistent() && !keeps_lengths());
  }

  void remember_nearest(const Vec3& here) {
    const double distance = (here - goal_).squaredNorm();
    if (distance < nearest_) {
      nearest_ = distance;
      progress_.nearest = here;
    }
  }

  /// The status of a search that its budget ends.
  PlanStatus ended() const {
    return watch_.cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out;
  }
  SearchResult with(Route route, double cost, bool at_goal, bool budget_hit) const {
    SearchResult found;
    found.cost = cost;
    found.at_goal = at_goal;
    found.result = solved(std::move(route), progress_, lattice_, rules_);
    found.result.budget_hit = budget_hit;
    return found;
  }
  SearchResult without(PlanStatus status, bool proved) const {
    SearchResult found;
    found.parent_mattered = rules_.parent_mattered();
    found.result.status = status;
    found.result.budget_hit = status != PlanStatus::no_route;
    found.result.proved = proved && status == PlanStatus::no_route;
    found.result.message = explanation(status, progress_, request_, lattice_, rules_);
    found.result.counters = counters(progress_, lattice_, rules_);
    return found;
  }

  const Request& request_;
  const SearchSettings& settings_;
  const Lattice& lattice_;
  MoveRules rules_;
  RouteCosts costs_;
  Estimate to_goal_;
  BudgetWatch watch_;
  Vec3 start_;
  Vec3 goal_;
  double longest_;  ///< metres that a route may have
  double best_cost_;
  double nearest_ = kInfinity;
  SearchStats progress_;
};
}  // namespace altiplan::kit
