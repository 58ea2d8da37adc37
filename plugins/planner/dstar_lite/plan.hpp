// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "afresh.hpp"
#include "answers.hpp"
#include "changed_cells.hpp"
#include "dstar_search.hpp"
#include "heading_graph.hpp"

namespace altiplan::dstar_lite {

/// Work memory that persists between sessions.
struct Pools {
  kit::ScratchPool<Memory> searches;
  kit::ScratchPool<kit::CellMemory> astar;
  kit::ScratchPool<LegMemory> legs;
};

/// A search and the graph on which it runs.
template <class Graph>
struct Incremental {
  Incremental(const Problem& problem, Legs& legs, const VoxelGrid& bits, Pools& pools)
      : memory(pools.searches.take()),
        to_start(problem),
        graph(problem, legs, to_start),
        search(problem, graph, to_start, bits, *memory) {}

  kit::ScratchPool<Memory>::Lease memory;
  ToStart to_start;
  Graph graph;
  Search<Graph> search;
};

/// The searches for one goal on one lattice: over cells and, if the resulting route violates a
/// constraint on two consecutive legs, over cells with headings.
class Plan {
 public:
  /// `request` and `settings` belong to the session and change during the plan's life; `within`:
  /// routes end at any cell within the goal's tolerance.
  Plan(const Request& request, const kit::SearchSettings& settings, const kit::Lattice& lattice,
       const kit::StepCosts& costs, bool within, Pools& pools)
      : lattice_(lattice),
        costs_(costs),
        problem_{request, settings, lattice_, costs_},
        pools_(pools),
        leg_memory_(pools.legs.take()),
        legs_(problem_, *leg_memory_),
        grid_(legs_.rules().grid() != nullptr ? kit::occupancy(request, lattice_)
                                              : std::make_shared<VoxelGrid>(lattice_.spec())),
        bits_(grid_),
        has_ground_(request.world->has_ground()),
        last_slack_(request.world->over_approximation()),
        within_(within),
        afresh_(problem_, pools.astar) {
    begin(by_cell_);
  }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  const kit::Lattice& lattice() const { return lattice_; }
  const kit::StepCosts& costs() const { return costs_; }
  bool within() const { return within_; }
  /// True if a path was longer than the integers can represent: coarser ones are needed.
  bool too_long() const {
    return by_cell_->search.too_long() || (by_heading_ && by_heading_->search.too_long());
  }

  /// Adopts the request's new world; returns true if the plan can continue.
  bool take(std::span<const Change> changes) {
    const World& world = *problem_.request.world;
    if (world.has_ground() != has_ground_ ||
        legs_.judges() == cells_decide(problem_.request, problem_.settings)) {
      return false;
    }
    const auto before = grid_;
    slack_ = std::max(std::exchange(last_slack_, world.over_approximation()),
                      world.over_approximation());
    legs_.renew();
    if (legs_.rules().grid() != nullptr) {
      grid_ = kit::occupancy(problem_.request, lattice_);
    }
    if (!(before->spec() == grid_->spec())) {
      return false;
    }
    if (legs_.judges()) {
      return take_legs(changes);
    }
    const auto known = [&](int level) {  // changes elsewhere touch nothing that was examined
      CellRange range;
      for_each_search([&](const auto& at) { range.add(at.search.vertices().known(level)); });
      return range;
    };
    return take_cells(changed_cells(*before, *grid_, changes, known, lattice_));
  }

  /// Adopts the vehicle's position; returns true if the plan can continue.
  bool find_start() {
    bool goes_on = true;
    for_each_search([&](auto& at) { goes_on = find_start(at) && goes_on; });
    return goes_on;
  }

  PlanResult run() {
    BudgetWatch watch(problem_.request.budget);
    const kit::SearchState state = problem_.settings.state;
    const bool looks_back = problem_.request.limits.turns() || problem_.request.judges_pairs();
    if (state == kit::SearchState::cell_and_heading && looks_back) {
      return run_by_heading({});
    }
    Search<CellGraph>& search = by_cell_->search;
    PlanStatus status = search.plan(watch, max_list_bytes<CellGraph>(0), longest_repair());
    if (search.is_put_off()) {
      const Counters spent = kit::counters(search.progress(), lattice_, legs_.rules());
      if (auto afresh = afresh_.plan(spent, max_list_bytes<CellGraph>(0))) {
        return *std::move(afresh);
      }
      status = search.go_on(kNoLimit);
    }
    if (!afresh_.is_known()) {
      afresh_.remember(search.progress().expanded);
    }
    if (status != PlanStatus::solved) {
      return without_route(by_cell_->search, status);
    }
    const Polyline route = route_over(*by_cell_);
    const std::string broken =
        looks_back || legs_.judges() ? first_broken(route, problem_.request) : "";
    if (broken.empty()) {
      return with_route(by_cell_->search, route);
    }
    PlanResult result = without_route(by_cell_->search, PlanStatus::no_route);
    result.proved = false;
    result.message = "the shortest route over cells does not keep " + broken;
    return state == kit::SearchState::parent ? result : run_by_heading(result);
  }

 private:
  static constexpr std::uint64_t kNoLimit = Afresh::kNoLimit;

  std::uint64_t longest_repair() const {
    const bool by_cells_alone = !within_ && !legs_.judges() && !has_ground_;
    const std::size_t bytes = bytes_of<CellGraph>() + Afresh::bytes(lattice_);
    return by_cells_alone && bytes <= problem_.settings.max_bytes ? afresh_.longest_repair()
                                                                  : kNoLimit;
  }

  template <class Visit>
  void for_each_search(const Visit& visit) {
    visit(*by_cell_);
    if (by_heading_) {
      visit(*by_heading_);
    }
  }

  template <class Graph>
  void begin(std::optional<Incremental<Graph>>& at) {
    at.emplace(problem_, legs_, *bits_, pools_);
    find_start(*at);
    at->graph.find_goal(within_);
    at->search.initialize();
  }

  template <class Graph>
  bool find_start(Incremental<Graph>& at) {
    const Vec3& start = problem_.request.start.position;
    const std::vector<kit::Lattice::Link> links = lattice_.links(start);
    const bool goes_on = at.search.move_start(
        links.empty() ? std::vector<kit::Lattice::Link>{lattice_.nearest(start)} : links);
    if constexpr (Graph::kPerCell > 1) {
      std::vector<std::uint32_t> first;
      at.graph.for_each_first([&](std::uint32_t s) { first.push_back(s); });
      at.graph.find_start({});
      for (const std::uint32_t s : first) {
        at.search.remove(s);
      }
    }
    at.graph.find_start(links);
    if constexpr (Graph::kPerCell > 1) {
      at.graph.for_each_first([&](std::uint32_t s) { at.search.touch(s); });
    }
    return goes_on;
  }

  template <class Graph>
  void touch(Incremental<Graph>& at, const Cell& c) {
    at.graph.for_each_at(c, [&](std::uint32_t s) { at.search.touch(s); });
  }

  bool take_cells(const std::vector<Cell>& changed) {
    if (too_many(changed.size())) {
      return false;
    }
    for_each_search([&](auto& at) {
      at.graph.find_goal(within_);
      constexpr std::size_t kAhead = 8;
      for (std::size_t n = 0; n < changed.size(); ++n) {
        if (n + kAhead < changed.size()) {
          fetch(at, changed[n + kAhead]);
        }
        take_cell(at, changed[n]);
      }
      at.search.initialize();
    });
    return true;
  }
  /// Prefetches what a changed cell will need: cells change anywhere.
  template <class Graph>
  void fetch(const Incremental<Graph>& at, const Cell& c) const {
    if (at.search.vertices().opened_around(c) != 0) {
      const std::uint32_t s = lattice_.index(c);
      for (int row = 0; row < 9; ++row) {
        const auto beside = std::uint32_t(s + lattice_.stride(3 * row + 1));
        if (beside < lattice_.size()) {
          at.search.vertices().fetch(beside * Graph::kPerCell);
        }
      }
    }
  }
  /// True if planning anew, which respects the budget, is better than examining that many cells.
  bool too_many(std::size_t cells) const {
    return cells > (1 << 18) && cells > lattice_.size() / 8;
  }

  /// Updates a cell that has become blocked or free.
  template <class Graph>
  void take_cell(Incremental<Graph>& at, const Cell& c) {
    if (at.search.vertices().opened_around(c) == 0) {
      return;
    }
    if (grid_->blocked(c)) {
      at.graph.for_each_at(c, [&](std::uint32_t s) { at.search.remove(s); });
    }
    if (problem_.settings.corner == kit::CornerRule::free_box) {  // legs past its corners
      around(c, lattice_).for_each([&](const Cell& s) { touch(at, s); });
    } else if (!grid_->blocked(c)) {
      touch(at, c);
    }
  }

  /// The cells at both ends of the legs that the contents of the box may block.
  CellRange cells_near(const Box& box) const {
    const Request& request = problem_.request;
    const double near = std::max(request.limits.min_clearance, request.vehicle.reach_m()) + slack_ +
                        kLengthTolerance;
    Box grown = box.grown(near);
    if (has_ground_) {  // cells above have another ground below them
      grown.min.z() = -kInfinity;
      grown.max.z() = kInfinity;
    }
    return cells_in(grown, lattice_);
  }
  bool take_legs(std::span<const Change> changes) {
    std::size_t cells = 0;
    for (const Change& change : changes) {
      cells += cells_near(change.box).count();
    }
    if (too_many(cells)) {
      return false;
    }
    for (const Change& change : changes) {
      cells_near(change.box).for_each([&](const Cell& c) { legs_.forget(lattice_.index(c)); });
    }
    for_each_search([&](auto& at) {
      at.graph.find_goal(within_);
      for (const Change& change : changes) {
        cells_near(change.box).for_each([&](const Cell& c) {
          if (at.search.vertices().opened_around(c) != 0) {
            touch(at, c);
          }
        });
      }
      at.search.initialize();
    });
    return true;
  }

  /// Memory left for the lists of a search, after other uses.
  template <class Graph>
  std::size_t max_list_bytes(std::size_t others) const {
    const std::size_t fixed = others + bytes_of<Graph>();
    return problem_.settings.max_bytes - std::min(problem_.settings.max_bytes, fixed);
  }
  template <class Graph>
  std::size_t bytes_of() const {
    return lattice_.size() * (Graph::kPerCell * sizeof(std::uint64_t) + 1 +
                              (legs_.judges() ? LegMemory::kBytesPerCell : 0));
  }

  PlanResult run_by_heading(PlanResult by_cell) {
    const std::size_t others = by_cell.counters.empty() ? 0 : bytes_of<CellGraph>();
    if (others + bytes_of<HeadingGraph>() > problem_.settings.max_bytes ||
        lattice_.size() > (kNever - 1) / HeadingGraph::kPerCell) {
      const std::string why = "the memory allowed is too little for a search by cell and heading";
      if (by_cell.counters.empty()) {  // nothing was searched
        by_cell.status = PlanStatus::timed_out;
        by_cell.budget_hit = true;
        by_cell.message = why;
        by_cell.counters = {{"expanded", 0}};
      } else {
        by_cell.message += "; " + why;
      }
      return by_cell;
    }
    if (!by_heading_) {
      begin(by_heading_);
    }
    Budget rest = problem_.request.budget;
    if (rest.max_iterations != ~std::uint64_t{0} && !by_cell.counters.empty()) {
      rest.max_iterations -= std::uint64_t(by_cell.counters.front().value);
    }
    BudgetWatch watch(rest);
    const PlanStatus status =
        by_heading_->search.plan(watch, max_list_bytes<HeadingGraph>(others), kNoLimit);
    PlanResult result = status == PlanStatus::solved
                            ? with_route(by_heading_->search, route_over(*by_heading_))
                            : without_route(by_heading_->search, status);
    result.message += "; searched by cell and heading";
    if (!by_cell.counters.empty()) {
      kit::add(result.counters, by_cell.counters);
    }
    return result;
  }

  template <class Graph>
  Polyline route_over(const Incremental<Graph>& at) const {
    const Request& request = problem_.request;
    Polyline route = {request.start.position};
    bool at_start = lattice_.nearest(request.start.position).length == 0;
    for (const std::uint32_t node : at.search.way()) {
      if (!at_start) {
        route.push_back(lattice_.position(at.graph.cell(node)));
      }
      at_start = false;
    }
    if (!within_) {
      kit::end_at_goal(route, request.goal.position,
                       lattice_.nearest(request.goal.position).length == 0);
    }
    return route;
  }

  template <class Graph>
  PlanResult with_route(const Search<Graph>& search, const Polyline& route) {
    const double allowed = problem_.request.limits.max_route_length;
    if (const double shortest = length(route); shortest > allowed + kLengthTolerance) {
      PlanResult result = without_route(search, PlanStatus::no_route);
      result.message = "no route: the shortest has " + std::to_string(shortest) +
                       " m, route_length allows " + std::to_string(allowed) + " m";
      return result;
    }
    return kit::solved(route, search.progress(), lattice_, legs_.rules());
  }

  template <class Graph>
  PlanResult without_route(const Search<Graph>& search, PlanStatus status) {
    if (status == PlanStatus::no_route) {  // counts the reasons for rejected moves
      search.vertices().for_each_opened([&](const Cell& c) { legs_.rules().out_of(c); });
    }
    PlanResult result;
    result.status = status;
    result.budget_hit = status != PlanStatus::no_route;
    result.proved = status == PlanStatus::no_route;
    result.message = explanation(status, search.progress(), problem_, legs_.rules()) +
                     legs_.rules().sharp_turns();
    result.counters = kit::counters(search.progress(), lattice_, legs_.rules());
    return result;
  }

  kit::Lattice lattice_;
  kit::StepCosts costs_;
  Problem problem_;
  Pools& pools_;
  kit::ScratchPool<LegMemory>::Lease leg_memory_;
  Legs legs_;
  std::shared_ptr<const VoxelGrid> grid_;  ///< with moves by cells: the blocked cells
  std::shared_ptr<const VoxelGrid> bits_;  ///< for its layout
  bool has_ground_;
  double last_slack_;  ///< over-approximation of the world
  double slack_ = 0;   ///< maximum of the current one and the previous one
  bool within_;
  Afresh afresh_;
  std::optional<Incremental<CellGraph>> by_cell_;
  std::optional<Incremental<HeadingGraph>> by_heading_;
};
}  // namespace altiplan::dstar_lite
