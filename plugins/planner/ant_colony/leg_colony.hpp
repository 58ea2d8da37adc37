// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "altiplan/kit/colony/colony.hpp"

namespace altiplan::ant_colony {

enum class Heuristic { goal_scaled, goal, leg };

/// A colony whose pheromone lies on the legs between neighbouring cells, separately per direction.
class LegColony final : public kit::Colony {
 public:
  static constexpr std::size_t kNeighbours = 8;
  static constexpr std::size_t kBytesPerCell = kNeighbours * (3 * sizeof(double) + sizeof(float));

  /// Persists between plans; a leg has the index kNeighbours * cell + direction.
  struct Memory {
    kit::Pheromone tau;
    std::vector<float> eta_beta;  ///< eta^beta, 0 where the leg is closed
    std::vector<double> weights;  ///< tau^alpha eta^beta
    kit::Deposits<double> laid;
  };

  LegColony(const Request& request, const kit::ColonyParams& params, Heuristic heuristic,
            const kit::Lattice& lattice, Memory& memory)
      : Colony(request, params, lattice),
        heuristic_(heuristic),
        memory_(memory),
        tau_alpha_(params.alpha),
        eta_beta_(params.beta) {
    for (std::size_t k = 0; k < kNeighbours; ++k) {
      const int d = direction_of(k);
      metres_[k] = lattice.step_length(d);
      strides_[k] = std::int32_t(lattice.stride(d));
    }
    memory.tau.reset(kNeighbours * lattice.size(), params.evaporation, params.alpha);
    memory.laid.reset(kNeighbours * lattice.size());
    weigh_legs();
  }

 private:
  using Direction = std::size_t;  // 0 to 7, from the southern row on, west first; 7 - k is opposite

  static int direction_of(Direction k) {
    const int flat = int(k) < 4 ? int(k) : int(k) + 1;  // 4 is the cell itself
    return kit::direction(flat % 3 - 1, flat / 3 - 1, 0);
  }
  static std::size_t leg(std::uint32_t cell, Direction k) { return kNeighbours * cell + k; }
  std::uint32_t neighbour(std::uint32_t cell, Direction k) const {
    return cell + std::uint32_t(strides_[k]);
  }

  // --- The heuristic ---------------------------------------------------------------------------

  void weigh_legs() {
    memory_.eta_beta.assign(kNeighbours * lattice_.size(), 0.0F);
    memory_.weights.assign(kNeighbours * lattice_.size(), 0.0);
    const Cell counts = lattice_.spec().counts;
    const kit::DirectionMask steps = lattice_.steps();
    for (int y = 0; y < counts[1]; ++y) {
      for (int x = 0; x < counts[0]; ++x) {
        const Cell here = {x, y, 0};
        if (grid_->blocked(here)) {
          continue;
        }
        const kit::DirectionMask open =
            steps & lattice_.inside(here) &
            kit::free_steps(kit::blocked_around(*grid_, here), kit::CornerRule::free_box);
        weigh_legs(lattice_.index(here), here, priced(lattice_.index(here), open));
      }
    }
  }

  /// Without the legs that the objective has no cost for.
  kit::DirectionMask priced(std::uint32_t cell, kit::DirectionMask open) const {
    for (Direction k = 0; request_.objective && k < kNeighbours; ++k) {
      if ((open >> direction_of(k) & 1) != 0 &&
          cost_between(cell, neighbour(cell, k)) == kInfinity) {
        open &= ~(kit::DirectionMask{1} << direction_of(k));
      }
    }
    return open;
  }

  void weigh_legs(std::uint32_t cell, const Cell& here, kit::DirectionMask open) {
    const std::array<double, kNeighbours> etas = etas_at(here, open);
    for (Direction k = 0; k < kNeighbours; ++k) {
      if ((open >> direction_of(k) & 1) != 0) {
        const auto eta_beta = float(std::max(eta_beta_(etas[k]), 1e-30));
        memory_.eta_beta[leg(cell, k)] = eta_beta;
        memory_.weights[leg(cell, k)] = double(eta_beta);
      }
    }
  }

  /// Eta of the neighbours, eq. (1), in cells.
  std::array<double, kNeighbours> etas_at(const Cell& here, kit::DirectionMask open) const {
    const double edge = metres_[4];
    std::array<double, kNeighbours> etas;
    double d_min = kInfinity;
    for (Direction k = 0; k < kNeighbours; ++k) {
      const Vec3 there = lattice_.position(here) + lattice_.step(direction_of(k));
      etas[k] = heuristic_ == Heuristic::leg ? metres_[k] : (there - request_.goal.position).norm();
      if ((open >> direction_of(k) & 1) != 0) {
        d_min = std::min(d_min, etas[k]);
      }
    }
    for (double& eta : etas) {
      const double cells = (heuristic_ == Heuristic::goal_scaled ? eta - d_min + edge : eta) / edge;
      eta = 1 / std::max(cells, 0.5);  // at the goal itself an ant has no choice left
    }
    return etas;
  }

  // --- The ants --------------------------------------------------------------------------------

  void walk(Walker& walker) const override {
    follow(walker, [&](std::uint32_t at) { return choose(walker, at); });
  }

  /// Roulette selection of eq. (1) among the neighbours that the ant has not visited.
  Step choose(Walker& walker, std::uint32_t at) const {
    const double* const weights = memory_.weights.data() + leg(at, 0);
    unsigned closed = walker.visited.around(at);
    if (!cells_decide()) {
      closed |= refused_by_rules(walker, at, closed);
    }
    std::array<double, kNeighbours> up_to;
    double sum = 0;
    for (Direction k = 0; k < kNeighbours; ++k) {
      sum += (closed >> k & 1) != 0 ? 0 : weights[k];
      up_to[k] = sum;
    }
    if (sum == 0) {
      return {};
    }
    const Direction beside = toward_goal(at);
    if (beside != kNeighbours && (closed >> beside & 1) == 0 && weights[beside] > 0) {
      return {goal_, metres_[beside]};
    }
    const double drawn = walker.random.uniform() * sum;
    Direction chosen = 0;
    while (up_to[chosen] <= drawn) {
      ++chosen;
    }
    return {neighbour(at, chosen), metres_[chosen]};
  }

  /// Direction of the goal if it is a neighbour, else kNeighbours.
  Direction toward_goal(std::uint32_t at) const {
    const std::uint32_t reach = columns() + 1;
    return goal_ - at + reach <= 2 * reach ? direction_to(at, goal_) : kNeighbours;
  }
  /// On levels of one or two columns, cells in two directions share an index: only one leg is open.
  Direction direction_to(std::uint32_t from, std::uint32_t to) const {
    Direction k = 0;
    while (k < kNeighbours &&
           (strides_[k] != std::int32_t(to - from) || memory_.eta_beta[leg(from, k)] == 0)) {
      ++k;
    }
    return k;
  }

  unsigned refused_by_rules(Walker& walker, std::uint32_t at, unsigned closed) const {
    unsigned refused = 0;
    for (Direction k = 0; k < kNeighbours; ++k) {
      if ((closed >> k & 1) == 0 && memory_.weights[leg(at, k)] > 0 &&
          !keeps_rules(walker, neighbour(at, k))) {
        refused |= 1U << k;
      }
    }
    return refused;
  }

  // --- The pheromone ---------------------------------------------------------------------------

  void evaporate() override { memory_.tau.evaporate(); }

  void bring_home(Walker& walker) const override {
    Ant& ant = *walker.ant;
    ant.places.clear();
    for (std::size_t n = 1; n < ant.way.size(); ++n) {
      ant.places.push_back(
          std::uint32_t(leg(ant.way[n - 1], direction_to(ant.way[n - 1], ant.way[n]))));
    }
  }

  void lay(const Ant& ant, double amount) override {
    for (const std::uint32_t one : ant.places) {
      memory_.laid.lay(one, amount);
    }
  }

  void settle() override {
    for (const std::uint32_t one : memory_.laid.places()) {
      memory_.tau.lay(one, memory_.laid[one]);
    }
    if (memory_.tau.settle()) {
      for (std::size_t one = 0; one < memory_.weights.size(); ++one) {
        weigh(one);
      }
    } else {
      for (const std::uint32_t one : memory_.laid.places()) {
        weigh(one);
      }
    }
    memory_.laid.clear();
  }
  void weigh(std::size_t one) {
    memory_.weights[one] = tau_alpha_(memory_.tau[one]) * double(memory_.eta_beta[one]);
  }

  Heuristic heuristic_;
  Memory& memory_;
  kit::Power tau_alpha_;
  kit::Power eta_beta_;
  std::array<double, kNeighbours> metres_;
  std::array<std::int32_t, kNeighbours> strides_;
};
}  // namespace altiplan::ant_colony
