// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "altiplan/kit/lattice/bucket_queue.hpp"
#include "altiplan/kit/lattice/cell_estimate.hpp"
#include "altiplan/kit/lattice/lattice_search.hpp"
#include "altiplan/kit/lattice/pruning.hpp"
#include "altiplan/kit/lattice/straight_runs.hpp"
#include "altiplan/kit/scratch.hpp"

namespace altiplan::kit {

struct CellMemory {
  ScratchArray<std::uint32_t> complement;  ///< ~g by cell: 0 if the cell was not reached
  ScratchArray<std::uint64_t> closed;      ///< one bit per cell, laid out like the occupancy
  BucketQueue open;

  /// Without the open list, rounded up.
  static constexpr std::size_t kBytesPerCell = 5;
};

/// A* for when the cells that a step passes through, and its direction, decide alone if it is free
/// (MoveRules::cells_decide). A cell then needs only 4 bytes and two bits: g is an integer, parents
/// are recovered from it, and bits store which cells are blocked and closed.
///
/// A successor that the preceding cell reaches as cheaply on another path is pruned
/// (kit/pruning.hpp). Most successors would otherwise be reached from many sides first, each time
/// slightly more cheaply. In space, a straight run where nothing else can be reached is one step
/// (kit/straight_runs.hpp).
class CellSearch {
 public:
  /// `costs` are those of the lattice. All arguments must outlive the search.
  CellSearch(const Request& request, const SearchSettings& settings, const Lattice& lattice,
             const StepCosts& costs, CellMemory& memory)
      : request_(request),
        settings_(settings),
        lattice_(lattice),
        costs_(costs),
        rules_(request, lattice, MoveCheck::cells, settings.corner),
        grid_(*rules_.grid()),
        complement_(memory.complement),
        closed_(memory.closed),
        open_(memory.open),
        watch_(request.budget),
        max_open_bytes_(settings.max_bytes - lattice.size() * CellMemory::kBytesPerCell),
        tracing_(request.trace != nullptr),
        consistent_(settings.consistent()),
        level_(lattice.spec().counts[2] == 1),
        level_successors_(LevelSuccessors::of(settings.corner)),
        space_successors_(SpaceSuccessors::of(settings.corner)),
        steps_(rules_.steps() & (level_ ? kLevelDirections : ~DirectionMask{0})),
        prune_(consistent_ && settings.neighbours == Neighbourhood::all &&
               rules_.steps() == lattice.steps()),
        by_runs_(prune_ && settings.runs),
        runs_(grid_),
        is_sum_(settings.weight_g == settings.weight_h),
        weight_g_(settings.weight_g / std::max(settings.weight_g, settings.weight_h)),
        weight_h_(settings.weight_h / std::max(settings.weight_g, settings.weight_h)),
        goal_node_(std::uint32_t(lattice.size())),
        goal_(request.goal.position),
        to_goal_(lattice, costs, settings.heuristic, request.goal) {
    for (int d = 0; d < kDirections; ++d) {
      const Cell o = offset(d);
      moves_[std::size_t(d)] = {std::uint32_t(lattice.stride(d)), costs[d], o[0], o[1], o[2]};
    }
  }

  /// Empty if a path is too long for costs as fine as these.
  std::optional<PlanResult> run() { return level_ ? search<true>() : search<false>(); }

 private:
  struct Move {
    std::uint32_t stride;  ///< index difference, modulo 2^32
    std::uint32_t cost;
    int x, y, z;
  };
  std::uint32_t g(std::uint32_t index) const { return ~complement_[index]; }
  /// Position of a cell's bit; in 2-D the border level below it is omitted.
  std::size_t closed_bit(std::size_t bit) const { return level_ ? bit - grid_.level_bits() : bit; }
  bool is_closed(std::size_t bit) const {
    const std::size_t at = closed_bit(bit);
    return (closed_[at / 64] >> at % 64 & 1) != 0;
  }
  void begin() {
    complement_.reset(lattice_.size());
    closed_.reset(level_ ? grid_.level_bits() / 64 + 1 : grid_.words().size());
    open_.clear();
    for (const CellEstimate::Link& link : to_goal_.links()) {
      first_link_ = std::min(first_link_, link.index);
      last_link_ = std::max(last_link_, link.index);
      runs_.end_at(link.cell);
    }
    if (const double reach = request_.goal.tolerance_m; reach > 0) {
      runs_.end_at(lattice_.nearest(goal_ - Vec3::Constant(reach)).cell);
      runs_.end_at(lattice_.nearest(goal_ + Vec3::Constant(reach)).cell);
    }
    const Vec3& start = request_.start.position;
    for (const Lattice::Link& link : lattice_.links(start)) {
      if (!rules_.cell_blocked(link.cell) &&
          (link.length == 0 ||
           rules_.any_leg_ok(request_.before_start(), start, lattice_.position(link.cell)))) {
        const auto [x, y, z] = link.cell;
        reach(lattice_.index(link.cell), costs_.of_link(link.length), to_goal_.at<false>(x, y, z),
              kHere);
      }
    }
  }

  std::uint32_t evaluation(std::uint32_t g, std::uint32_t h) const {
    return is_sum_ ? g + h : std::uint32_t(weight_g_ * g + weight_h_ * h);
  }

  void reach(std::uint32_t index, std::uint32_t g, std::uint32_t h, int direction) {
    complement_.at(index) = ~g;
    ++progress_.generated;
    open_.push(evaluation(g, h), index, std::uint32_t(direction));
  }

  template <bool kLevel>
  std::optional<PlanResult> search() {
    begin();
    PlanResult result;
    result.status = PlanStatus::no_route;
    while (!open_.empty()) {
      const BucketQueue::Entry entry = open_.pop();
      if (entry.node == goal_node_) {
        return found(goal_parent_, true);
      }
      const auto [x, y, z] = lattice_.cell(entry.node);
      const std::size_t bit = grid_.bit(x, y, kLevel ? 0 : z);
      const std::size_t closed_at = kLevel ? bit - grid_.level_bits() : bit;
      const std::uint64_t closed_mask = std::uint64_t{1} << closed_at % 64;
      if ((closed_[closed_at / 64] & closed_mask) != 0) {
        continue;
      }
      if (watch_.spent(progress_.expanded, open_.size()) || memory_full()) {
        result.budget_hit = true;
        result.status = watch_.cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out;
        break;
      }
      closed_.at(closed_at / 64) |= closed_mask;
      ++progress_.expanded;
      const std::uint32_t g_here = g(entry.node);
      if (g_here > StepCosts::kMax) {
        return std::nullopt;
      }
      if (tracing_) {
        add_to_trace(entry.node);
      }
      if (entry.node - first_link_ <= last_link_ - first_link_) {
        try_goal(entry.node);
      }
      const DirectionMask open = successors<kLevel>(bit, entry.from);
      // Among equals the last one is taken first: the step along most axes, as in kNatural.
      for (int axes = 1; axes <= (kLevel ? 2 : 3); ++axes) {
        for (DirectionMask rest = open & kAlongAxes[axes - 1]; rest != 0; rest &= rest - 1) {
          go<kLevel>(entry.node, {x, y, z}, bit, std::countr_zero(rest), g_here);
        }
      }
    }
    return without_goal(std::move(result));
  }

  /// Reaches the next cell in a direction.
  template <bool kLevel>
  void go(std::uint32_t index, const Cell& c, std::size_t bit, int d, std::uint32_t g_here) {
    const Move& move = moves_[std::size_t(d)];
    if (~(g_here + move.cost) <= complement_[index + move.stride]) {
      return;  // was reached, at no greater cost
    }
    int steps = 1;
    if (!kLevel && by_runs_ && (kAlongAxes[0] >> d & 1) != 0) {
      steps = runs_.steps(c, bit, d);
      complement_.at(index + move.stride) = ~(g_here + move.cost);  // the run is taken only once
    }
    const std::uint32_t next = index + std::uint32_t(steps) * move.stride;
    const std::uint32_t g_next = g_here + std::uint32_t(steps) * move.cost;
    if (steps == 1 || (steps > 1 && ~g_next > complement_[next])) {
      reach(
          next, g_next,
          to_goal_.at<kLevel>(c[0] + steps * move.x, c[1] + steps * move.y, c[2] + steps * move.z),
          d);
    }
  }

  /// Directions to examine from a cell that was reached by the step `from`.
  template <bool kLevel>
  DirectionMask successors(std::size_t bit, std::uint32_t from) const {
    const DirectionMask blocked = bits_around<kLevel>(grid_, grid_.words().data(), bit);
    if (prune_ && kLevel) {
      return level_successors_(blocked, int(from));
    }
    if (prune_ && blocked == 0) {
      return kNatural[from];
    }
    const DirectionMask free = steps_ & free_steps(blocked, settings_.corner);
    // In 2-D it is as fast to find that a closed cell was reached at less cost.
    if (kLevel && consistent_) {
      return free;
    }
    const DirectionMask open = free & ~bits_around<kLevel>(grid_, closed_.data(), closed_bit(bit));
    return prune_ ? space_successors_(open, blocked, int(from)) : open;
  }

  void try_goal(std::uint32_t index) {
    for (const CellEstimate::Link& link : to_goal_.links()) {
      const std::uint32_t at_goal = g(index) + link.cost;
      if (link.index == index && at_goal < goal_g_ &&
          (link.cost == 0 ||
           rules_.any_leg_ok(std::nullopt, lattice_.position(link.cell), goal_))) {
        goal_g_ = at_goal;
        goal_parent_ = index;
        open_.push(evaluation(at_goal, 0), goal_node_, kHere);
      }
    }
  }

  bool memory_full() const { return open_.bytes() > max_open_bytes_; }

  /// Direction of the step that led to the cell; kHere: it is linked to the start.
  int step_to(std::uint32_t index, int likely) const {
    const DirectionMask free =
        free_steps(blocked_around(grid_, lattice_.cell(index)), settings_.corner);
    const auto led_here = [&](int d) {
      const auto from = std::uint32_t(std::int64_t(index) - lattice_.stride(d));
      return (steps_ >> d & 1) != 0 && (free >> opposite(d) & 1) != 0 &&
             g(from) + costs_[d] == g(index) && is_closed(grid_.bit(lattice_.cell(from)));
    };
    if (led_here(likely)) {
      return likely;
    }
    for (int d = 0; d < kDirections; ++d) {
      if (led_here(d)) {
        return d;
      }
    }
    return kHere;
  }

  /// Direction and number of steps of the run that led to the cell; kHere: it is linked to the
  /// start.
  std::pair<int, int> led_to(std::uint32_t index, int likely) const {
    if (const int d = step_to(index, likely); d != kHere) {
      return {d, 1};
    }
    const Cell c = lattice_.cell(index);
    for (DirectionMask axes = level_ ? 0 : kAlongAxes[0]; axes != 0; axes &= axes - 1) {
      const int d = std::countr_zero(axes);
      const Cell o = offset(d);
      Cell from = c;
      for (int steps = 1; steps <= StraightRuns::kLongest; ++steps) {
        from = {from[0] - o[0], from[1] - o[1], from[2] - o[2]};
        if (grid_.blocked(from)) {
          break;
        }
        if (is_closed(grid_.bit(from)) &&
            g(lattice_.index(from)) + std::uint32_t(steps) * costs_[d] == g(index)) {
          return {d, steps};
        }
      }
    }
    return {kHere, 0};
  }

  PlanResult found(std::uint32_t last, bool at_goal) const {
    std::pair<int, int> led{kHere, 0};
    const auto step_to = [&](std::uint32_t index, int likely) {
      auto& [d, left] = led;
      led = left > 1 ? std::pair{d, left - 1} : led_to(index, likely);
      return d;
    };
    Polyline route = route_to(last, request_, lattice_, step_to,
                              [&](std::uint32_t index) { return g(index) == 0; });
    if (at_goal) {
      end_at_goal(route, goal_, g(last) == goal_g_);
    }
    PlanResult result = solved(std::move(route), progress_, lattice_, rules_);
    if (settings_.costs == StepCosts::Scale::ratio) {
      result.message += ", lengths by ratios of integers, up to " +
                        std::to_string(100 * costs_.error()) + " % off";
    }
    return result;
  }

  /// Of the cell, and of those on runs from it to beside the goal.
  void remember_nearest(const Cell& c) {
    const auto remember = [&](const Cell& at) {
      const Vec3 here = lattice_.position(at);
      if ((here - goal_).norm() < nearest_) {
        nearest_ = (here - goal_).norm();
        progress_.nearest = here;
      }
    };
    remember(c);
    const Cell to = lattice_.nearest(goal_).cell;
    for (std::size_t axis = 0; axis < 3 && !level_; ++axis) {
      Vec3 beside = lattice_.position(c) - goal_;
      beside[Eigen::Index(axis)] = 0;
      for (Cell at = c; at[axis] != to[axis] && beside.norm() < nearest_;) {
        at[axis] += at[axis] < to[axis] ? 1 : -1;
        if (grid_.blocked(at)) {
          break;
        }
        remember(at);
      }
    }
  }

  /// The goal was not reached: a cell within its tolerance, or the reason.
  PlanResult without_goal(PlanResult result) {
    std::optional<std::uint32_t> nearest_start;
    nearest_ = kInfinity;
    for_each_closed([&](const Cell& c) {
      const std::uint32_t index = lattice_.index(c);
      if (request_.goal.reached_at(lattice_.position(c)) &&
          (!nearest_start || g(index) < g(*nearest_start))) {
        nearest_start = index;
      }
      remember_nearest(c);
    });
    if (nearest_start) {
      PlanResult within = found(*nearest_start, false);
      within.budget_hit = result.budget_hit;
      return within;
    }
    for_each_closed([&](const Cell& c) { rules_.candidates(c, kHere); });  // counts refusals
    progress_.memory_full = memory_full();
    result.message = explanation(result.status, progress_, request_, lattice_, rules_);
    result.proved = result.status == PlanStatus::no_route;
    result.counters = counters(progress_, lattice_, rules_);
    return result;
  }

  template <class Visit>
  void for_each_closed(const Visit& visit) const {
    const Cell& counts = lattice_.spec().counts;
    for (int k = 0; k < counts[2]; ++k) {
      for (int j = 0; j < counts[1]; ++j) {
        const std::size_t row = closed_bit(grid_.bit(-1, j, k)) / 64;
        for (std::size_t word = 0; word < grid_.words_per_row(); ++word) {
          for (std::uint64_t bits = closed_[row + word]; bits != 0; bits &= bits - 1) {
            visit(Cell{int(64 * word) + std::countr_zero(bits) - 1, j, k});
          }
        }
      }
    }
  }

  void add_to_trace(std::uint32_t index) const {
    const Cell c = lattice_.cell(index);
    const auto [d, steps] = led_to(index, kHere);
    const std::int64_t parent = d == kHere ? -1 : std::int64_t(index) - steps * lattice_.stride(d);
    request_.trace->add(
        {TraceEvent::Kind::expanded, std::int64_t(index), parent, lattice_.position(c),
         settings_.weight_g * costs_.metres(g(index)) +
             settings_.weight_h * costs_.metres(to_goal_.at<false>(c[0], c[1], c[2]))});
  }

  const Request& request_;
  const SearchSettings& settings_;
  const Lattice& lattice_;
  const StepCosts& costs_;
  MoveRules rules_;
  const VoxelGrid& grid_;
  ScratchArray<std::uint32_t>& complement_;
  ScratchArray<std::uint64_t>& closed_;
  BucketQueue& open_;
  BudgetWatch watch_;
  std::size_t max_open_bytes_;
  bool tracing_;
  bool consistent_;
  bool level_;
  const LevelSuccessors& level_successors_;
  const SpaceSuccessors& space_successors_;
  DirectionMask steps_;
  bool prune_;  ///< the paths around a cell on which pruning relies consist of all steps
  bool by_runs_;
  StraightRuns runs_;
  bool is_sum_;  ///< f is g + h
  double weight_g_;
  double weight_h_;
  std::uint32_t goal_node_;
  Vec3 goal_;
  CellEstimate to_goal_;
  std::array<Move, kDirections> moves_{};
  std::uint32_t first_link_ = ~std::uint32_t{0};  ///< minimum and maximum index of them
  std::uint32_t last_link_ = 0;
  std::uint32_t goal_g_ = ~std::uint32_t{0};
  std::uint32_t goal_parent_ = 0;
  double nearest_ = kInfinity;  ///< distance of progress_.nearest from the goal, metres
  SearchStats progress_;
};
}  // namespace altiplan::kit
