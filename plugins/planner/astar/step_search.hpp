// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/kit/lattice/bucket_queue.hpp"
#include "altiplan/kit/lattice/lattice_search.hpp"
#include "altiplan/kit/lattice/tiles.hpp"
#include "goal_flood.hpp"
#include "natural_steps.hpp"

namespace altiplan::astar {

struct StepMemory {
  kit::TiledArray<std::uint32_t> complement;  ///< ~g by cell: 0 if the cell was not reached
  kit::TiledArray<std::uint8_t> in;           ///< the step into it, and kClosed
  kit::TiledArray<std::uint8_t> seen;         ///< by the flood from the goal
  kit::BucketQueue open;
};

/// The search for when costs are lengths, the heuristic is consistent and no constraint depends on
/// two legs but limits on turns: whether a step is free depends on its place alone. Lengths are
/// integers, memory is taken for the tiles of cells that are reached, and a flood from the goal,
/// which takes a quarter of the cells that the search takes, proves early that a goal is shut in.
///
/// Where all steps around a cell are free and turns are not limited, successors that the cell
/// before reaches as cheaply on another path are pruned (natural_steps.hpp).
class StepSearch {
 public:
  /// `costs` are those of the lattice. All arguments must outlive the search.
  StepSearch(const Request& request, const kit::SearchSettings& settings,
             const kit::Lattice& lattice, const kit::TileIndex& tiles, const kit::StepCosts& costs,
             StepMemory& memory)
      : request_(request),
        settings_(settings),
        lattice_(lattice),
        tiles_(tiles),
        costs_(costs),
        rules_(request, lattice, settings.moves, settings.corner),
        natural_(rules_.steps(), costs),
        complement_(memory.complement),
        in_(memory.in),
        open_(memory.open),
        flood_(tiles, rules_, memory.seen),
        watch_(request.budget),
        start_(request.start.position),
        goal_(request.goal.position),
        has_turns_(request.limits.turns()),
        prunes_(!has_turns_),
        weight_g_(settings.weight_g / std::max(settings.weight_g, settings.weight_h)),
        weight_h_(settings.weight_h / std::max(settings.weight_g, settings.weight_h)),
        may_widen_(settings.state == kit::SearchState::automatic) {
    complement_.reset(tiles.tiles());
    in_.reset(tiles.tiles());
    memory.seen.reset(tiles.tiles());
    open_.clear();
  }

  /// Empty if a path is too long for costs as fine as these.
  std::optional<kit::SearchResult> run() {
    begin();
    PlanStatus status = PlanStatus::no_route;
    while (!open_.empty() || widen()) {
      const kit::BucketQueue::Entry entry = open_.pop();
      if (entry.key > enough_) {
        widen();
      }
      if (entry.node == kGoal) {
        return with(goal_parent_, true, false);
      }
      std::uint8_t& in = in_.at(entry.node);
      if ((in & kClosed) != 0) {
        continue;
      }
      if (watch_.spent(progress_.expanded, open_.size()) || bytes() > settings_.max_bytes) {
        status = watch_.cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out;
        progress_.memory_full = bytes() > settings_.max_bytes;
        break;
      }
      in |= kClosed;
      const std::uint32_t g = ~complement_[entry.node];
      if (g > kit::StepCosts::kMax) {
        return std::nullopt;
      }
      expand(entry.node, g, in & kStep);
      if (progress_.expanded % kBetweenFloods == 0 && is_shut_in()) {
        break;
      }
    }
    if (fallback_) {
      return with(*fallback_, false, status != PlanStatus::no_route);
    }
    return without(status);
  }

 private:
  static constexpr std::uint8_t kClosed = 0x80;
  static constexpr std::uint8_t kStep = 0x7f;
  static constexpr std::uint32_t kGoal = ~std::uint32_t{0};
  static constexpr std::uint32_t kUnreached = ~std::uint32_t{0};
  static constexpr int kFurthestLink = 3;  ///< edges between the goal and a cell of a wide link
  static constexpr std::uint32_t kBetweenFloods = 4096;  ///< expansions
  static constexpr int kFlooded = 1024;                  ///< cells between them

  /// A cell from which the goal is one leg away.
  struct GoalLink {
    Cell cell;
    std::uint32_t number;
    std::uint32_t cost;
  };
  GoalLink goal_link(const kit::Lattice::Link& link) const {
    return {link.cell, tiles_.number(link.cell), costs_.of_link(link.length)};
  }

  void begin() {
    for (const kit::Lattice::Link& link : lattice_.links(goal_)) {
      goal_links_.push_back(goal_link(link));
    }
    begin_flood();
    for (const kit::Lattice::Link& link : lattice_.links(start_)) {
      const Vec3 there = lattice_.position(link.cell);
      if (!rules_.cell_blocked(link.cell) &&
          (link.length == 0 || rules_.any_leg_ok(request_.before_start(), start_, there))) {
        at_start_ = at_start_ || link.length == 0;
        reach(tiles_.number(link.cell), link.cell, costs_.of_link(link.length), kit::kHere);
      }
    }
  }

  /// The flood begins at all cells where a route may end, unless a tolerance makes them many.
  void begin_flood() {
    constexpr double kMany = 1e5;
    const Vec3 reach = Vec3::Constant(request_.goal.tolerance_m);
    const Vec3 across = (2 * reach).cwiseQuotient(lattice_.spec().cell) + Vec3::Ones();
    may_flood_ = across.prod() < kMany;
    if (!may_flood_) {
      return;
    }
    for (const GoalLink& link : goal_links_) {
      if (!rules_.cell_blocked(link.cell) &&
          (link.cost == 0 || leg_ok(std::nullopt, lattice_.position(link.cell), goal_, request_))) {
        flood_.begin_at(link.cell);
      }
    }
    const Cell low = lattice_.nearest(goal_ - reach).cell;
    const Cell high = lattice_.nearest(goal_ + reach).cell;
    for (int z = low[2]; z <= high[2]; ++z) {
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int x = low[0]; x <= high[0]; ++x) {
          if (request_.goal.reached_at(lattice_.position({x, y, z}))) {
            flood_.begin_at({x, y, z});
          }
        }
      }
    }
  }

  std::uint32_t heuristic(const Cell& c) const {
    if (settings_.heuristic == kit::Heuristic::octile && !goal_links_.empty()) {
      std::uint32_t minimum = ~std::uint32_t{0};
      for (const GoalLink& link : goal_links_) {
        minimum = std::min(minimum, costs_.between(c, link.cell) + link.cost);
      }
      return minimum;
    }
    return other_heuristic(c);
  }
  [[gnu::noinline]] std::uint32_t other_heuristic(const Cell& c) const {
    const Vec3 way = lattice_.position(c) - goal_;
    switch (settings_.heuristic) {
      case kit::Heuristic::zero:
        return 0;
      case kit::Heuristic::euclidean:
        return costs_.at_most(way.norm());
      case kit::Heuristic::manhattan:  // never consistent
      case kit::Heuristic::octile:     // only the goal's tolerance is on the lattice
        break;
    }
    return costs_.at_most(std::max(0.0, way.norm() - request_.goal.tolerance_m));
  }

  std::uint32_t evaluation(std::uint32_t g, std::uint32_t h) const {
    return weight_g_ == weight_h_ ? g + h : std::uint32_t(weight_g_ * g + weight_h_ * h);
  }

  void reach(std::uint32_t number, const Cell& c, std::uint32_t g, int step) {
    complement_.at(number) = ~g;
    in_.at(number) = std::uint8_t(step);
    ++progress_.generated;
    open_.push(evaluation(g, heuristic(c)), number, 0);
  }

  void expand(std::uint32_t number, std::uint32_t g_here, int step) {
    const Cell c = tiles_.cell(number);
    const Vec3 here = lattice_.position(c);
    ++progress_.expanded;
    note_place(number, g_here, here);
    if (request_.trace != nullptr) {
      add_to_trace(g_here, step, c, here);
    }
    try_goal(number, g_here, step, here);
    // A first step after a heading, or after a link, forms no pair of steps: it is checked as a
    // whole.
    const bool is_first = has_turns_ || step == kit::kHere ? rules_.is_first(step) : false;
    const std::optional<Approach> from =
        is_first ? rules_.approach(step, here, at_start_) : std::nullopt;
    const bool is_open = rules_.grid() == nullptr && rules_.all_free_around(c);
    const kit::NumbersAround number_of(tiles_, c);
    kit::DirectionMask better = 0;
    for (kit::DirectionMask left = is_open && prunes_ ? natural_[step] & lattice_.inside(c)
                                                      : rules_.candidates(c, step);
         left != 0; left &= left - 1) {
      const int d = std::countr_zero(left);
      // ~g is compared: a cell that was not reached has 0. No closed one is reached at less.
      better |= kit::DirectionMask(~(g_here + costs_[d]) > complement_[number_of(d)]) << d;
    }
    if (!is_open && better != 0) {
      better = rules_.places_free(c, better);
    }
    for (; better != 0; better &= better - 1) {
      const int d = std::countr_zero(better);
      const Cell o = kit::offset(d);
      const Cell to = {c[0] + o[0], c[1] + o[1], c[2] + o[2]};
      if (from && !rules_.any_leg_ok(from, here, lattice_.position(to))) {
        continue;
      }
      reach(number_of(d), to, g_here + costs_[d], rules_.step_after(step, d));
    }
  }

  void note_place(std::uint32_t number, std::uint32_t g, const Vec3& here) {
    const double distance = (here - goal_).squaredNorm();
    if (distance < nearest_) {
      nearest_ = distance;
      progress_.nearest = here;
    }
    if (request_.goal.tolerance_m > 0 && g < fallback_g_ && request_.goal.reached_at(here)) {
      fallback_g_ = g;
      fallback_ = number;
    }
  }

  void try_goal(std::uint32_t number, std::uint32_t g, int step, const Vec3& here) {
    for (const GoalLink& link : is_wide_ ? wide_links_ : goal_links_) {
      if (link.number == number) {
        try_link(link, g, step, here);
      }
    }
  }

  void try_link(const GoalLink& link, std::uint32_t g, int step, const Vec3& here) {
    if (g + link.cost >= goal_g_) {
      return;
    }
    if (link.cost == 0 || rules_.any_leg_ok(rules_.approach(step, here, at_start_), here, goal_)) {
      goal_g_ = g + link.cost;
      goal_parent_ = link.number;
      open_.push(evaluation(goal_g_, 0), kGoal, 0);
    } else if (may_widen_ && !is_wide_ && leg_ok(std::nullopt, here, goal_, request_)) {
      enough_ = std::min(enough_, evaluation(g + link.cost + costs_[kit::direction(1, 1, 0)], 0));
    }
  }

  /// Where turns refused legs to the goal, each from the one parent of its cell, until all that is
  /// open costs a step more: tries those from cells further away, now where they are closed, else
  /// as they are expanded. True if one reaches the goal now.
  bool widen() {
    if (enough_ == kUnreached || goal_g_ != kUnreached) {
      return false;
    }
    enough_ = kUnreached;
    is_wide_ = true;
    for (const kit::Lattice::Link& away : lattice_.links(goal_, kFurthestLink)) {
      const GoalLink& link = wide_links_.emplace_back(goal_link(away));
      if (const int in = in_[link.number]; (in & kClosed) != 0) {
        try_link(link, ~complement_[link.number], in & kStep, lattice_.position(link.cell));
      }
    }
    return goal_g_ != kUnreached;
  }

  /// Lets the flood go on; true if it proves that the goal cannot be reached.
  bool is_shut_in() {
    if (!may_flood_) {
      return false;
    }
    flood_.go_on(kFlooded, [&](std::uint32_t number) { return complement_[number] != 0; });
    return flood_.is_shut_in();
  }

  std::size_t bytes() const {
    return complement_.bytes() + in_.bytes() + open_.bytes() + flood_.bytes() + rules_.bytes();
  }

  kit::SearchResult with(std::uint32_t last, bool at_goal, bool budget_hit) const {
    Polyline route;
    std::uint32_t number = last;
    Cell c = tiles_.cell(number);
    for (int step = in_[number] & kStep; step != kit::kHere; step = in_[number] & kStep) {
      route.push_back(lattice_.position(c));
      const Cell o = kit::offset(kit::direction_of(step));
      c = {c[0] - o[0], c[1] - o[1], c[2] - o[2]};
      number = tiles_.number(c);
    }
    if (complement_[number] != ~std::uint32_t{0}) {  // linked to the start by a leg
      route.push_back(lattice_.position(c));
    }
    route.push_back(start_);
    std::reverse(route.begin(), route.end());
    if (at_goal) {
      kit::end_at_goal(route, goal_, ~complement_[last] == goal_g_);
    }
    kit::SearchResult found;
    found.cost = length(route);
    found.at_goal = at_goal;
    found.result = kit::solved(std::move(route), progress_, lattice_, rules_);
    found.result.budget_hit = budget_hit;
    return found;
  }

  kit::SearchResult without(PlanStatus status) const {
    kit::SearchResult found;
    const bool is_shut_in = may_flood_ && flood_.is_shut_in();
    found.parent_mattered = rules_.parent_mattered() && !is_shut_in;
    PlanResult& result = found.result;
    result.status = status;
    result.budget_hit = status != PlanStatus::no_route;
    result.proved = status == PlanStatus::no_route && !found.parent_mattered;
    result.message = status == PlanStatus::no_route && is_shut_in
                         ? shut_in()
                         : kit::explanation(status, progress_, request_, lattice_, rules_) +
                               rules_.sharp_turns();
    result.counters = kit::counters(progress_, lattice_, rules_);
    return found;
  }

  /// What shuts the goal in: it alone is the cause, whatever the search was refused before. Of many
  /// cells only a sample is looked at, as the budget may be used up.
  std::string shut_in() const {
    constexpr std::size_t kLooks = 100'000;
    kit::MoveRules around(request_, lattice_, settings_.moves, settings_.corner);
    flood_.for_each(1 + flood_.cells() / kLooks,
                    [&](const Cell& c) { around.places_free(c, around.out_of(c)); });
    return "no route: the goal is shut in: it can be reached from " +
           std::to_string(flood_.cells()) + " of " + std::to_string(lattice_.size()) +
           " cells alone, around which are refused " + around.refusals() + "; " +
           std::to_string(progress_.expanded) + " expanded";
  }

  void add_to_trace(std::uint32_t g, int step, const Cell& c, const Vec3& here) const {
    const Cell o = kit::offset(kit::direction_of(step));
    const std::int64_t parent =
        step == kit::kHere ? -1
                           : std::int64_t(lattice_.index({c[0] - o[0], c[1] - o[1], c[2] - o[2]}));
    request_.trace->add(
        {TraceEvent::Kind::expanded, std::int64_t(lattice_.index(c)), parent, here,
         settings_.weight_g * costs_.metres(g) + settings_.weight_h * costs_.metres(heuristic(c))});
  }

  const Request& request_;
  const kit::SearchSettings& settings_;
  const kit::Lattice& lattice_;
  const kit::TileIndex& tiles_;
  const kit::StepCosts& costs_;
  kit::MoveRules rules_;
  NaturalSteps natural_;
  kit::TiledArray<std::uint32_t>& complement_;
  kit::TiledArray<std::uint8_t>& in_;
  kit::BucketQueue& open_;
  GoalFlood flood_;
  BudgetWatch watch_;
  Vec3 start_;
  Vec3 goal_;
  bool has_turns_;
  bool prunes_;
  bool may_flood_ = false;
  double weight_g_;
  double weight_h_;
  bool at_start_ = false;  ///< the start is the centre of its cell
  std::vector<GoalLink> goal_links_;
  std::vector<GoalLink> wide_links_;
  bool may_widen_;
  bool is_wide_ = false;
  std::uint32_t goal_g_ = kUnreached;
  std::uint32_t enough_ = kUnreached;  ///< f up to which legs refused for a turn are waited for
  std::uint32_t goal_parent_ = 0;
  std::optional<std::uint32_t> fallback_;  ///< a cell within the tolerance, where the goal is not
                                           ///< reached
  std::uint32_t fallback_g_ = ~std::uint32_t{0};
  double nearest_ = kInfinity;
  kit::SearchStats progress_;
};
}  // namespace altiplan::astar
