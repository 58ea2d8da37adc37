// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "altiplan/kit/lattice/lattice_search.hpp"
#include "altiplan/kit/lattice/open_list.hpp"

namespace altiplan::kit {

/// Common part of searches with real-valued costs, whether a node is a cell or an arrival at one:
/// the connections of start and goal to the lattice.
class GoalSearch : protected LatticeSearch {
 protected:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  static constexpr std::uint32_t kGoal = kNone - 1;  ///< the goal on the open list

  GoalSearch(const Request& request, const SearchSettings& settings, const Lattice& lattice,
             double best_cost, OpenList& open)
      : LatticeSearch(request, settings, lattice, best_cost), open_(open) {}

  /// The approach to a cell reached by the step `in`; nothing at the start without a velocity.
  std::optional<Approach> before(int in, const Vec3& here) const {
    return rules_.approach(in, here, at_start_);
  }

  /// Reaches the goal from a node at cell c if it has a link to the goal; g and length are those of
  /// the path to the node.
  void try_goal(std::uint32_t node, double g, double length, const Cell& c, const Vec3& here,
                const std::optional<Approach>& from) {
    if (const Lattice::Link* link = to_goal_.link_of(c)) {
      if (length + link->length <= longest_ &&
          (link->length == 0 || rules_.any_leg_ok(from, here, goal_))) {
        if (const double at_goal = g + link_cost(here, goal_, link->length); at_goal < goal_g_) {
          goal_g_ = at_goal;
          goal_parent_ = node;
          request_.budget.show_best(std::min(at_goal, best_cost_));
          open_.push(settings_.weight_g * (at_goal + costs_.at(goal_)), at_goal, kGoal);
        }
        return;
      }
    }
    if (g < fallback_g_ && length <= longest_ && request_.goal.reached_at(here)) {
      fallback_g_ = g;
      fallback_ = node;
    }
  }

  /// The route along the path that ends with the link number `last` of a chain, whose links have a
  /// `from`, the link before or kNone, and a `cell`, of which cell_of gives the coordinates.
  template <class Chain, class CellOf>
  Polyline route_along(const Chain& chain, std::uint32_t last, bool at_goal,
                       const CellOf& cell_of) const {
    Polyline route;
    for (std::uint32_t index = last; index != kNone; index = chain[index].from) {
      route.push_back(lattice_.position(cell_of(chain[index].cell)));
    }
    if (at_start_) {
      route.pop_back();
    }
    route.push_back(start_);
    std::reverse(route.begin(), route.end());
    if (at_goal) {
      end_at_goal(route, goal_, to_goal_.link_of(cell_of(chain[last].cell))->length == 0);
    }
    return route;
  }

  OpenList& open_;
  bool at_start_ = false;  ///< the start is the centre of its cell
  double goal_g_ = kInfinity;
  std::uint32_t goal_parent_ = kNone;
  double fallback_g_ = kInfinity;
  std::uint32_t fallback_ = kNone;  ///< a node within the tolerance, where the goal has no link
};
}  // namespace altiplan::kit
