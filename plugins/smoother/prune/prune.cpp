// SPDX-License-Identifier: Apache-2.0
// Thinning of a route, checked by the judge.
//
// Citation: paper 002 (fusion of constrained A*, smoothing and potential field), its removal of
//   redundant points; here the fewest of them, by A* (see planner astar) over pairs of waypoints.
// Guarantees: the smallest subset of the route's waypoints that keeps the ends and satisfies every
//   constraint; among those, the shortest. No measure of the
//   route grows; under an objective each leg costs no more than those that it replaces.
// Complexity: O(n^2) leg checks, O(n^3) turn checks in the worst case, for n waypoints.
// Deviations: legs are checked exactly (the paper checks cells); turns are part of the search.
// Symbols: a state (i, j) is the leg between waypoints i and j; legs and metres are compared in
//   that order.
#include <algorithm>
#include <compare>
#include <map>
#include <numeric>
#include <queue>

#include "altiplan/check.hpp"
#include "altiplan/kit/lattice/move_rules.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/smoother.hpp"

namespace {

using namespace altiplan;

/// Legs and metres, compared in that order.
struct Cost {
  int legs = 0;
  double metres = 0;
  friend bool operator<(const Cost& a, const Cost& b) {
    return a.legs != b.legs ? a.legs < b.legs : a.metres < b.metres;
  }
};

/// Searches the fewest waypoints of one route.
class Pruning {
 public:
  Pruning(const Polyline& route, const Request& request)
      : route_(route),
        request_(request),
        watch_(request.budget),
        count_(route.size()),
        visible_(count_ * count_, Visible::unknown) {
    for (std::size_t j = 0; request.objective && j + 1 < count_; ++j) {
      leg_cost_.push_back(cost_of(Leg::straight(route[j], route[j + 1]), request));
    }
  }

  /// The indices of the waypoints to keep; empty if the budget was used up or nothing was found.
  std::vector<std::size_t> fewest() {
    find_legs_to_go();
    struct Entry {
      Cost estimate;
      Cost cost;
      State state;
    };
    const auto later = [](const Entry& a, const Entry& b) {
      if (a.estimate < b.estimate || b.estimate < a.estimate) {
        return b.estimate < a.estimate;
      }
      return b.state < a.state;
    };
    std::priority_queue<Entry, std::vector<Entry>, decltype(later)> open(later);
    std::map<State, std::pair<Cost, State>> best;  // cost, and the preceding state
    const std::size_t last = count_ - 1;
    const auto reach = [&](const State& from, std::size_t k, const Cost& cost) {
      const State state = after(from, k);
      const Cost total = {cost.legs + 1, cost.metres + distance(from.to, k)};
      const auto [known, fresh] = best.try_emplace(state, total, from);
      if (fresh || total < known->second.first) {
        known->second = {total, from};
        open.push({{total.legs + legs_to_go_[k], total.metres + distance(k, last)}, total, state});
      }
    };
    reach_from(State{}, Cost{}, reach);
    while (!open.empty() && !budget_hit_) {
      const Entry entry = open.top();
      open.pop();
      const State state = entry.state;
      if (best.at(state).first < entry.cost) {
        continue;
      }
      if (state.to == last) {
        std::vector<std::size_t> kept = {last};
        for (State at = state; at != State{}; at = best.at(at).second) {
          kept.push_back(at.from);
        }
        std::reverse(kept.begin(), kept.end());
        return kept;
      }
      ++expanded_;
      reach_from(state, entry.cost, reach);
    }
    return {};
  }

  std::int64_t expanded() const { return expanded_; }
  std::int64_t legs_checked() const { return std::int64_t(legs_checked_); }
  bool budget_hit() const { return budget_hit_; }

 private:
  /// The last leg, by its waypoints; if it has no heading, also the last leg that has one (both 0:
  /// there is none).
  struct State {
    std::size_t from = 0, to = 0;
    std::size_t heading_from = 0, heading_to = 0;
    auto operator<=>(const State&) const = default;
  };
  enum class Visible : char { unknown, yes, no };

  /// True if the leg j–k is valid by itself.
  bool visible(std::size_t j, std::size_t k) {
    Visible& known = visible_[j * count_ + k];
    if (known == Visible::unknown) {
      budget_hit_ = budget_hit_ || watch_.spent(legs_checked_);
      if (budget_hit_) {
        return false;
      }
      ++legs_checked_;
      known = leg_ok(std::nullopt, route_[j], route_[k], request_) && costs_no_more(j, k)
                  ? Visible::yes
                  : Visible::no;
    }
    return known == Visible::yes;
  }

  /// True if the leg j–k costs no more, under the objective, than the legs that it replaces.
  bool costs_no_more(std::size_t j, std::size_t k) const {
    if (!request_.objective || k == j + 1) {
      return true;
    }
    const double replaced = std::accumulate(leg_cost_.begin() + std::ptrdiff_t(j),
                                            leg_cost_.begin() + std::ptrdiff_t(k), 0.0);
    return !costs_more(cost_of(Leg::straight(route_[j], route_[k]), request_), replaced);
  }

  /// Number of legs from each waypoint to the last if turns were free: a lower bound.
  void find_legs_to_go() {
    const int none = int(count_) + 1;
    legs_to_go_.assign(count_, none);
    legs_to_go_.back() = 0;
    std::vector<std::size_t> layer = {count_ - 1};
    for (int legs = 1; !layer.empty(); ++legs) {
      std::vector<std::size_t> next;
      for (std::size_t j = 0; j + 1 < count_; ++j) {
        if (legs_to_go_[j] == none && std::any_of(layer.begin(), layer.end(), [&](std::size_t k) {
              return j < k && visible(j, k);
            })) {
          next.push_back(j);
        }
      }
      for (const std::size_t j : next) {
        legs_to_go_[j] = legs;
      }
      layer = std::move(next);
    }
  }

  template <class Reach>
  void reach_from(const State& state, const Cost& cost, const Reach& reach) {
    const std::size_t j = state.to;
    const std::optional<Approach> before =
        cost.legs == 0 ? request_.before_start() : std::optional(approach_by(state));
    for (std::size_t k = j + 1; k < count_; ++k) {
      if (legs_to_go_[k] <= int(count_) && follows(before, j, k) && visible(j, k)) {
        reach(state, k, cost);
      }
    }
  }

  State after(const State& state, std::size_t k) const {
    if (has_heading(route_[k] - route_[state.to]) || !request_.headings_last()) {
      return {state.to, k};
    }
    return has_heading(route_[state.to] - route_[state.from])
               ? State{state.to, k, state.from, state.to}
               : State{state.to, k, state.heading_from, state.heading_to};
  }

  Approach approach_by(const State& state) const {
    if (state.heading_to > 0) {
      return {route_[state.from], route_[state.heading_to] - route_[state.heading_from]};
    }
    return onward(request_.before_start(), route_[state.from]);
  }

  /// Checks the constraints on the leg j–k that depend on the preceding point.
  bool follows(const std::optional<Approach>& before, std::size_t j, std::size_t k) const {
    if (!before) {
      return true;
    }
    return turn_ok(*before, route_[j], route_[k], request_) &&
           std::all_of(
               request_.constraints.begin(), request_.constraints.end(),
               [&](const NamedConstraint& named) {
                 return named.admits({before->from, route_[j], route_[k], request_.world.get()});
               }) &&
           body_ok(before, Leg::straight(route_[j], route_[k]), request_);
  }

  double distance(std::size_t j, std::size_t k) const { return (route_[k] - route_[j]).norm(); }

  const Polyline& route_;
  const Request& request_;
  BudgetWatch watch_;
  std::size_t count_;
  std::vector<Visible> visible_;
  std::vector<double> leg_cost_;  ///< of the route's own legs; empty without an objective
  std::vector<int> legs_to_go_;
  std::int64_t expanded_ = 0;
  std::uint64_t legs_checked_ = 0;
  bool budget_hit_ = false;
};

class Prune final : public Smoother {
 public:
  explicit Prune(const NoParams&) {}

 private:
  PlanResult do_smooth(const Polyline& route, const Request& request) const override {
    PlanResult result;
    result.status = PlanStatus::solved;
    result.route = route;
    const Polyline clean = without_repeats(route);
    Pruning pruning(clean, request);
    const std::vector<std::size_t> kept = pruning.fewest();
    result.budget_hit = pruning.budget_hit();
    Polyline thinned;
    for (const std::size_t index : kept) {
      thinned.push_back(clean[index]);
    }
    // Constraints on whole routes are checked last.
    if (!thinned.empty() &&
        check(thinned, request).violations.size() <= check(route, request).violations.size()) {
      result.route = std::move(thinned);
    }
    result.message = std::to_string(result.route.size()) + " of " + std::to_string(route.size()) +
                     " waypoints kept";
    if (result.route.size() == route.size()) {
      result.message += result.budget_hit ? " (the budget was used up)" : "";
    }
    result.counters = {{"expanded", pruning.expanded()},
                       {"legs_checked", pruning.legs_checked()},
                       {"removed", std::int64_t(route.size() - result.route.size())}};
    return result;
  }
};
}  // namespace

ALTIPLAN_PLUGIN(Smoother, "prune", Prune, NoParams,
                "the fewest waypoints of the route that satisfy every constraint")
