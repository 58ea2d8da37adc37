// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/kit/colony/pheromone.hpp"
#include "altiplan/kit/lattice/lattice.hpp"
#include "altiplan/kit/lattice/lattice_params.hpp"
#include "altiplan/kit/lattice/move_rules.hpp"
#include "altiplan/objective.hpp"
#include "altiplan/planner.hpp"

/// \file Common parts of ant colonies on the cells of a level. M. Dorigo, V. Maniezzo, A. Colorni:
/// Ant System: Optimization by a Colony of Cooperating Agents. IEEE Transactions on Systems, Man,
/// and Cybernetics B 26(1), 1996, doi:10.1109/3477.484436; as of paper 004.
namespace altiplan::kit {

struct ALTIPLAN_API ColonyParams : LatticeParams {
  int ants = 100;
  int iterations = 100;
  double deposit_q = 2000;
  double initial_pheromone = 2;
  double alpha = 6;
  double beta = 3;
  double evaporation = 0.6;
  AutoNumber max_length_m;

  void describe(Fields& f);
};

/// One bit per cell of a level, padded at both ends for the neighbours of the first and the last
/// cell.
class CellBits {
 public:
  void reset(int columns, std::size_t cells) {
    spare_ = std::size_t(columns) + 1;
    bytes_.assign((cells + 2 * spare_) / 8 + sizeof(std::uint32_t), 0);
  }
  bool test(std::uint32_t cell) const {
    const std::size_t bit = cell + spare_;
    return (bytes_[bit / 8] >> bit % 8 & 1) != 0;
  }
  void set(std::uint32_t cell) {
    const std::size_t bit = cell + spare_;
    bytes_[bit / 8] = std::uint8_t(bytes_[bit / 8] | 1U << bit % 8);
  }
  void clear(std::uint32_t cell) {
    const std::size_t bit = cell + spare_;
    bytes_[bit / 8] = std::uint8_t(bytes_[bit / 8] & ~(1U << bit % 8));
  }
  /// Bits of the eight neighbours of a cell, west first, from the row south of it on. At the edge
  /// of the level some belong to other cells.
  unsigned around(std::uint32_t cell) const {
    const std::size_t south = cell;  // and west, with the spare bits
    const std::size_t columns = spare_ - 1;
    const unsigned beside = three_at(south + columns);
    return three_at(south) | (beside & 1) << 3 | (beside & 4) << 2 |
           three_at(south + 2 * columns) << 5;
  }

 private:
  unsigned three_at(std::size_t bit) const {
    std::uint16_t window = 0;
    std::memcpy(&window, bytes_.data() + bit / 8, sizeof(window));
    return unsigned(window >> bit % 8) & 7;
  }

  std::size_t spare_ = 0;
  std::vector<std::uint8_t> bytes_;
};

class Crew;

/// One plan by a colony: ants walk from the start to the goal independently, and deposit pheromone
/// when all have returned. The result does not depend on the number of threads: every ant has its
/// own random stream, and the ants are evaluated in order.
///
/// An iteration of the budget is a step of an ant.
class ALTIPLAN_API Colony {
 public:
  virtual ~Colony();
  PlanResult run();

 protected:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  // On its own cache lines: threads write to it at every step.
  struct alignas(128) Ant {
    enum class End { arrived, stuck, too_long, stopped };
    std::vector<std::uint32_t> way;     ///< cells, from the start's on
    std::vector<std::uint32_t> places;  ///< where pheromone is deposited, from `bring_home`
    double length = 0;                  ///< length of the route in metres, ends included
    double cost = 0;                    ///< by the request's objective; of who has arrived
    End end = End::stopped;
    std::uint64_t steps = 0;
  };
  /// Working memory of one thread.
  struct alignas(128) Walker {
    Walker(const Request& request, const Lattice& lattice)
        : rules(request, lattice, MoveCheck::cells, CornerRule::free_box), watch(request.budget) {}
    Ant* ant = nullptr;
    RandomStream random;
    CellBits visited;
    MoveRules rules;
    BudgetWatch watch;
  };
  struct Step {
    std::uint32_t to = kNone;  ///< kNone: the ant is stuck
    double metres = 0;
  };

  /// All arguments must outlive the colony.
  Colony(const Request& request, const ColonyParams& params, const Lattice& lattice);

  /// Walks the walker's ant: calls `follow`.
  virtual void walk(Walker& walker) const = 0;
  /// For an ant that has arrived: may shorten its path, lists its places, and sets its length.
  virtual void bring_home(Walker& walker) const = 0;
  /// Deposits `amount` on each place of an ant. Evaporation has been applied.
  virtual void lay(const Ant& ant, double amount) = 0;
  virtual void evaporate() = 0;
  /// Called after all deposits.
  virtual void settle() = 0;

  /// Steps by `choose(cell)` until the ant arrives or dies.
  template <class Choose>
  void follow(Walker& walker, const Choose& choose) const;

  /// True if the cells alone decide on a leg; else `keeps_rules` must be called too.
  bool cells_decide() const { return cells_decide_; }
  /// True if the walker's ant may move to the cell by the constraints beyond the cells.
  bool keeps_rules(Walker& walker, std::uint32_t to) const;
  /// The same for the leg between two cells of its path, including one back along it.
  bool keeps_rules(Walker& walker, std::size_t from, std::size_t to) const;

  Vec3 position(std::uint32_t cell) const { return lattice_.position(lattice_.cell(cell)); }
  std::uint32_t columns() const { return std::uint32_t(lattice_.spec().counts[0]); }
  double length_of(const std::vector<std::uint32_t>& way) const;
  /// Cost of the straight leg between two cells, by the request's objective.
  double cost_between(std::uint32_t from, std::uint32_t to) const {
    return cost_of(Leg::straight(position(from), position(to)), request_);
  }

  const Request& request_;
  const ColonyParams& params_;
  const Lattice& lattice_;
  std::shared_ptr<const VoxelGrid> grid_;
  std::uint32_t start_ = kNone;
  std::uint32_t goal_ = kNone;

 private:
  struct Iteration {
    double mean = 0;          ///< cost of those that arrived
    double best = kInfinity;  ///< cost so far
  };
  void join_ends();
  std::optional<PlanResult> without_ants();
  bool send_out(Crew& crew, std::size_t iteration);
  void send_out(Walker& walker, std::size_t iteration);
  bool collect();
  void note_iteration();
  void lay_all();
  bool ends_well(Walker& walker) const;
  void price(Ant& ant) const;
  std::optional<Approach> before(const Ant& ant, std::size_t place) const;
  Polyline route_of(const Ant& ant) const;
  PlanResult result() const;
  std::string reason() const;

  double start_link_ = 0;  ///< metres between the ends of the route and their cells
  double goal_link_ = 0;
  double longest_ = kInfinity;
  bool cells_decide_ = false;
  std::vector<Walker> walkers_;
  std::vector<Ant> ants_;
  std::atomic<std::size_t> next_ant_{0};
  std::atomic<std::uint64_t> walked_{0};  ///< steps of this iteration's returned ants
  std::atomic<bool> stopped_{false};
  std::atomic<bool> cancelled_{false};
  std::uint64_t max_steps_ = 0;  ///< per ant in this iteration
  std::uint64_t expanded_ = 0;
  /// Refused moves of the first ant only: the assignment of ants to walkers is not deterministic.
  std::string first_refused_;
  std::vector<Iteration> past_;
  double metres_per_cost_ = 0;  ///< of the first ants that arrived together; 0: none has
  Ant best_;
  std::size_t alive_ = 0;  ///< in the last iteration
  std::size_t stuck_ = 0;
  std::size_t too_long_ = 0;
  std::int64_t traced_ = 0;
};

template <class Choose>
void Colony::follow(Walker& walker, const Choose& choose) const {
  Ant& ant = *walker.ant;
  ant.way.assign(1, start_);
  ant.length = start_link_ + goal_link_;
  ant.steps = 0;
  walker.visited.set(start_);
  for (std::uint32_t at = start_;;) {
    if (ant.steps >= max_steps_ || walker.watch.spent(0)) {
      ant.end = Ant::End::stopped;
      break;
    }
    const Step step = choose(at);
    if (step.to == kNone) {
      ant.end = Ant::End::stuck;
      break;
    }
    ++ant.steps;
    ant.length += step.metres;
    if (ant.length > longest_) {
      ant.end = Ant::End::too_long;
      break;
    }
    at = step.to;
    ant.way.push_back(at);
    walker.visited.set(at);
    if (at == goal_) {
      ant.end = ends_well(walker) ? Ant::End::arrived : Ant::End::stuck;
      break;
    }
  }
  for (const std::uint32_t cell : ant.way) {
    walker.visited.clear(cell);
  }
}

/// Common part of the planners that use a colony.
class ALTIPLAN_API ColonyPlanner : public Planner {
 protected:
  /// `params` must outlive the planner; `bytes_per_cell` is the memory of its colony.
  ColonyPlanner(const char* name, const ColonyParams& params, std::size_t bytes_per_cell)
      : name_(name), params_(params), bytes_per_cell_(bytes_per_cell) {}

 private:
  /// Searches a lattice of one level.
  virtual PlanResult search(const Request& request, const Lattice& lattice) const = 0;
  PlanResult do_plan(const Request& request) const final;
  Traits do_traits() const final;

  const char* name_;
  const ColonyParams& params_;
  std::size_t bytes_per_cell_;
};
}  // namespace altiplan::kit
