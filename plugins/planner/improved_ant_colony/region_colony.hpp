// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <vector>

#include "altiplan/kit/colony/colony.hpp"
#include "altiplan/kit/lattice/line_of_sight.hpp"
#include "geodesic.hpp"
#include "neighbourhood.hpp"
#include "settings.hpp"

namespace altiplan::improved_ant_colony {

/// A colony whose pheromone lies on cells and counts in the region around them.
class RegionColony final : public kit::Colony {
 public:
  static constexpr std::size_t kMaxCandidates = 56;
  static constexpr int kSightBits = 12;

  static constexpr std::size_t kBytesPerCell =
      sizeof(double) + 16 + 2 * sizeof(std::uint32_t) + kMaxCandidates + 1;

  /// A candidate cell as an ant evaluates it.
  struct Place {
    double weight;   ///< tau^alpha eta^beta
    float distance;  ///< to the goal, metres: 1 / eta
  };
  /// Persists between plans.
  struct Memory {
    kit::Pheromone tau_equ;  ///< of regions, eq. (10): sums of amounts evaporate as these do
    std::vector<Place> places;
    std::vector<std::uint8_t> candidates;  ///< by cell: their number plus one, then the candidates
    kit::Deposits<float> laid;             ///< on cells
    std::vector<std::uint32_t> weighed;    ///< by cell: iteration of the last weighing
    std::vector<std::uint64_t> sights;     ///< legs and, in the last bit, 1 if they are free
    kit::BucketQueue open;
  };

  RegionColony(const Request& request, const kit::ColonyParams& params, const Settings& settings,
               const kit::Lattice& lattice, Memory& memory)
      : Colony(request, params, lattice),
        settings_(settings),
        memory_(memory),
        offsets_(ring(settings.reach, settings.spacing)),
        strides_of_rounds_(settings.trim.strides()),
        tau_alpha_(params.alpha),
        distance_beta_(params.beta) {
    for (std::size_t k = 0; k < offsets_.size(); ++k) {
      const auto [x, y] = offsets_[k];
      strides_[k] = std::uint32_t(y * int(columns()) + x);
      metres_[k] = std::hypot(x * edge().x(), y * edge().y());
    }
    double whole = 0;
    for (int m = 0; m <= settings.region_radius; ++m) {
      shares_.push_back(std::pow(settings.region_decay, m));
      whole += shares_.back() * (m == 0 ? 1 : 8 * m);
    }
    for (double& share : shares_) {
      share /= whole;
    }
    memory.tau_equ.reset(lattice.size(), params.evaporation, params.alpha);
    memory.laid.reset(lattice.size());
    memory.sights.assign(std::size_t{1} << kSightBits, ~std::uint64_t{0});
    memory.weighed.assign(lattice.size(), 0);
    rows_in_reach_ = std::uint32_t(settings.reach) * (columns() + 1);
    measure_distances();
    if (settings.leg_test == LegTest::remembered) {
      memory.candidates.assign(lattice.size() * (offsets_.size() + 1), 0);
    }
  }

 private:
  const Vec3& edge() const { return lattice_.spec().cell; }

  // --- Candidates ------------------------------------------------------------------------------

  /// The candidates with a free straight leg, nearest to the goal first.
  struct Candidates {
    const std::uint8_t* k = nullptr;
    std::size_t count = 0;
    std::array<std::uint8_t, kMaxCandidates> own;  ///< storage if not remembered
  };

  /// Built once per cell if legs are remembered. While one thread builds a cell's list, others
  /// build the same list for themselves.
  void list_candidates(std::uint32_t cell, Candidates& all) const {
    if (settings_.leg_test != LegTest::remembered) {
      find_candidates(cell, all);
      return;
    }
    constexpr std::uint8_t kBeingMade = 255;
    std::uint8_t* const kept = memory_.candidates.data() + cell * (offsets_.size() + 1);
    const std::atomic_ref<std::uint8_t> state(kept[0]);
    std::uint8_t known = state.load(std::memory_order_acquire);
    if (known != 0 && known != kBeingMade) {
      all.k = kept + 1;
      all.count = std::size_t(known) - 1;
      return;
    }
    find_candidates(cell, all);
    if (known == 0 && state.compare_exchange_strong(known, kBeingMade, std::memory_order_relaxed)) {
      std::copy_n(all.own.begin(), all.count, kept + 1);
      state.store(std::uint8_t(all.count + 1), std::memory_order_release);
    }
  }

  [[gnu::noinline]] void find_candidates(std::uint32_t cell, Candidates& all) const {
    all.k = all.own.data();
    all.count = 0;
    const Cell here = lattice_.cell(cell);
    const bool guarded = settings_.leg_test == LegTest::always || in_guard_zone(here);
    for (std::size_t k = 0; k < offsets_.size(); ++k) {
      const Cell there = {here[0] + offsets_[k][0], here[1] + offsets_[k][1], 0};
      if (lattice_.spec().holds(there) &&
          (!guarded || kit::level_line_of_sight(*grid_, here, there)) &&
          (!request_.objective || cost_between(cell, cell + strides_[k]) < kInfinity)) {
        all.own[all.count++] = std::uint8_t(k);
      }
    }
    const auto distance = [&](std::uint8_t k) {
      return memory_.places[cell + strides_[k]].distance;
    };
    std::sort(all.own.begin(), all.own.begin() + std::ptrdiff_t(all.count),
              [&](std::uint8_t k, std::uint8_t other) {
                return distance(k) != distance(other) ? distance(k) < distance(other) : k < other;
              });
  }

  /// True if a blocked cell is so near that a leg from here may hit it: the blocked cells, dilated
  /// by the reach of a step, cover this one.
  bool in_guard_zone(const Cell& here) const {
    const Cell& counts = lattice_.spec().counts;
    const int first = std::max(here[0] - settings_.reach, 0);
    const int last = std::min(here[0] + settings_.reach, counts[0] - 1);
    for (int y = std::max(here[1] - settings_.reach, 0);
         y <= std::min(here[1] + settings_.reach, counts[1] - 1); ++y) {
      if (any_blocked(first, last, y)) {
        return true;
      }
    }
    return false;
  }
  bool any_blocked(int first, int last, int y) const {
    for (int x = first; x <= last; ++x) {
      if (grid_->blocked({x, y, 0})) {
        return true;
      }
    }
    return false;
  }

  // --- The heuristic ---------------------------------------------------------------------------

  void measure_distances() {
    memory_.places.resize(lattice_.size());
    if (settings_.heuristic == Heuristic::geodesic) {
      for (Place& place : memory_.places) {
        place.distance = std::numeric_limits<float>::infinity();
      }
      if (goal_ != kNone) {
        measure_over_cells(
            lattice_, *grid_, goal_, memory_.open,
            [&](std::uint32_t cell) -> float& { return memory_.places[cell].distance; });
      }
    } else {
      for (std::uint32_t cell = 0; cell < lattice_.size(); ++cell) {
        memory_.places[cell].distance = float((position(cell) - request_.goal.position).norm());
      }
    }
    for (std::uint32_t cell = 0; cell < lattice_.size(); ++cell) {
      weigh(cell);
    }
  }

  // --- The ants --------------------------------------------------------------------------------

  void walk(Walker& walker) const override {
    follow(walker, [&](std::uint32_t at) { return choose(walker, at); });
  }

  /// The biased roulette selection among the allowed candidates whose distance is within the limit;
  /// these come first in the list.
  Step choose(Walker& walker, std::uint32_t at) const {
    if (const double metres = metres_to_goal(walker, at); metres > 0) {
      return {goal_, metres};
    }
    const auto is_allowed = [&](std::uint32_t cell) {
      return !walker.visited.test(cell) && (cells_decide() || keeps_rules(walker, cell));
    };
    Candidates all;
    list_candidates(at, all);
    while (all.count > 0 && !is_allowed(at + strides_[all.k[all.count - 1]])) {
      --all.count;
    }
    std::size_t nearest = 0;
    while (nearest < all.count && !is_allowed(at + strides_[all.k[nearest]])) {
      ++nearest;
    }
    if (nearest == all.count) {
      return {};
    }
    const auto place = [&](std::size_t n) -> const Place& {
      return memory_.places[at + strides_[all.k[n]]];
    };
    const float limit = distance_limit(place(nearest).distance, place(all.count - 1).distance);
    std::array<std::uint8_t, kMaxCandidates> entered;
    std::array<double, kMaxCandidates> up_to;
    std::size_t count = 0;
    double sum = 0;
    for (std::size_t n = nearest; n < all.count && place(n).distance <= limit; ++n) {
      if (n == nearest || is_allowed(at + strides_[all.k[n]])) {
        sum += place(n).weight;
        entered[count] = all.k[n];
        up_to[count++] = sum;
      }
    }
    if (sum == 0) {
      return {};  // no candidate leads to the goal
    }
    const double drawn = walker.random.uniform() * sum;
    std::size_t chosen = 0;
    while (up_to[chosen] <= drawn) {
      ++chosen;
    }
    const std::size_t k = entered[chosen];
    return {at + strides_[k], metres_[k]};
  }

  /// Eqs. (8) and (9): eta = 1 / distance is at least eta_min + C (eta_max - eta_min).
  float distance_limit(float nearest, float farthest) const {
    const float limit =
        nearest * farthest / (nearest + float(settings_.tilt) * (farthest - nearest));
    return limit > nearest ? limit : nearest;
  }

  /// Length of the leg to the goal if it is within reach and satisfies every constraint; else 0.
  double metres_to_goal(Walker& walker, std::uint32_t at) const {
    if (std::uint32_t(goal_ - at + rows_in_reach_) > 2 * rows_in_reach_) {
      return 0;
    }
    const Cell here = lattice_.cell(at);
    const Cell there = lattice_.cell(goal_);
    if (std::abs(there[0] - here[0]) > settings_.reach ||
        std::abs(there[1] - here[1]) > settings_.reach || !sees(at, goal_) ||
        (!cells_decide() && !keeps_rules(walker, goal_)) ||
        (request_.objective && cost_between(at, goal_) == kInfinity)) {
      return 0;
    }
    return (position(goal_) - position(at)).norm();
  }

  /// True if the straight leg between two cells is free. Ants that follow each other request the
  /// same few legs: the last results are cached, and it does not matter which thread computed them.
  bool sees(std::uint32_t from, std::uint32_t to) const {
    const std::uint64_t leg = std::uint64_t{from} << 33 | std::uint64_t{to} << 1;
    const std::size_t at = (leg * 0x9e3779b97f4a7c15ULL) >> (64 - kSightBits);
    const std::atomic_ref<std::uint64_t> kept(memory_.sights[at]);
    const std::uint64_t known = kept.load(std::memory_order_relaxed);
    if ((known | 1) == (leg | 1)) {
      return (known & 1) != 0;
    }
    const bool free = tests_free(lattice_.cell(from), lattice_.cell(to));
    kept.store(leg | (free ? 1 : 0), std::memory_order_relaxed);
    return free;
  }

  /// Most legs that trimming tests are blocked along much of their length: seven cells suffice to
  /// tell.
  bool tests_free(const Cell& a, const Cell& b) const {
    for (const int eighths : {4, 2, 6, 1, 3, 5, 7}) {
      const int x = (8 * a[0] + eighths * (b[0] - a[0]) + 4) / 8;
      const int y = (8 * a[1] + eighths * (b[1] - a[1]) + 4) / 8;
      if (grid_->blocked({x, y, 0})) {
        return false;
      }
    }
    return kit::level_line_of_sight(*grid_, a, b);
  }

  void bring_home(Walker& walker) const override {
    Ant& ant = *walker.ant;
    if (settings_.trims) {
      trim(walker);
      ant.length = length_of(ant.way);
    }
    list_places(ant);
  }

  /// Eq. (11), in rounds.
  void trim(Walker& walker) const {
    std::vector<std::uint32_t>& way = walker.ant->way;
    for (const std::size_t stride : strides_of_rounds_) {
      kit::trim(way, stride, [&](std::size_t from, std::size_t to) {
        return sees(way[from], way[to]) && (cells_decide() || keeps_rules(walker, from, to)) &&
               (!request_.objective || !is_dearer(way, from, to));
      });
    }
  }

  /// True if the straight leg costs more than the legs that it replaces.
  bool is_dearer(const std::vector<std::uint32_t>& way, std::size_t from, std::size_t to) const {
    double legs = 0;
    for (std::size_t n = from; n < to; ++n) {
      legs += cost_between(way[n], way[n + 1]);
    }
    return costs_more(cost_between(way[from], way[to]), legs);
  }

  /// Along the legs, from node to node at equal spacing.
  void list_places(Ant& ant) const {
    const double every = settings_.deposit == Deposit::resampled ? settings_.reach
                         : settings_.deposit == Deposit::cells   ? 1
                                                                 : kInfinity;
    ant.places.clear();
    for (std::size_t n = 0; n + 1 < ant.way.size(); ++n) {
      const Cell a = lattice_.cell(ant.way[n]);
      const Cell b = lattice_.cell(ant.way[n + 1]);
      const double x = b[0] - a[0];
      const double y = b[1] - a[1];
      const int parts = std::max(1, int(std::ceil(std::max(std::abs(x), std::abs(y)) / every)));
      for (int part = 0; part < parts; ++part) {
        const double share = double(part) / parts;
        const auto round = [](double place) { return int(std::floor(place + 0.5)); };
        ant.places.push_back(lattice_.index({round(a[0] + share * x), round(a[1] + share * y), 0}));
      }
    }
    ant.places.push_back(ant.way.back());
  }

  // --- The pheromone ---------------------------------------------------------------------------

  void evaporate() override { memory_.tau_equ.evaporate(); }

  void lay(const Ant& ant, double amount) override {
    for (const std::uint32_t cell : ant.places) {
      memory_.laid.lay(cell, amount);
    }
  }

  /// Adds the deposits to the regions, eq. (10), and recomputes their weights.
  void settle() override {
    for (const std::uint32_t middle : memory_.laid.places()) {
      const double amount = memory_.laid[middle];
      for_region(middle, [&](std::uint32_t cell, std::size_t ring) {
        memory_.tau_equ.lay(cell, amount * shares_[ring]);
      });
    }
    if (memory_.tau_equ.settle()) {
      for (std::uint32_t cell = 0; cell < lattice_.size(); ++cell) {
        weigh(cell);
      }
    } else {
      ++settled_;
      for (const std::uint32_t middle : memory_.laid.places()) {
        for_region(middle, [&](std::uint32_t cell, std::size_t) {
          if (memory_.weighed[cell] != settled_) {
            memory_.weighed[cell] = settled_;
            weigh(cell);
          }
        });
      }
    }
    memory_.laid.clear();
  }

  /// Calls `visit(cell, ring)` for the cells whose region contains the cell.
  template <class Visit>
  void for_region(std::uint32_t middle, const Visit& visit) const {
    const int r = settings_.region_radius;
    const Cell c = lattice_.cell(middle);
    const Cell& counts = lattice_.spec().counts;
    const int first = std::max(-r, -c[0]);
    const int last = std::min(r, counts[0] - 1 - c[0]);
    for (int dy = std::max(-r, -c[1]); dy <= std::min(r, counts[1] - 1 - c[1]); ++dy) {
      const std::uint32_t row = middle + std::uint32_t(dy * counts[0]);
      for (int dx = first; dx <= last; ++dx) {
        visit(row + std::uint32_t(dx), std::size_t(std::max(std::abs(dx), std::abs(dy))));
      }
    }
  }

  void weigh(std::uint32_t cell) {
    Place& place = memory_.places[cell];
    place.weight = tau_alpha_(memory_.tau_equ[cell]) /
                   distance_beta_(std::max(double(place.distance), 0.5 * edge().x()));
  }

  Settings settings_;
  Memory& memory_;
  std::vector<std::array<int, 2>> offsets_;  ///< of the candidates
  std::array<std::uint32_t, kMaxCandidates> strides_;
  std::array<double, kMaxCandidates> metres_;
  std::vector<std::size_t> strides_of_rounds_;
  std::vector<double> shares_;  ///< by ring, of the initial pheromone of a region
  kit::Power tau_alpha_;
  kit::Power distance_beta_;
  std::uint32_t settled_ = 0;        ///< iterations
  std::uint32_t rows_in_reach_ = 0;  ///< cells of the goal's neighbourhood differ by less
};
}  // namespace altiplan::improved_ant_colony
