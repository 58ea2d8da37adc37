// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "altiplan/kit/lattice/lattice_search.hpp"
#include "cell_graph.hpp"
#include "open_queue.hpp"
#include "vertices.hpp"

namespace altiplan::dstar_lite {

struct Memory {
  VertexMemory vertices;
  OpenQueue open;
  Heap raised;
};

/// Incremental search from the goal to the start, on a graph whose legs appear and disappear.
///
/// rhs(s) is the one-step lookahead value of s: the minimum of c(s, n) + g(n) over its successors
/// n. Vertices with g != rhs are inconsistent. One with g > rhs is on the open list, under a key
/// that is never above min(g, rhs) + h(start, s) + k_m, and popping it lowers g to rhs. One with g
/// < rhs (its onward path was blocked) is harmless unless a route passes over it, as values that
/// are too low hide no better path. So where something is blocked, no rhs is recomputed: the route
/// found is walked, and where it meets such a vertex, g is raised.
template <class Graph>
class Search {
 public:
  /// All arguments must outlive the search.
  Search(const Problem& problem, Graph& graph, ToStart& to_start, const VoxelGrid& layout,
         Memory& memory)
      : problem_(problem),
        graph_(graph),
        to_start_(to_start),
        vertices_(problem.lattice.size() * Graph::kPerCell, layout, memory.vertices),
        open_(memory.open),
        raised_(memory.raised) {
    open_.clear();
    raised_.clear();
  }

  /// procedure Initialize: the vertices one leg away from the goal; called again where these legs
  /// may have changed.
  void initialize() {
    fresh_ = max_entries_ == 0;
    graph_.for_each_at_goal([&](std::uint32_t s) {
      const Cell c = graph_.cell(s);
      vertices_.know(c);
      update_rhs(s, c, 0, false);
    });
  }

  /// The start has moved: `links` join its new position to the lattice. All keys on the open list
  /// remain lower bounds, as k_m grows by the largest possible decrease of the heuristic. Returns
  /// true while keys are still far from the 32-bit limit.
  bool move_start(const std::vector<kit::Lattice::Link>& links) {
    std::uint32_t fall = 0;
    for (const kit::Lattice::Link& link : moved_ ? links : std::vector<kit::Lattice::Link>()) {
      const std::uint32_t before = to_start_(link.cell);
      const std::uint32_t now = problem_.costs.of_link(link.length);
      fall = std::max(fall, before > now ? before - now : 0);
    }
    moved_ = true;
    to_start_.move(links, problem_);
    k_m_ += fall;
    return k_m_ < kMaxKm;
  }

  /// Removes a vertex that no longer exists. The walk finds the vertices that relied on it where it
  /// matters.
  void remove(std::uint32_t s) {
    fresh_ = false;
    vertices_.forget(s);
  }
  /// The legs from the vertex may have changed.
  void touch(std::uint32_t s) {
    fresh_ = false;
    update_rhs(s, graph_.cell(s), 0, false);
  }
  const Vertices& vertices() const { return vertices_; }

  /// procedure Main, one round: the cheapest path from the start to the goal. Put off, for a later
  /// round or go_on(), after work as for lowering `max_expanded` vertices.
  PlanStatus plan(BudgetWatch& watch, std::size_t max_list_bytes, std::uint64_t max_expanded) {
    watch_ = &watch;
    max_list_bytes_ = max_list_bytes;
    progress_ = {};
    raises_ = 0;
    nearest_ = kNever;
    forget_stale_entries();
    return go_on(max_expanded);
  }
  PlanStatus go_on(std::uint64_t max_expanded) {
    max_expanded_ = max_expanded;
    ended_ = put_off_ = false;
    do {
      compute_shortest_path();
    } while (!ended_ && !too_long_ && best_ != kNever && !walk());
    if (ended_ || too_long_) {
      progress_.memory_full = memory_full();
    }
    if (max_entries_ == 0) {
      max_entries_ = std::max(kFewEntries, 2 * (open_.size() + raised_.size()));
    }
    if (nearest_ != kNever) {
      progress_.nearest = problem_.lattice.position(graph_.cell(nearest_vertex_));
    }
    if (ended_ || too_long_) {
      return watch_->cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out;
    }
    return best_ == kNever ? PlanStatus::no_route : PlanStatus::solved;
  }
  bool is_put_off() const { return put_off_; }
  /// True if a path is longer than the integers can represent.
  bool too_long() const { return too_long_; }
  /// The vertices of the route, from the start's neighbour to the goal's.
  const std::vector<std::uint32_t>& way() const { return way_; }
  const kit::SearchStats& progress() const { return progress_; }

 private:
  static constexpr std::uint32_t kMaxKm = 1'500'000'000;
  static constexpr std::size_t kFewEntries = 1 << 14;
  static constexpr std::uint64_t kRaise = 4;  ///< how much longer a raise takes

  using Values = Vertices::Values;

  /// procedure CalculateKey, for a vertex at the cell whose smaller value is `cost`.
  Entry entry(std::uint32_t s, std::uint32_t cost, const Cell& c) const {
    const std::uint32_t h = graph_.estimate(c);
    return {cost + h + k_m_, h, s};
  }

  /// procedure UpdateVertex. A vertex whose g is to be raised waits on a list only if a raise
  /// caused it (`rising`): no later vertex is lowered before that on account of invalid values.
  void update_vertex(std::uint32_t s, const Values& now, const Cell& c, bool rising) {
    if (now.rhs < now.g) {
      ++progress_.generated;
      open_.push(entry(s, now.rhs, c));
    } else if (now.g < now.rhs && rising) {
      raised_.push(entry(s, now.g, c));
    }
  }

  /// Recomputes rhs, which is known not to be below `min_rhs`.
  void update_rhs(std::uint32_t s, const Cell& c, std::uint32_t min_rhs, bool rising) {
    const Values old = vertices_[s];
    std::uint32_t rhs = graph_.goal_cost(s);
    graph_.successors(s, kit::kHere, [&](std::uint32_t n, std::uint32_t cost, const auto& is_free) {
      const std::uint32_t g = vertices_.g(n);
      if (g != kNever && g + cost < rhs && is_free()) {
        rhs = g + cost;
      }
      return rhs > min_rhs;
    });
    if (rhs != old.rhs) {
      vertices_.set(s, {old.g, rhs});
      update_vertex(s, {old.g, rhs}, c, rising);
    }
  }

  /// procedure ComputeShortestPath: until no vertex can lie on a cheaper path than the start's.
  void compute_shortest_path() {
    find_best();
    while (!open_.empty()) {
      const Entry first = open_.top();
      if (best_ != kNever && first.key >= best_ + k_m_) {
        return;
      }
      if (!raised_.empty() && raised_.top().key <= first.key) {
        const std::uint32_t s = raised_.top().node;
        const Values old = vertices_[s];
        if (old.g < old.rhs && spent()) {
          return;
        }
        raised_.pop();
        if (old.g < old.rhs) {
          raise(s, old);
        }
        continue;
      }
      open_.pop();
      const Values old = vertices_[first.node];
      if (old.rhs >= old.g) {
        continue;  // lowered in the meantime
      }
      const Entry now = entry(first.node, old.rhs, graph_.cell(first.node));
      if (first.key < now.key) {
        open_.push(now);
      } else if (spent() || old.rhs > kit::StepCosts::kMax) {
        too_long_ = !ended_;
        open_.push(now);
        return;
      } else {
        remember_nearest(now);
        lower(first.node, old);
      }
    }
  }

  /// Sets g of an overconsistent vertex to rhs.
  void lower(std::uint32_t u, const Values& old) {
    ++progress_.expanded;
    const std::uint32_t g = old.rhs;
    const Cell at = graph_.cell(u);
    // Vertices expanded earlier cannot improve while no leg has changed.
    const kit::DirectionMask closed =
        fresh_ && Graph::kPerCell == 1 ? vertices_.opened_around(at) : 0;
    vertices_.open(at);
    vertices_.set(u, {g, g});
    trace(u, g);
    graph_.predecessors(u, at, closed, [&](std::uint32_t s, std::uint32_t cost, const Cell& c) {
      const std::uint32_t rhs = g + cost;
      const Values of_s = vertices_[s];
      if (rhs < of_s.rhs) {
        vertices_.set(s, {of_s.g, rhs});
        update_vertex(s, {of_s.g, rhs}, c, false);
      }
    });
    if (graph_.start().may_hold(u)) {
      find_best();
    }
  }

  /// Sets g of an underconsistent vertex to infinity.
  void raise(std::uint32_t u, const Values& old) {
    ++progress_.expanded;
    ++raises_;
    vertices_.set(u, {kNever, kNever});
    update_rhs(u, graph_.cell(u), 0, true);
    trace(u, vertices_[u].rhs);
    graph_.predecessors(u, graph_.cell(u), 0,
                        [&](std::uint32_t s, std::uint32_t cost, const Cell& c) {
                          update_if_relied(s, c, old.g, cost, true);
                        });
    if (graph_.start().may_hold(u)) {
      find_best();
    }
  }
  /// Recomputes rhs of s if it relied on a leg to a vertex whose g has changed. If s is to be
  /// raised anyway, rhs need not be exact until then, only not too high.
  void update_if_relied(std::uint32_t s, const Cell& c, std::uint32_t g, std::uint32_t cost,
                        bool rising) {
    const Values now = vertices_[s];
    if (g != kNever && now.rhs == g + cost && now.g >= now.rhs) {
      update_rhs(s, c, now.rhs, rising);
    }
  }

  /// Computes rhs of the start.
  void find_best() {
    best_ = kNever;
    for (const Link& link : graph_.start().all()) {
      if (const std::uint32_t g = vertices_.g(link.node); g != kNever) {
        best_ = std::min(best_, g + link.cost);
      }
    }
  }

  /// Follows the route from the start. Raises each vertex on it whose g is not rhs, or whose rhs
  /// relies on a leg that no longer exists, and the preceding vertices for as long as their g
  /// relied on that. Returns true if the whole route was consistent.
  bool walk() {
    way_.clear();
    bool sound = true;
    while (way_.empty() || graph_.goal_cost(way_.back()) != vertices_[way_.back()].rhs) {
      const std::uint32_t next = way_.empty() ? first_vertex() : next_vertex();
      if (next != kNever) {
        way_.push_back(next);
      } else {
        update_rhs(way_.back(), graph_.cell(way_.back()), 0, false);
      }
      for (Values last = vertices_[way_.back()]; last.g != last.rhs;
           last = vertices_[way_.back()]) {
        if (spent()) {
          return false;
        }
        sound = false;
        if (last.rhs < last.g) {
          lower(way_.back(), last);
        } else {
          raise(way_.back(), last);
        }
        way_.pop_back();
        if (way_.empty()) {
          return false;
        }
      }
    }
    return sound;
  }
  std::uint32_t first_vertex() const {
    for (const Link& link : graph_.start().all()) {
      if (const std::uint32_t g = vertices_.g(link.node); g != kNever && g + link.cost == best_) {
        return link.node;
      }
    }
    return kNever;
  }
  /// Prefers to go straight on: that touches little memory.
  std::uint32_t next_vertex() {
    const std::uint32_t s = way_.back();
    const int likely =
        way_.size() > 1 ? graph_.direction(way_[way_.size() - 2], s) : int(kit::kHere);
    const std::uint32_t rhs = vertices_[s].rhs;
    std::uint32_t next = kNever;
    graph_.successors(s, likely, [&](std::uint32_t n, std::uint32_t cost, const auto& is_free) {
      const std::uint32_t g = vertices_.g(n);
      if (g != kNever && g + cost == rhs && is_free()) {
        next = n;
      }
      return next == kNever;
    });
    return next;
  }

  bool spent() {
    put_off_ = progress_.expanded + kRaise * raises_ >= max_expanded_;
    ended_ = ended_ || put_off_ || watch_->spent(progress_.expanded, open_.size()) || memory_full();
    return ended_;
  }
  bool memory_full() const { return open_.bytes() + raised_.bytes() > max_list_bytes_; }

  /// Drops entries of vertices that have been pushed again or are consistent, once there are many.
  void forget_stale_entries() {
    if (max_entries_ == 0 || (open_.size() + raised_.size() <= max_entries_ && !memory_full())) {
      return;
    }
    std::vector<std::uint32_t> waiting;
    for (; !open_.empty(); waiting.push_back(open_.pop().node)) {
    }
    for (; !raised_.empty(); waiting.push_back(raised_.pop().node)) {
    }
    open_.clear();
    std::sort(waiting.begin(), waiting.end());
    waiting.erase(std::unique(waiting.begin(), waiting.end()), waiting.end());
    for (const std::uint32_t s : waiting) {
      update_vertex(s, vertices_[s], graph_.cell(s), true);
    }
    max_entries_ = std::max(kFewEntries, 2 * waiting.size());
  }

  void remember_nearest(const Entry& entry) {
    if (entry.h < nearest_) {
      nearest_ = entry.h;
      nearest_vertex_ = entry.node;
    }
  }
  void trace(std::uint32_t s, std::uint32_t cost) const {
    if (Trace* const trace = problem_.request.trace) {
      const Cell c = graph_.cell(s);
      const double f = problem_.costs.metres(cost == kNever ? cost : cost + graph_.estimate(c));
      trace->add(
          {TraceEvent::Kind::expanded, std::int64_t(s), -1, problem_.lattice.position(c), f});
    }
  }

  const Problem& problem_;
  Graph& graph_;
  ToStart& to_start_;
  Vertices vertices_;
  OpenQueue& open_;
  Heap& raised_;
  std::uint32_t k_m_ = 0;
  std::uint32_t best_ = kNever;
  bool moved_ = false;  ///< the start has a position
  bool fresh_ = true;   ///< all legs are as they were initially
  bool ended_ = false;
  bool put_off_ = false;
  std::uint64_t max_expanded_ = 0;
  std::uint64_t raises_ = 0;
  bool too_long_ = false;
  BudgetWatch* watch_ = nullptr;
  kit::SearchStats progress_;
  std::uint32_t nearest_ = kNever;  ///< estimate of the expanded vertex nearest to the start
  std::uint32_t nearest_vertex_ = 0;
  std::size_t max_list_bytes_ = 0;
  std::size_t max_entries_ = 0;  ///< before stale ones are dropped; 0: not yet planned
  std::vector<std::uint32_t> way_;
};
}  // namespace altiplan::dstar_lite
