// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "altiplan/kit/lattice_search.hpp"
#include "altiplan/kit/scratch.hpp"

namespace altiplan::dstar_lite {

inline constexpr std::uint32_t kNever = ~std::uint32_t{0};  ///< the cost of no way

/// What a plan is about. All of it outlives what is made of it.
struct Problem {
  const Request& request;
  const kit::SearchSettings& settings;
  const kit::Lattice& lattice;
  const kit::StepCosts& costs;

  std::uint32_t link_cost(const kit::Lattice::Link& link) const {
    return link.length > 0 ? std::max(costs.of(link.length), 1U) : 0;
  }
};

/// Whether the cells that a step leads through, and its direction, say if it is free.
inline bool cells_decide(const Request& request, const kit::SearchSettings& settings) {
  Request each_leg = request;  // what whole routes have to keep is asked in the end
  each_leg.limits.max_turn_horizontal = each_leg.limits.max_turn_space = kPi;
  each_leg.limits.min_turn_radius = 0;
  each_leg.limits.max_route_length = kInfinity;
  return settings.moves == kit::MoveCheck::cells && kit::MoveRules::cells_decide(each_leg);
}

/// Cells from low to high, both included.
struct CellRange {
  Cell low{1, 1, 1};
  Cell high{0, 0, 0};  ///< below low on an axis: no cells

  std::size_t count() const {
    std::size_t cells = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cells *= std::size_t(std::max(high[axis] - low[axis] + 1, 0));
    }
    return cells;
  }
  void add(const CellRange& other) {
    const bool empty = count() == 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = empty ? other.low[axis] : std::min(low[axis], other.low[axis]);
      high[axis] = empty ? other.high[axis] : std::max(high[axis], other.high[axis]);
    }
  }
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (int k = low[2]; k <= high[2]; ++k) {
      for (int j = low[1]; j <= high[1]; ++j) {
        for (int i = low[0]; i <= high[0]; ++i) {
          visit(Cell{i, j, k});
        }
      }
    }
  }
};

/// A cell and those around it.
inline CellRange around(const Cell& c, const kit::Lattice& lattice) {
  CellRange range{c, c};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    range.low[axis] = std::max(c[axis] - 1, 0);
    range.high[axis] = std::min(c[axis] + 1, lattice.spec().counts[axis] - 1);
  }
  return range;
}

/// The cells that a box reaches into, and those beside them.
inline CellRange cells_in(const Box& box, const kit::Lattice& lattice) {
  const GridSpec& spec = lattice.spec();
  CellRange range;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = std::size_t(axis);
    const auto cell = [&](double at, double more) {
      const double index = std::floor((at - spec.origin[axis]) / spec.cell[axis]) + more;
      return int(std::clamp(index, -1.0, double(spec.counts[a])));
    };
    range.low[a] = std::max(cell(box.min[axis], -1), 0);
    range.high[a] = std::min(cell(box.max[axis], 1), spec.counts[a] - 1);
  }
  return range;
}

/// The heuristic: the least cost between the start and a cell, were none blocked.
class ToStart {
 public:
  explicit ToStart(const Problem& problem) : costs_(problem.costs) {}

  /// Not to be called without any link.
  void move(const std::vector<kit::Lattice::Link>& links, const Problem& problem) {
    others_.clear();
    for (const kit::Lattice::Link& link : links) {
      others_.push_back({link.cell, problem.link_cost(link)});
    }
    first_ = others_.back();  // most often the only one
    others_.pop_back();
  }
  std::uint32_t operator()(const Cell& c) const {
    std::uint32_t least = costs_.between(c, first_.cell) + first_.cost;
    for (const End& end : others_) {
      least = std::min(least, costs_.between(c, end.cell) + end.cost);
    }
    return least;
  }

 private:
  struct End {
    Cell cell;
    std::uint32_t cost;
  };
  const kit::StepCosts& costs_;
  End first_{};
  std::vector<End> others_;
};

/// What is known of legs beside what the occupancy says.
struct LegMemory {
  struct Near {
    kit::MoveRules::KnownClearance clearance;
    std::uint16_t stamp;
  };
  kit::ScratchArray<std::uint32_t> judged;  ///< by cell: directions with a free leg to it, kJudged
  kit::NodeStore<Near> near;

  static constexpr std::size_t kBytesPerCell = sizeof(std::uint32_t) + sizeof(Near);
};

/// Which legs between neighbouring cells a vehicle may fly, whatever was before.
class Legs {
 public:
  Legs(const Problem& problem, LegMemory& memory)
      : problem_(problem),
        lattice_(problem.lattice),
        memory_(memory),
        judges_(!cells_decide(problem.request, problem.settings)),
        level_(lattice_.spec().counts[2] == 1) {
    if (judges_) {
      memory.judged.reset(lattice_.size());
    }
    renew();
  }
  /// Takes in the request's world; what legs within a box were said to be has to be forgotten.
  void renew() {
    rules_.emplace(problem_.request, lattice_, problem_.settings.moves, problem_.settings.corner);
    steps_ = rules_->steps() & (level_ ? kLevelSteps : ~kit::DirectionMask{0});
    if (judges_) {
      memory_.near.reset(lattice_.size());
    }
  }
  void forget(std::uint32_t index) {
    if (judges_ && memory_.judged[index] != 0) {
      memory_.judged.at(index) = 0;
    }
  }
  /// Whether the legs to a cell are asked for one by one, and one way only.
  bool judges() const { return judges_; }
  kit::DirectionMask steps() const { return steps_; }
  kit::MoveRules& rules() { return *rules_; }
  const kit::MoveRules& rules() const { return *rules_; }

  /// Directions from a cell to those from which a leg leads to it.
  kit::DirectionMask into(std::uint32_t index, const Cell& c) {
    return judges_ ? judged(index, c) : by_cells(c);
  }
  /// Whether the leg from the cell in that direction is free; there has to be a cell.
  bool leads(std::uint32_t index, const Cell& c, int d) {
    const Cell o = kit::offset(d);
    return (into(std::uint32_t(index + lattice_.stride(d)),
                 {c[0] + o[0], c[1] + o[1], c[2] + o[2]}) >>
                kit::opposite(d) &
            1) != 0;
  }

 private:
  static constexpr kit::DirectionMask kLevelSteps = 0x3FE00;
  static constexpr std::uint32_t kJudged = std::uint32_t{1} << kit::kDirections;

  kit::DirectionMask by_cells(const Cell& c) const {
    const VoxelGrid& grid = *rules_->grid();
    const std::uint64_t* words = grid.words().data();
    const kit::DirectionMask blocked = level_ ? kit::bits_around<true>(grid, words, grid.bit(c))
                                              : kit::bits_around(grid, words, grid.bit(c));
    return steps_ & kit::free_steps(blocked, problem_.settings.corner);
  }

  kit::DirectionMask judged(std::uint32_t index, const Cell& c) {
    const std::uint32_t known = memory_.judged[index];
    if (known != 0) {
      return known & (kJudged - 1);
    }
    const Vec3 here = lattice_.position(c);
    kit::DirectionMask free = 0;
    for (kit::DirectionMask open = rules_->out_of(c); open != 0; open &= open - 1) {
      const int d = std::countr_zero(open);
      const Cell o = kit::offset(d);
      const Cell from = {c[0] + o[0], c[1] + o[1], c[2] + o[2]};
      const Vec3 there = lattice_.position(from);
      const bool is_free =
          rules_->place_free(from, kit::opposite(d), there, here,
                             near(std::uint32_t(index + lattice_.stride(d))), near(index)) &&
          rules_->admits(std::nullopt, there, here);
      free |= kit::DirectionMask(is_free) << d;
    }
    memory_.judged.at(index) = free | kJudged;
    return free;
  }
  kit::MoveRules::KnownClearance& near(std::uint32_t index) {
    return memory_.near.at(index, {}).clearance;
  }

  const Problem& problem_;
  const kit::Lattice& lattice_;
  LegMemory& memory_;
  bool judges_;
  bool level_;
  std::optional<kit::MoveRules> rules_;
  kit::DirectionMask steps_ = 0;
};

/// Takes a direction from a mask that has some, the likely one if it can.
inline int take_direction(kit::DirectionMask& mask, int likely) {
  const int d = (mask >> likely & 1) != 0 ? likely : std::countr_zero(mask);
  mask &= ~(kit::DirectionMask{1} << d);
  return d;
}

/// A way to or from the lattice: a node, and what the leg there costs.
struct Link {
  std::uint32_t node;
  std::uint32_t cost;
};

/// Few links among many nodes.
class Links {
 public:
  void clear() {
    all_.clear();
    first_ = kNever;
    span_ = 0;
  }
  void add(std::uint32_t node, std::uint32_t cost) {
    const std::uint32_t last = all_.empty() ? node : std::max(first_ + span_, node);
    first_ = std::min(first_, node);
    span_ = last - first_;
    all_.push_back({node, cost});
  }
  const std::vector<Link>& all() const { return all_; }
  bool may_hold(std::uint32_t node) const { return node - first_ <= span_; }
  /// Of the node, kNever where it has none.
  std::uint32_t cost(std::uint32_t node) const {
    std::uint32_t least = kNever;
    if (may_hold(node)) {
      for (const Link& link : all_) {
        least = link.node == node ? std::min(least, link.cost) : least;
      }
    }
    return least;
  }

 private:
  std::vector<Link> all_;
  std::uint32_t first_ = kNever;
  std::uint32_t span_ = 0;
};

/// Calls visit(link) for the cells from which the goal may be one leg away; `within`: for those
/// within its tolerance, where routes may end.
template <class Visit>
void for_each_goal_link(const Problem& problem, Legs& legs, bool within, const Visit& visit) {
  const kit::Lattice& lattice = problem.lattice;
  const Goal& goal = problem.request.goal;
  if (!within) {
    for (const kit::Lattice::Link& link : lattice.links(goal.position)) {
      if (!legs.rules().cell_blocked(link.cell)) {
        visit(link);
      }
    }
    return;
  }
  const Vec3 reach = Vec3::Constant(goal.tolerance_m);
  const Box box{goal.position - reach, goal.position + reach};
  cells_in(box, lattice).for_each([&](const Cell& c) {
    if (goal.reached_at(lattice.position(c)) && !legs.rules().cell_blocked(c)) {
      visit(kit::Lattice::Link{c, 0});
    }
  });
}

/// Calls visit(link) for those of the links that the vehicle may fly from where it is.
template <class Visit>
void for_each_start_link(const Problem& problem, Legs& legs,
                         const std::vector<kit::Lattice::Link>& links, const Visit& visit) {
  const Request& request = problem.request;
  for (const kit::Lattice::Link& link : links) {
    if (!legs.rules().cell_blocked(link.cell) &&
        (link.length == 0 || legs.rules().any_leg_ok(request.before_start(), request.start.position,
                                                     problem.lattice.position(link.cell)))) {
      visit(link);
    }
  }
}

/// The graph whose vertices are cells.
class CellGraph {
 public:
  static constexpr std::uint32_t kPerCell = 1;

  CellGraph(const Problem& problem, Legs& legs, const ToStart& to_start)
      : problem_(problem), lattice_(problem.lattice), legs_(legs), to_start_(to_start) {
    for (int d = 0; d < kit::kDirections; ++d) {
      const Cell o = kit::offset(d);
      moves_[std::size_t(d)] = {std::uint32_t(lattice_.stride(d)), problem.costs[d], o[0], o[1],
                                o[2]};
    }
  }

  Cell cell(std::uint32_t node) const { return lattice_.cell(node); }
  /// h(start, node).
  std::uint32_t estimate(const Cell& c) const { return to_start_(c); }

  /// Calls visit(s, c(s, u), cell of s) for the vertices from which a leg leads to u, at cell c,
  /// but for those in the directions `without`.
  template <class Visit>
  void predecessors(std::uint32_t u, const Cell& c, kit::DirectionMask without,
                    const Visit& visit) {
    const kit::DirectionMask free = legs_.into(u, c) & ~without;
    // Of equals the last one is taken first: the step along most axes.
    for (const kit::DirectionMask along : {0x0415410U, 0x2AA8AAAU, 0x5140145U}) {
      for (kit::DirectionMask open = free & along; open != 0; open &= open - 1) {
        const Move& move = moves_[std::size_t(std::countr_zero(open))];
        visit(u + move.stride, move.cost, Cell{c[0] + move.x, c[1] + move.y, c[2] + move.z});
      }
    }
  }
  /// Calls visit(n, c(s, n), is_free) for the vertices that a leg from s may lead to; is_free()
  /// says whether it does. That in direction `likely` comes first; ends when a visit returns false.
  template <class Visit>
  void successors(std::uint32_t s, int likely, const Visit& visit) {
    const Cell c = lattice_.cell(s);
    const bool judges = legs_.judges();
    kit::DirectionMask open = judges ? legs_.steps() & lattice_.inside(c) : legs_.into(s, c);
    while (open != 0) {
      const int d = take_direction(open, likely);
      const Move& move = moves_[std::size_t(d)];
      if (!visit(s + move.stride, move.cost, [&, d] { return !judges || legs_.leads(s, c, d); })) {
        return;
      }
    }
  }
  /// Of the leg from s to its successor n.
  int direction(std::uint32_t s, std::uint32_t n) const {
    int d = 0;
    while (moves_[std::size_t(d)].stride != n - s) {
      ++d;
    }
    return d;
  }
  /// Of the leg from a vertex to the goal, kNever where there is none.
  std::uint32_t goal_cost(std::uint32_t s) const { return goal_.cost(s); }
  /// The vertices that the vehicle may fly to from where it is.
  const Links& start() const { return start_; }
  /// Calls visit(s) for the vertices that are one leg from the goal, or may have been.
  template <class Visit>
  void for_each_at_goal(const Visit& visit) {
    for (const kit::Lattice::Link& link : lattice_.links(problem_.request.goal.position)) {
      visit(lattice_.index(link.cell));
    }
    for (const Link& link : goal_.all()) {
      visit(link.node);
    }
  }
  /// Calls visit(s) for the vertices of a cell.
  template <class Visit>
  void for_each_at(const Cell& c, const Visit& visit) const {
    visit(lattice_.index(c));
  }

  void find_goal(bool within) {
    goal_.clear();
    for_each_goal_link(problem_, legs_, within, [&](const kit::Lattice::Link& link) {
      const bool is_free =
          link.length == 0 || legs_.rules().any_leg_ok(std::nullopt, lattice_.position(link.cell),
                                                       problem_.request.goal.position);
      if (is_free) {
        goal_.add(lattice_.index(link.cell), problem_.link_cost(link));
      }
    });
  }
  void find_start(const std::vector<kit::Lattice::Link>& links) {
    start_.clear();
    for_each_start_link(problem_, legs_, links, [&](const kit::Lattice::Link& link) {
      start_.add(lattice_.index(link.cell), problem_.link_cost(link));
    });
  }

 private:
  struct Move {
    std::uint32_t stride;  ///< difference of index, modulo 2^32
    std::uint32_t cost;
    int x, y, z;
  };

  const Problem& problem_;
  const kit::Lattice& lattice_;
  Legs& legs_;
  const ToStart& to_start_;
  std::array<Move, kit::kDirections> moves_{};
  Links goal_;
  Links start_;
};
}  // namespace altiplan::dstar_lite
