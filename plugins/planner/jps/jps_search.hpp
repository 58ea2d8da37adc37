// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "altiplan/check.hpp"
#include "altiplan/kit/lattice/lattice.hpp"
#include "altiplan/kit/lattice/pruning.hpp"
#include "altiplan/kit/lattice/step_costs.hpp"
#include "altiplan/planner.hpp"
#include "bit_lines.hpp"
#include "search_parts.hpp"

namespace altiplan::jps {

/// One search from request.start to request.goal over the cells of a level.
template <kit::CornerRule kRule>
class Search {
 public:
  /// All arguments must outlive the search.
  Search(const Request& request, const kit::Lattice& lattice, const kit::StepCosts& costs,
         const std::shared_ptr<const VoxelGrid>& grid, std::size_t max_bytes, Memory& memory)
      : request_(request),
        lattice_(lattice),
        costs_(costs),
        grid_(*grid),
        rows_(grid->row_words(0, 0), grid->words_per_row()),
        columns_(memory.columns.of(grid)),
        nodes_(memory.nodes),
        open_(memory.open),
        watch_(request.budget),
        max_bytes_(max_bytes),
        width_(std::uint32_t(lattice.spec().counts[0])),
        goal_node_(std::uint32_t(lattice.size())),
        level_costs_(costs) {}

  /// Empty if a path became longer than the costs allow.
  std::optional<PlanResult> run() {
    begin();
    while (!open_.empty()) {
      const auto [f, index, word] = open_.pop();
      if (index == goal_node_ || index == goal_cell_) {
        return found(index == goal_node_ ? goal_parent_ : index, true);
      }
      if (nodes_[index] != word) {
        continue;  // reached by a shorter path in the meantime
      }
      if (watch_.spent(expanded_, open_.size()) || memory_full()) {
        return ended(watch_.cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out);
      }
      expand(index, word, f);
      if (too_long_) {
        return std::nullopt;
      }
    }
    return ended(PlanStatus::no_route);
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  void begin() {
    nodes_.reset(lattice_.size());
    open_.clear();
    for (const kit::Lattice::Link& link : lattice_.links(request_.goal.position)) {
      const std::uint32_t at = lattice_.index(link.cell);
      goals_.add({at, link.cell[0], link.cell[1], costs_.of(link.length)});
      goal_cell_ = link.length == 0 ? at : kNone;
    }
    for (const kit::Lattice::Link& link : lattice_.links(request_.start.position)) {
      start_is_centre_ = link.length == 0;
      if (!grid_.blocked(link.cell) &&
          (link.length == 0 ||
           leg_ok(std::nullopt, request_.start.position, lattice_.position(link.cell), request_))) {
        reach(link.cell[0], link.cell[1], costs_.of(link.length), kit::kHere);
      }
    }
  }

  std::uint32_t index(int x, int y) const { return std::uint32_t(y) * width_ + std::uint32_t(x); }

  /// Cost of the path to the goal if no cell were blocked.
  std::uint32_t heuristic(int x, int y) const {
    std::uint32_t minimum = kNone;
    for (const GoalCell& goal : goals_) {
      minimum = std::min(minimum, level_costs_.apart(goal.x - x, goal.y - y) + goal.cost);
    }
    return minimum == kNone ? 0 : minimum;
  }

  void reach(int x, int y, std::uint32_t g, int in) {
    too_long_ = too_long_ || g >= NodeWord::kMax;
    const std::uint32_t at = index(x, y);
    const std::uint32_t word = NodeWord::of(g, in);
    if (!too_long_ && NodeWord::nearer(word, nodes_[at])) {
      nodes_.at(at) = word;
      ++generated_;
      open_.push(g + heuristic(x, y), at, word);
    }
  }

  /// Records where a diagonal run turned, only for the route: the run itself finds what is
  /// reachable from there in its directions. Returns true if the run is worth continuing.
  bool turn(int x, int y, std::uint32_t g, int in) {
    too_long_ = too_long_ || g >= NodeWord::kMax;
    const std::uint32_t at = index(x, y);
    const std::uint32_t word = NodeWord::of(g, in);
    const std::uint32_t known = nodes_[at];
    if (too_long_ || NodeWord::nearer(known, word) || known == word) {
      return false;
    }
    if (NodeWord::nearer(word, known)) {
      nodes_.at(at) = word;
    }
    return true;
  }

  void expand(std::uint32_t index, std::uint32_t word, std::uint32_t f) {
    const Cell c = lattice_.cell(index);
    const std::uint32_t g = NodeWord::g(word);
    const int in = NodeWord::in(word);
    ++expanded_;
    if (f - g < nearest_) {
      nearest_ = f - g;
      nearest_cell_ = index;
    }
    if (request_.trace != nullptr) {
      add_to_trace(index, f);
    }
    for (const GoalCell& goal : goals_) {
      if (goal.index == index) {
        try_goal(goal, g);
      }
    }
    const kit::DirectionMask blocked =
        kit::bits_around<true>(grid_, grid_.words().data(), grid_.bit(c));
    const kit::DirectionMask steps = kit::level_successors<kRule>(blocked, in);
    const auto [x, y, z] = c;
    const auto has = [&](int dx, int dy) { return (steps >> kit::direction(dx, dy, 0) & 1) != 0; };
    if (has(1, 0)) {
      run_straight<true, true>(x, y, g);
    }
    if (has(-1, 0)) {
      run_straight<true, false>(x, y, g);
    }
    if (has(0, 1)) {
      run_straight<false, true>(x, y, g);
    }
    if (has(0, -1)) {
      run_straight<false, false>(x, y, g);
    }
    if (has(1, 1)) {
      run_diagonal<true, true>(x, y, g);
    }
    if (has(-1, 1)) {
      run_diagonal<false, true>(x, y, g);
    }
    if (has(1, -1)) {
      run_diagonal<true, false>(x, y, g);
    }
    if (has(-1, -1)) {
      run_diagonal<false, false>(x, y, g);
    }
  }

  template <bool kAlongX, bool kAhead>
  void reach_straight(int x, int y, std::uint32_t g, int n) {
    constexpr int kStep = kAhead ? 1 : -1;
    reach(kAlongX ? x + kStep * n : x, kAlongX ? y : y + kStep * n,
          g + std::uint32_t(n) * (kAlongX ? level_costs_.x : level_costs_.y),
          kAlongX ? kit::direction(kStep, 0, 0) : kit::direction(0, kStep, 0));
  }

  template <bool kAlongX, bool kAhead>
  void run_straight(int x, int y, std::uint32_t g) {
    const int n = goals_.stopped<kAlongX, kAhead>(
        x, y, kAlongX ? scan<kRule, kAhead>(rows_, y, x) : scan<kRule, kAhead>(columns_, x, y));
    if (n > 0) {
      reach_straight<kAlongX, kAhead>(x, y, g, n);
    }
  }

  /// From a cell whose first step is free: reaches what lies straight on from each cell of the
  /// diagonal, in the diagonal's two component directions.
  template <bool kEast, bool kNorth>
  void run_diagonal(int x, int y, std::uint32_t g) {
    constexpr int kX = kEast ? 1 : -1;
    constexpr int kY = kNorth ? 1 : -1;
    constexpr int kIn = kit::direction(kX, kY, 0);
    MovingStrip<kRule, kEast> row(rows_, y, x, kY);
    MovingStrip<kRule, kNorth> column(columns_, x, y, kX);
    do {
      x += kX;
      y += kY;
      g += level_costs_.xy;
      row.step(x);
      column.step(y);
      const bool forced =
          kRule == kit::CornerRule::any && (row.ends_behind() || column.ends_behind());
      if (forced || goals_.holds(x, y)) {
        reach(x, y, g, kIn);
        return;
      }
      const int along_x = goals_.stopped<true, kEast>(x, y, row.scan(y, x));
      const int along_y = goals_.stopped<false, kNorth>(x, y, column.scan(x, y));
      if (along_x > 0 || along_y > 0) {
        if (!turn(x, y, g, kIn)) {
          return;
        }
        if (along_x > 0) {
          reach_straight<true, kEast>(x, y, g, along_x);
        }
        if (along_y > 0) {
          reach_straight<false, kNorth>(x, y, g, along_y);
        }
      }
    } while (!row.blocked_fore() && (kRule == kit::CornerRule::any ||
                                     !(row.blocked_straight() || column.blocked_straight())));
  }

  /// Reaches the goal from a cell linked to it; otherwise that cell, if it is within the tolerance.
  void try_goal(const GoalCell& goal, std::uint32_t g) {
    const Vec3 here = lattice_.position({goal.x, goal.y, 0});
    if (leg_ok(std::nullopt, here, request_.goal.position, request_)) {
      if (g + goal.cost < goal_g_) {
        goal_g_ = g + goal.cost;
        goal_parent_ = goal.index;
        open_.push(goal_g_, goal_node_, 0);
      }
    } else if (g < fallback_g_ && request_.goal.reached_at(here)) {
      fallback_g_ = g;
      fallback_ = goal.index;
    }
  }

  bool memory_full() const {
    return double(lattice_.size()) * Memory::kBytesPerCell + double(open_.bytes()) >
           double(max_bytes_);
  }

  /// The cell where the run that led to a cell began. Empty if that cell has been reached by a
  /// shorter path in the meantime and the other has not, which is then on no shortest path.
  std::optional<std::uint32_t> parent(std::uint32_t index) const {
    const std::uint32_t word = nodes_[index];
    const int in = NodeWord::in(word);
    std::uint32_t g = NodeWord::g(word);
    const auto stride = std::uint32_t(lattice_.stride(in));
    for (int left = steps_back(lattice_.cell(index), kit::offset(in)); left > 0; --left) {
      index -= stride;
      g -= costs_[in];
      if (NodeWord::g(nodes_[index]) == g) {
        return index;
      }
    }
    return std::nullopt;
  }

  /// Maximum number of steps to a cell that stay on the level.
  int steps_back(const Cell& c, const Cell& step) const {
    int maximum = std::numeric_limits<int>::max();
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const int behind = step[axis] > 0 ? c[axis] : lattice_.spec().counts[axis] - 1 - c[axis];
      maximum = step[axis] == 0 ? maximum : std::min(maximum, behind);
    }
    return maximum;
  }

  /// Corners from the start to a cell.
  Polyline route_to(std::uint32_t last) const {
    Polyline route{lattice_.position(lattice_.cell(last))};
    std::uint32_t at = last;
    int in = NodeWord::in(nodes_[at]);
    while (in != kit::kHere) {
      at = parent(at).value();
      const int before = NodeWord::in(nodes_[at]);
      if (before != in) {
        route.push_back(lattice_.position(lattice_.cell(at)));
      }
      in = before;
    }
    if (start_is_centre_) {
      route.pop_back();  // the start itself, except for rounding
    }
    route.push_back(request_.start.position);
    std::reverse(route.begin(), route.end());
    return route;
  }

  static std::string whole(double value) { return std::to_string(std::llround(value)); }

  PlanResult found(std::uint32_t last, bool at_goal) const {
    PlanResult result;
    result.status = PlanStatus::solved;
    result.route = route_to(last);
    if (at_goal) {
      if (last == goal_cell_) {
        result.route.edit().back() =
            request_.goal.position;  // the cell's centre, except for rounding
      } else {
        result.route.push_back(request_.goal.position);
      }
    }
    result.message = "a route of " + whole(length(result.route)) + " m, " +
                     std::to_string(expanded_) + " jump points expanded";
    result.counters = counters();
    return result;
  }

  Counters counters() const {
    return {{"expanded", std::int64_t(expanded_)},
            {"generated", generated_},
            {"lattice_cells", std::int64_t(lattice_.size())}};
  }

  /// The result of a search that did not reach the goal, with the reason.
  PlanResult ended(PlanStatus status) const {
    const bool budget_hit = status != PlanStatus::no_route;
    if (fallback_ != kNone) {
      PlanResult result = found(fallback_, false);
      result.budget_hit = budget_hit;
      return result;
    }
    PlanResult result;
    result.status = status;
    result.budget_hit = budget_hit;
    result.counters = counters();
    result.message = status == PlanStatus::no_route    ? "no route"
                     : status == PlanStatus::cancelled ? "cancelled"
                     : memory_full()                   ? "max_memory_mb or within_mb is used up"
                                                       : "the budget was used up";
    result.message += ": " + std::to_string(expanded_) + " jump points expanded";
    if (expanded_ > 0) {
      const Vec3 at = lattice_.position(lattice_.cell(nearest_cell_));
      result.message += ", the nearest to the goal at " + request_.place_text(at) + ", " +
                        whole((at - request_.goal.position).norm()) + " m from it" +
                        (budget_hit ? "" : "; blocked cells bar every path on");
    } else if (status == PlanStatus::no_route) {
      result.message += ", the start cannot join the lattice";
    }
    // Cells farther from the goal than its links reach were not examined.
    result.proved = status == PlanStatus::no_route &&
                    request_.goal.tolerance_m < lattice_.spec().cell.head<2>().minCoeff();
    return result;
  }

  void add_to_trace(std::uint32_t index, std::uint32_t f) const {
    const bool is_root = NodeWord::in(nodes_[index]) == kit::kHere;
    const std::optional<std::uint32_t> from = is_root ? std::nullopt : parent(index);
    request_.trace->add({TraceEvent::Kind::expanded, std::int64_t(index),
                         from ? std::int64_t(*from) : -1, lattice_.position(lattice_.cell(index)),
                         costs_.metres(f)});
  }

  const Request& request_;
  const kit::Lattice& lattice_;
  const kit::StepCosts& costs_;
  const VoxelGrid& grid_;
  BitLines rows_;
  BitLines columns_;
  kit::ScratchArray<std::uint32_t, 256>& nodes_;
  kit::BucketQueue& open_;
  BudgetWatch watch_;
  std::size_t max_bytes_;
  std::uint32_t width_;
  std::uint32_t goal_node_;
  LevelCosts level_costs_;
  GoalCells goals_;
  bool start_is_centre_ = false;
  std::uint32_t goal_cell_ = kNone;  ///< the cell whose centre is the goal
  std::uint32_t goal_g_ = kNone;
  std::uint32_t goal_parent_ = kNone;
  std::uint32_t fallback_g_ = kNone;
  std::uint32_t fallback_ = kNone;  ///< ends within the tolerance, if the goal has no link
  std::uint64_t expanded_ = 0;
  std::int64_t generated_ = 0;
  std::uint32_t nearest_ = kNone;
  std::uint32_t nearest_cell_ = kNone;
  bool too_long_ = false;
};
}  // namespace altiplan::jps
