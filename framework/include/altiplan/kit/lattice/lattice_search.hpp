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
#include "altiplan/kit/lattice/step_means.hpp"
#include "altiplan/planner.hpp"

/// \file Common parts of best-first searches over the cells of a lattice: their settings, the
/// estimate of the cost-to-go, and their final messages.
namespace altiplan::kit {

enum class Heuristic { octile, euclidean, manhattan, zero };

/// State of the search where a constraint depends on two legs.
enum class SearchState {
  parent,            ///< a cell, reached from one parent
  cell_and_heading,  ///< a cell and the direction into it
  automatic,         ///< the first, and the second if that finds nothing
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
  bool runs = true;  ///< of CellSearch, in space: straight runs are one step
  std::size_t max_bytes = ~std::size_t{0};

  /// Maximum decrease of the heuristic along a step, in units of the step's length.
  double stretch() const {
    return heuristic == Heuristic::zero        ? 0
           : heuristic == Heuristic::manhattan ? std::sqrt(3.0)
                                               : 1;
  }
  /// True if the heuristic is consistent: a closed node never gets a better path.
  bool consistent() const {
    return weight_h <= weight_g && heuristic != Heuristic::manhattan &&
           (cost.length_alone() || cost.accumulate == Accumulate::length);
  }
};

/// Heuristic cost of the path between a cell and an end of the route, and that end's connections to
/// the lattice. Under an objective it is the objective's bound, unless the heuristic is zero.
class Estimate {
 public:
  /// `to_start`: of the path from the end to the cell.
  Estimate(const Request& request, const SearchSettings& settings, const Lattice& lattice,
           const Vec3& end, double tolerance_m, double cost_per_metre, bool to_start = false)
      : request_(request),
        to_start_(to_start),
        heuristic_(settings.heuristic),
        lattice_(lattice),
        end_(end),
        tolerance_m_(tolerance_m),
        per_metre_(cost_per_metre),
        links_(lattice.links(end)) {
    // A link is dropped if another one is on an equally short path from it to the end.
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

  /// Lower bound of the cost (except with `manhattan`).
  double operator()(const Cell& c) const {
    if (request_.objective) {
      return heuristic_ == Heuristic::zero ? 0 : bound(lattice_.position(c));
    }
    return per_metre_ * metres(c);
  }
  /// Lower bound, whatever the heuristic.
  double at_least(const Vec3& p) const {
    if (request_.objective) {
      return tolerance_m_ > 0 ? 0 : bound(p);
    }
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
  double bound(const Vec3& p) const {
    const Objective& objective = *request_.objective;
    return to_start_ ? objective.bound(end_, p, request_) : objective.bound(p, end_, request_);
  }
  double metres(const Cell& c) const {
    switch (heuristic_) {
      case Heuristic::octile: {
        if (ends_.empty()) {  // only the goal's tolerance is on the lattice
          return std::max(0.0, (lattice_.position(c) - end_).norm() - tolerance_m_);
        }
        double minimum = kInfinity;
        for (const Lattice::Link& end : ends_) {
          minimum = std::min(minimum, lattice_.distance(c, end.cell) + end.length);
        }
        return minimum;
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

  const Request& request_;
  bool to_start_;
  Heuristic heuristic_;
  const Lattice& lattice_;
  Vec3 end_;
  double tolerance_m_;
  double per_metre_;
  std::vector<Lattice::Link> links_;
  std::vector<Lattice::Link> ends_;
};

/// Minimum z of a search: of the lattice, or an end of the route.
inline double lowest(const Request& request, const Lattice& lattice) {
  return std::min(
      {lattice.position({0, 0, 0}).z(), request.start.position.z(), request.goal.position.z()});
}

/// Statistics of a search so far.
struct SearchStats {
  std::uint64_t expanded = 0;
  std::int64_t generated = 0;
  Vec3 nearest{0, 0, 0};  ///< the expanded cell nearest to the goal
  bool memory_full = false;
  bool too_long = false;           ///< route_length refused something
  std::string pruned_by;           ///< the limit on a total that refused something
  std::optional<Vec3> unpriced{};  ///< the end of a leg that the objective has no cost for
};

inline Counters counters(const SearchStats& progress, const Lattice& lattice,
                         const MoveRules& rules) {
  return {{"expanded", std::int64_t(progress.expanded)},
          {"generated", progress.generated},
          {"moves_checked", rules.moves_checked()},
          {"lattice_cells", std::int64_t(lattice.size())}};
}

/// Explanation of a missing route: how far the search got, and what stopped it.
inline std::string explanation(PlanStatus status, const SearchStats& progress,
                               const Request& request, const Lattice& lattice,
                               const MoveRules& rules) {
  std::string text = status == PlanStatus::no_route    ? "no route"
                     : status == PlanStatus::cancelled ? "cancelled"
                     : progress.memory_full            ? "max_memory_mb or within_mb is used up"
                                                       : "the budget was used up";
  text += ": " + std::to_string(progress.expanded) + " of " + std::to_string(lattice.size()) +
          " cells expanded";
  if (progress.expanded > 0) {
    const Vec3& at = progress.nearest;
    text += ", the nearest to the goal at " + request.place_text(at) + ", " +
            std::to_string(std::llround((at - request.goal.position).norm())) + " m from it";
  } else if (status == PlanStatus::no_route) {
    text += ", the start cannot join the lattice";
  }
  const std::string refusals = rules.refusals();
  text += refusals.empty() ? "" : "; refused moves: " + refusals;
  if (progress.unpriced) {
    text += "; legs without a cost by the objective left out, such as one to " +
            request.place_text(*progress.unpriced);
  }
  if (progress.too_long) {
    text += "; parts of the search pruned by route_length";
  }
  if (!progress.pruned_by.empty()) {
    text += "; parts of the search pruned by " + progress.pruned_by;
  }
  return text;
}

/// The route from the start over the cells to `last`: `step_to(index, likely)` is the direction of
/// the step into a cell, kHere at a cell that is linked to the start, and `likely` that of the step
/// after it; `at_start(index)` is true if that link has length zero.
template <class StepTo, class AtStart>
Polyline route_to(std::uint32_t last, const Request& request, const Lattice& lattice,
                  const StepTo& step_to, const AtStart& at_start) {
  Polyline route;
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

/// Result of one search.
struct SearchResult {
  PlanResult result;
  double cost = kInfinity;  ///< of the route
  bool at_goal = false;     ///< exactly, not only within its tolerance
  bool parent_mattered = false;
};

/// Adds the counters of a further search; the size of the lattice stays.
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

/// The request with the remaining budget.
inline Request after(const Request& request, const Counters& spent) {
  Request rest = request;
  if (!spent.empty() && rest.budget.max_iterations != ~std::uint64_t{0}) {
    rest.budget.max_iterations -= std::uint64_t(spent.front().value);  // expanded
  }
  return rest;
}

/// The result with its route removed.
inline PlanResult without_route(PlanResult result) {
  if (result.status == PlanStatus::solved) {
    result.status = PlanStatus::timed_out;
    result.message =
        "the budget was used up before the goal was reached or known to be out of reach";
    result.route = {};
  }
  return result;
}

/// Anytime search by restarts: the weight of the heuristic falls from large to one, and parts of a
/// search that cannot improve on the best route are pruned. `once(settings, request, cost)` is one
/// search for a route that costs less. E. A. Hansen, R. Zhou, Anytime Heuristic Search, JAIR 28,
/// 2007, doi:10.1613/jair.2096; restarts: S. Richter, J. Thayer, W. Ruml, The Joy of Forgetting,
/// ICAPS 2010.
template <class Once>
PlanResult improve(const SearchSettings& settings, const Request& request, const Once& once) {
  std::optional<SearchResult> best;
  Counters spent;
  int searches = 0;
  for (const double inflation : {16.0, 4.0, 2.0, 1.4, 1.0}) {
    SearchSettings inflated = settings;
    request.budget.show_iteration(std::uint64_t(++searches));
    inflated.weight_h *= inflation;
    const bool can_improve = best && best->at_goal;
    SearchResult found =
        once(inflated, after(request, spent), can_improve ? best->cost : kInfinity);
    add(spent, found.result.counters);
    const bool cut_short = found.result.budget_hit || found.result.status == PlanStatus::cancelled;
    // A route that ends within the tolerance counts only once the goal is known to be unreachable:
    // otherwise more budget could give a longer route.
    const bool counts = found.result.status == PlanStatus::solved && (found.at_goal || !cut_short);
    if (counts && (!best || found.cost < best->cost)) {
      best = std::move(found);
      request.budget.show_best(best->cost);
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

/// Ends the route at the goal; `at_goal`: the last cell's centre equals the goal up to rounding.
inline void end_at_goal(Polyline& route, const Vec3& goal, bool at_goal) {
  if (at_goal && route.size() > 1) {
    route.back() = goal;
  } else {
    route.push_back(goal);
  }
}

inline PlanResult solved(Polyline route, const SearchStats& progress, const Lattice& lattice,
                         const MoveRules& rules) {
  PlanResult result;
  result.status = PlanStatus::solved;
  result.route = std::move(route);
  result.message = "a route of " + std::to_string(length(result.route)) + " m, " +
                   std::to_string(progress.expanded) + " cells expanded";
  result.counters = counters(progress, lattice, rules);
  return result;
}

/// State of every search over the cells of a lattice: the problem, its constraints and costs, and
/// the statistics. All constructor arguments must outlive it; routes that cost `best_cost` or more
/// are discarded.
class LatticeSearch {
 protected:
  LatticeSearch(const Request& request, const SearchSettings& settings, const Lattice& lattice,
                double best_cost)
      : request_(request),
        settings_(settings),
        lattice_(lattice),
        rules_(request, lattice, settings.moves, settings.corner),
        costs_(settings.cost, request, lowest(request, lattice)),
        means_(StepMeans::of(request, lattice)),
        to_goal_(request, settings, lattice, request.goal.position, request.goal.tolerance_m,
                 costs_.min_per_metre()),
        watch_(request.budget),
        start_(request.start.position),
        goal_(request.goal.position),
        longest_(request.limits.max_route_length + kLengthTolerance),
        best_cost_(best_cost) {}

  /// Evaluations that differ by less are equal: far below any relevant difference, far above the
  /// rounding of a sum.
  double quantum() const {
    if (request_.objective) {  // in its unit, of which nothing is known
      const double minimum = to_goal_.at_least(start_);
      const double straight = costs_.leg(start_, goal_, 0);
      return minimum > 0                            ? minimum * 1e-12
             : straight > 0 && straight < kInfinity ? straight * 1e-15
                                                    : 1e-100;
    }
    const double of_length = settings_.cost.length > 0 ? std::min(settings_.cost.length, 1.0) : 1;
    return std::max((goal_ - start_).norm(), 1.0) * 1e-12 * of_length *
           std::max(settings_.weight_g, settings_.weight_h);
  }
  /// f = w_g g + w_h h of a cell.
  double evaluation(double g, const Cell& c, const Vec3& at) const {
    return settings_.weight_g * (g + costs_.at(at)) + settings_.weight_h * to_goal_(c);
  }
  /// Of the step in direction d from a, the position of cell c, to b.
  double step_cost(const Cell& c, int d, const Vec3& a, const Vec3& b) {
    if (costs_.length_alone()) {
      return lattice_.step_length(d);
    }
    return priced(means_ ? lattice_.step_length(d) * means_->at(c, d, a, b)
                         : costs_.leg(a, b, lattice_.step_length(d)),
                  b);
  }
  double priced(double cost, const Vec3& to) {
    if (cost == kInfinity) {
      progress_.unpriced = to;
    }
    return cost;
  }
  std::size_t means_bytes() const { return means_ ? means_->bytes() : 0; }
  double link_cost(const Vec3& a, const Vec3& b, double length) {
    return length == 0 ? 0 : priced(costs_.leg(a, b, length), b);
  }
  /// True if every route over the position by a path of that length is too long.
  bool too_long(double length, const Vec3& at) {
    const bool beyond =
        longest_ < kInfinity && length + (goal_ - at).norm() - request_.goal.tolerance_m > longest_;
    progress_.too_long = progress_.too_long || beyond;
    return beyond;
  }
  /// True if no route over the position at that cost improves on the best one known; at an infinite
  /// cost, none does.
  bool exceeds_incumbent(double g, const Vec3& at) const {
    return g == kInfinity || (best_cost_ < kInfinity && g + to_goal_.at_least(at) >= best_cost_);
  }
  /// True if lengths are tracked in addition to costs.
  bool keeps_lengths() const { return longest_ < kInfinity && !costs_.length_alone(); }
  /// True if everything left out as too long is too long on every path.
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

  /// Status of a search that its budget ends.
  PlanStatus ended() const {
    return watch_.cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out;
  }
  SearchResult with(Polyline route, double cost, bool at_goal, bool budget_hit) const {
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
    found.result.message =
        explanation(status, progress_, request_, lattice_, rules_) + rules_.sharp_turns();
    found.result.counters = counters(progress_, lattice_, rules_);
    return found;
  }

  const Request& request_;
  const SearchSettings& settings_;
  const Lattice& lattice_;
  MoveRules rules_;
  RouteCosts costs_;
  std::optional<StepMeans> means_;
  Estimate to_goal_;
  BudgetWatch watch_;
  Vec3 start_;
  Vec3 goal_;
  double longest_;  ///< longest route allowed, metres
  double best_cost_;
  double nearest_ = kInfinity;
  SearchStats progress_;
};
}  // namespace altiplan::kit
