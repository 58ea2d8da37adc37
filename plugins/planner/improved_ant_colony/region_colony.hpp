// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <limits>
#include <vector>

#include "altiplan/kit/bucket_queue.hpp"
#include "altiplan/kit/colony.hpp"
#include "altiplan/kit/free_blocks.hpp"
#include "altiplan/kit/line_of_sight.hpp"
#include "altiplan/kit/trimming.hpp"

namespace altiplan::improved_ant_colony {

enum class LegTest { remembered, guard_zone, always };
enum class Heuristic { euclidean, geodesic };
enum class Deposit { resampled, cells, nodes };

struct Settings {
  int reach = 8;    ///< l_c
  int spacing = 2;  ///< l_s
  LegTest leg_test = LegTest::remembered;
  double tilt = 0.5;  ///< C
  int region_radius = 2;
  double region_decay = 0.5;
  Heuristic heuristic = Heuristic::euclidean;
  bool trims = true;
  kit::TrimParams trim;
  Deposit deposit = Deposit::resampled;
};

/// How many candidates a neighbourhood has; what eq. (7) means.
constexpr std::int64_t candidates(int reach, int spacing) {
  return 8 * ((std::int64_t(reach) - 1) / std::max(std::int64_t(spacing) + 1, std::int64_t{1}) + 1);
}

/// The candidates of the asynchronous neighbourhood: cells on the border of a square, on each side
/// from both corners toward the middle, and the middle.
inline std::vector<std::array<int, 2>> ring(int reach, int spacing) {
  const auto is_place = [&](int along) {
    return along == 0 || (reach - std::abs(along)) % (spacing + 1) == 0;
  };
  std::vector<std::array<int, 2>> offsets;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      if (std::max(std::abs(x), std::abs(y)) == reach && is_place(x) && is_place(y)) {
        offsets.push_back({x, y});
      }
    }
  }
  return offsets;
}

/// A colony whose pheromone lies on cells and counts around them.
class RegionColony final : public kit::Colony {
 public:
  static constexpr std::size_t kMostCandidates = 56;
  static constexpr std::size_t kBytesPerCell = 4 * sizeof(double) + sizeof(std::uint32_t);

  /// What an ant sees of a cell.
  struct Place {
    double weight;   ///< tau^alpha eta^beta
    float distance;  ///< to the goal, metres: 1 / eta
  };
  /// What outlives a plan.
  struct Memory {
    kit::Pheromone tau_equ;  ///< of regions, eq. (10): sums of amounts evaporate as these do
    std::vector<Place> places;
    std::vector<std::uint64_t> free_legs;  ///< by cell: known, and a bit a candidate
    std::vector<float> fresh;              ///< by cell: laid in this iteration
    std::vector<std::uint32_t> laid;       ///< its cells
    kit::FreeBlocks sight;
    std::vector<std::uint32_t> weighed;  ///< by cell: in which iteration
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
    memory.laid.clear();
    memory.weighed.assign(lattice.size(), 0);
    memory.fresh.assign(lattice.size(), 0.0F);
    memory.sight.prepare(grid_);
    rows_in_reach_ = std::uint32_t(settings.reach) * (columns() + 1);
    measure_distances();
    memory.free_legs.assign(lattice.size(), 0);
  }

 private:
  using Mask = std::uint64_t;  ///< of candidates

  const Vec3& edge() const { return lattice_.spec().cell; }

  // --- Candidates ------------------------------------------------------------------------------

  /// The candidates that the straight leg is free to.
  Mask free_legs(std::uint32_t cell) const {
    constexpr Mask kKnown = Mask{1} << 63;
    if (settings_.leg_test != LegTest::remembered) {
      return test_legs(cell);
    }
    // Two threads that ask at once find the same.
    const std::atomic_ref<Mask> known(memory_.free_legs[cell]);
    Mask mask = known.load(std::memory_order_relaxed);
    if (mask == 0) {
      mask = test_legs(cell) | kKnown;
      known.store(mask, std::memory_order_relaxed);
    }
    return mask & ~kKnown;
  }

  [[gnu::noinline]] Mask test_legs(std::uint32_t cell) const {
    const Cell here = lattice_.cell(cell);
    const Cell& counts = lattice_.spec().counts;
    const bool guarded = settings_.leg_test == LegTest::always || in_guard_zone(here);
    Mask mask = 0;
    for (std::size_t k = 0; k < offsets_.size(); ++k) {
      const Cell there = {here[0] + offsets_[k][0], here[1] + offsets_[k][1], 0};
      const bool inside =
          there[0] >= 0 && there[1] >= 0 && there[0] < counts[0] && there[1] < counts[1];
      if (inside && (!guarded || kit::line_of_sight(*grid_, here, there))) {
        mask |= Mask{1} << k;
      }
    }
    return mask;
  }

  /// Whether a blocked cell is so near that a leg from here may meet it: the blocked cells, dilated
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
      measure_over_cells();
    } else {
      for (std::uint32_t cell = 0; cell < lattice_.size(); ++cell) {
        memory_.places[cell].distance = float((position(cell) - request_.goal.position).norm());
      }
    }
    for (std::uint32_t cell = 0; cell < lattice_.size(); ++cell) {
      weigh(cell);
    }
  }

  /// Lengths of the shortest ways over eight neighbours, from the goal on. E. W. Dijkstra, 1959.
  void measure_over_cells() {
    for (Place& place : memory_.places) {
      place.distance = std::numeric_limits<float>::infinity();
    }
    if (goal_ == kNone) {
      return;
    }
    // Ways are whole numbers of a length of which the longest have some 4e9.
    const double unit = 1.5 * (edge().x() + edge().y()) * double(lattice_.size()) / 4e9;
    memory_.open.clear();
    memory_.open.push(0, goal_, 0);
    while (!memory_.open.empty()) {
      const kit::BucketQueue::Entry nearest = memory_.open.pop();
      float& distance = memory_.places[nearest.node].distance;
      if (distance < std::numeric_limits<float>::infinity()) {
        continue;
      }
      distance = float(nearest.key * unit);
      const Cell here = lattice_.cell(nearest.node);
      kit::DirectionMask open =
          lattice_.steps() & lattice_.inside(here) &
          kit::free_steps(kit::blocked_around(*grid_, here), kit::CornerRule::free_box);
      for (; open != 0; open &= open - 1) {
        const int d = std::countr_zero(open);
        const auto there = std::uint32_t(nearest.node + lattice_.stride(d));
        const auto metres = std::uint32_t(std::lround(lattice_.step_length(d) / unit));
        if (memory_.places[there].distance == std::numeric_limits<float>::infinity()) {
          memory_.open.push(nearest.key + metres, there, 0);
        }
      }
    }
  }

  // --- The ants --------------------------------------------------------------------------------

  void walk(Walker& walker) const override {
    follow(walker, [&](std::uint32_t at) { return choose(walker, at); });
  }

  /// The biased roulette. What decides between candidates is taken without branches: which of them
  /// enter is as good as random, and each wrong guess of the processor costs as much as a few of
  /// them.
  Step choose(Walker& walker, std::uint32_t at) const {
    if (const double metres = metres_to_goal(walker, at); metres > 0) {
      return {goal_, metres};
    }
    std::array<std::uint8_t, kMostCandidates> candidate;
    std::array<float, kMostCandidates> distance;
    std::size_t count = 0;
    float nearest = std::numeric_limits<float>::infinity();
    float farthest = 0;
    for (Mask mask = free_legs(at); mask != 0; mask &= mask - 1) {
      const auto k = std::size_t(std::countr_zero(mask));
      const std::uint32_t cell = at + strides_[k];
      if (walker.visited.test(cell) || (!cells_decide() && !keeps_rules(walker, cell))) {
        continue;
      }
      const float there = memory_.places[cell].distance;
      candidate[count] = std::uint8_t(k);
      distance[count++] = there;
      nearest = std::min(nearest, there);
      farthest = std::max(farthest, there);
    }
    if (nearest == std::numeric_limits<float>::infinity()) {
      return {};  // no candidate, or none from which the goal can be reached
    }
    const float limit = distance_limit(nearest, farthest);
    std::array<double, kMostCandidates> up_to;
    std::size_t entered = 0;
    for (std::size_t n = 0; n < count; ++n) {
      candidate[entered] = candidate[n];
      entered += distance[n] <= limit ? 1 : 0;
    }
    double sum = 0;
    for (std::size_t n = 0; n < entered; ++n) {
      sum += memory_.places[at + strides_[candidate[n]]].weight;
      up_to[n] = sum;
    }
    const double drawn = walker.random.uniform() * sum;
    std::size_t chosen = 0;
    while (up_to[chosen] <= drawn) {
      ++chosen;
    }
    const std::size_t k = candidate[chosen];
    return {at + strides_[k], metres_[k]};
  }

  /// Eqs. (8) and (9): eta = 1 / distance is no less than eta_min + C (eta_max - eta_min).
  float distance_limit(float nearest, float farthest) const {
    const float limit =
        nearest * farthest / (nearest + float(settings_.tilt) * (farthest - nearest));
    return limit > nearest ? limit : nearest;
  }

  /// Length of the leg to the goal where that is within reach and the leg keeps every rule; else 0.
  double metres_to_goal(Walker& walker, std::uint32_t at) const {
    if (std::uint32_t(goal_ - at + rows_in_reach_) > 2 * rows_in_reach_) {
      return 0;
    }
    const Cell here = lattice_.cell(at);
    const Cell there = lattice_.cell(goal_);
    if (std::abs(there[0] - here[0]) > settings_.reach || !sees(at, goal_) ||
        (!cells_decide() && !keeps_rules(walker, goal_))) {
      return 0;
    }
    return (position(goal_) - position(at)).norm();
  }

  bool sees(std::uint32_t a, std::uint32_t b) const {
    return memory_.sight.line_of_sight(lattice_.cell(a), lattice_.cell(b));
  }

  /// Eq. (11), in rounds.
  void improve(Walker& walker) const override {
    if (!settings_.trims) {
      return;
    }
    std::vector<std::uint32_t>& way = walker.ant->way;
    for (const std::size_t stride : strides_of_rounds_) {
      kit::trim(way, stride, [&](std::size_t from, std::size_t to) {
        return sees(way[from], way[to]) && (cells_decide() || keeps_rules(walker, from, to));
      });
    }
    walker.ant->length = length_of(way);
  }

  // --- The pheromone ---------------------------------------------------------------------------

  void evaporate() override { memory_.tau_equ.evaporate(); }

  void lay(const Ant& ant, double amount) override {
    const double every = settings_.deposit == Deposit::resampled ? settings_.reach
                         : settings_.deposit == Deposit::cells   ? 1
                                                                 : kInfinity;
    for (std::size_t n = 0; n + 1 < ant.way.size(); ++n) {
      const Cell a = lattice_.cell(ant.way[n]);
      const Cell b = lattice_.cell(ant.way[n + 1]);
      const double x = b[0] - a[0];
      const double y = b[1] - a[1];
      const int parts = std::max(1, int(std::ceil(std::max(std::abs(x), std::abs(y)) / every)));
      for (int part = 0; part < parts; ++part) {
        const double share = double(part) / parts;
        lay(lattice_.index({int(a[0] + share * x + 0.5), int(a[1] + share * y + 0.5), 0}), amount);
      }
    }
    lay(ant.way.back(), amount);
  }
  void lay(std::uint32_t cell, double amount) {
    float& there = memory_.fresh[cell];
    if (there == 0) {
      memory_.laid.push_back(cell);
    }
    there += float(amount);
  }

  /// Adds what has been laid to the regions, eq. (10), and weighs them anew.
  void settle() override {
    for (const std::uint32_t middle : memory_.laid) {
      const double amount = double(memory_.fresh[middle]);
      memory_.fresh[middle] = 0;
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
      for (const std::uint32_t middle : memory_.laid) {
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

  /// Calls `visit(cell, ring)` for the cells whose region the cell is in.
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
  std::array<std::uint32_t, kMostCandidates> strides_;
  std::array<double, kMostCandidates> metres_;
  std::vector<std::size_t> strides_of_rounds_;
  std::vector<double> shares_;  ///< by ring, of the pheromone of a region at first
  kit::Power tau_alpha_;
  kit::Power distance_beta_;
  std::uint32_t settled_ = 0;        ///< iterations
  std::uint32_t rows_in_reach_ = 0;  ///< cells of the goal's neighbourhood differ by less
};
}  // namespace altiplan::improved_ant_colony
