// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/home_field.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "altiplan/check.hpp"
#include "altiplan/energy.hpp"
#include "altiplan/error.hpp"
#include "altiplan/flown_route.hpp"
#include "altiplan/kit/lattice/move_rules.hpp"

namespace altiplan::kit {
namespace {

constexpr int kLanes =
    4;  // of a column: below a cell, beside it and above, and one that is not used

/// Cells by cost, in buckets that are no wider than the cheapest step: what is in the first one can
/// become no cheaper, but by steps that cost nothing, for which a bucket is emptied again (R. B.
/// Dial, Algorithm 360, 1969; E. V. Denardo, B. L. Fox, Shortest-Route Methods 1, 1979).
class Frontier {
 public:
  Frontier(std::int32_t cheapest, std::int32_t dearest)
      : shift_(cheapest > 1 ? std::bit_width(std::uint32_t(cheapest)) - 1 : 0),
        buckets_(std::bit_ceil((std::uint32_t(dearest) >> shift_) + 2)) {}

  void push(std::uint32_t cost, std::uint32_t cell) {
    buckets_[cost >> shift_ & (buckets_.size() - 1)].push_back(cell);
    ++size_;
  }
  bool empty() const { return size_ == 0; }
  std::uint32_t pop() {
    while (buckets_[first_].empty()) {
      first_ = (first_ + 1) & (buckets_.size() - 1);
    }
    const std::uint32_t cell = buckets_[first_].back();
    buckets_[first_].pop_back();
    --size_;
    return cell;
  }
  /// One that is taken out soon; `other` where none is known.
  std::uint32_t soon(std::uint32_t other) const {
    constexpr std::size_t kAhead = 6;
    const std::vector<std::uint32_t>& bucket = buckets_[first_];
    return bucket.empty() ? other : bucket[bucket.size() - std::min(bucket.size(), kAhead)];
  }

 private:
  int shift_;
  std::vector<std::vector<std::uint32_t>> buckets_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

/// A request's way home: without what limits routes as a whole, and turns.
Request way_home_request(const Request& request, const Vec3& to) {
  Request home = request;
  home.start = {};
  home.start.position = to;  // the lattice lies about it
  home.goal = {to};
  home.limits.min_leg = 0;
  home.limits.max_leg = home.limits.max_route_length = kInfinity;
  home.limits.max_turn_horizontal = home.limits.max_turn_space = kPi;
  home.limits.min_turn_radius = 0;
  home.objective = nullptr;
  home.trace = nullptr;
  std::erase_if(home.constraints,
                [](const NamedConstraint& named) { return named.constraint->admits_all(); });
  return home;
}
}  // namespace

HomeField::LegCost HomeField::energy(const Request& request, std::shared_ptr<const Power> power) {
  if (!request.vehicle.speed_near.empty()) {
    throw Error("ways home are not known of a vehicle with speed_near");
  }
  if (!request.wind.changes.empty() ||
      std::any_of(request.wind.layers.begin(), request.wind.layers.end(),
                  [](const Wind::Layer& layer) { return layer.grid != nullptr; })) {
    throw Error(
        "ways home are not known in wind that differs from place to place (wind.grid) or "
        "changes with the hour");
  }
  Request alone = request;  // with what the energy of a leg depends on
  alone.world = std::make_shared<const World>();
  alone.constraints.clear();
  return [alone, power = std::move(power)](const Vec3& a, const Vec3& b) {
    return leg_energy(Leg::straight(a, b), 0, alone, *power);
  };
}

HomeField::HomeField(const Request& request, const std::vector<Vec3>& homes, const Vec3& cell_m,
                     LegCost cost)
    : request_(way_home_request(request, homes.front())),
      homes_(homes),
      cost_(std::move(cost)),
      lattice_(request_, cell_m, Neighbourhood::all, kMemory) {
  const Cell& counts = lattice_.spec().counts;
  numbers_ = CellIndex({counts[2] + 2, counts[0] + 2, counts[1] + 2});
  memory_ = ZeroMemory((numbers_.size() + kLanes) * sizeof(std::int32_t));
  close_border();
  search();
}

/// The steps into the cells of a level, those from the cells of one column in a row; a search
/// backward takes them backward.
struct HomeField::Moves {
  static constexpr int kColumns = 9;
  alignas(16) std::array<std::int32_t, kColumns * kLanes> cost;  ///< kLongest: none

  /// Of a direction: its lane.
  static constexpr int lane(int d) {
    const Cell o = offset(d);
    return kLanes * ((o[1] + 1) * 3 + o[0] + 1) + o[2] + 1;
  }
};

std::vector<HomeField::Moves> HomeField::moves_by_level(DirectionMask steps) {
  const Cell& counts = lattice_.spec().counts;
  const auto levels = std::size_t(counts[2]);
  std::vector<std::array<double, kDirections>> legs(levels);
  double dearest = 0;
  for (int level = 0; level < counts[2]; ++level) {
    const Vec3 here = lattice_.position({0, 0, level});
    for (int d = 0; d < kDirections; ++d) {
      const bool is_step = (steps >> opposite(d) & 1) != 0;
      const double leg = is_step ? cost_(here + lattice_.step(d), here) : kInfinity;
      legs[std::size_t(level)][std::size_t(d)] = leg;
      dearest = std::isfinite(leg) ? std::max(dearest, leg) : dearest;
    }
  }
  constexpr double kDetour = 4;
  const double longest = kDetour * (counts[0] + counts[1] + counts[2]) * dearest;
  quantum_ = longest > 0 ? longest / kLongest : 1;
  std::vector<Moves> moves(legs.size());
  for (std::size_t level = 0; level < moves.size(); ++level) {
    moves[level].cost.fill(kLongest);
    for (int d = 0; d < kDirections; ++d) {
      const double leg = std::ceil(legs[level][std::size_t(d)] / quantum_);
      if (leg < kLongest) {
        moves[level].cost[std::size_t(Moves::lane(d))] = std::int32_t(leg);
      }
    }
  }
  return moves;
}

/// Nothing makes the way home from there shorter.
void HomeField::close_border() {
  const Cell& counts = lattice_.spec().counts;
  for (int y = -1; y <= counts[1]; ++y) {
    for (int x = -1; x <= counts[0]; ++x) {
      const bool is_border = x < 0 || y < 0 || x == counts[0] || y == counts[1];
      for (int z = -1; z <= counts[2]; z += is_border ? 1 : counts[2] + 1) {
        lefts()[index({x, y, z})] = kLongest;
      }
    }
  }
}

namespace {
/// The lanes in which what is left, less a move's cost, is more than is known there.
std::uint32_t better(std::int32_t left, const std::int32_t* cost, const std::int32_t* known) {
#ifdef __SSE2__
  const __m128i now =
      _mm_sub_epi32(_mm_set1_epi32(left), _mm_load_si128(reinterpret_cast<const __m128i*>(cost)));
  const __m128i before = _mm_loadu_si128(reinterpret_cast<const __m128i*>(known));
  return std::uint32_t(_mm_movemask_ps(_mm_castsi128_ps(_mm_cmpgt_epi32(now, before))));
#else
  std::uint32_t mask = 0;
  for (int i = 0; i < kLanes; ++i) {
    mask |= std::uint32_t(left - cost[i] > known[i]) << i;
  }
  return mask;
#endif
}
}  // namespace

void HomeField::search() {
  MoveRules rules(request_, lattice_, MoveCheck::exact, CornerRule::any);
  const std::vector<Moves> moves = moves_by_level(rules.steps());
  std::int32_t cheapest = kLongest;
  std::int32_t dearest = 0;
  for (const Moves& level : moves) {
    for (const std::int32_t cost : level.cost) {
      cheapest = std::min(cheapest, cost);
      dearest = cost < kLongest ? std::max(dearest, cost) : dearest;
    }
  }
  Frontier open(cheapest, dearest);
  std::int32_t* const known = lefts();
  const auto reach = [&](std::uint32_t cell, std::int32_t left) {
    if (left > known[cell]) {
      known[cell] = left;
      open.push(std::uint32_t(kLongest - left), cell);
    }
  };
  for (const Vec3& home : homes_) {
    for (const Lattice::Link& link : lattice_.links(home)) {
      const Vec3 there = lattice_.position(link.cell);
      const double leg = std::ceil(link.length > 0 ? cost_(there, home) / quantum_ : 0);
      if (leg < kLongest && leg_ok(std::nullopt, there, home, request_)) {
        reach(index(link.cell), kLongest - std::int32_t(leg));
      }
    }
  }
  std::array<std::int64_t, kDirections> strides;
  for (int d = 0; d < kDirections; ++d) {
    const Cell o = offset(d);
    strides[std::size_t(d)] = numbers_.stride(direction(o[2], o[0], o[1]));
  }
  const bool judges = !request_.constraints.empty() || request_.vehicle.body != nullptr;
  while (!open.empty()) {
    const std::uint32_t cell = open.pop();
    const std::uint32_t soon = open.soon(cell);
    for (int column = 0; column < Moves::kColumns; ++column) {
      __builtin_prefetch(known + soon + strides[std::size_t(column)]);
    }
    const std::int32_t left = known[cell];
    const auto [z, x, y] = numbers_.cell(cell);
    const Cell c{x - 1, y - 1, z - 1};
    const Moves& move = moves[std::size_t(c[2])];
    DirectionMask wanted = 0;
    for (int column = 0; column < Moves::kColumns; ++column) {
      const std::int64_t below = strides[std::size_t(column)];  // of the level below
      const std::uint32_t lanes =
          better(left, &move.cost[std::size_t(column * kLanes)], known + cell + below);
      wanted |= (lanes & 1) << column | (lanes & 2) << (column + 8) | (lanes & 4) << (column + 16);
    }
    if (wanted != 0 && !rules.all_free_around(c)) {
      wanted = rules.places_free(c, wanted, true);
    }
    for (; wanted != 0; wanted &= wanted - 1) {
      const int d = std::countr_zero(wanted);
      const Vec3 here = lattice_.position(c);
      if (!judges || rules.admits(std::nullopt, here + lattice_.step(d), here)) {
        reach(std::uint32_t(cell + strides[std::size_t(d)]),
              left - move.cost[std::size_t(Moves::lane(d))]);
      }
    }
  }
}

/// The cheapest of the ways from p that begin with a leg that may be flown; `other` if that is no
/// dearer.
double HomeField::best_of(const Vec3& p, std::vector<Way> ways, double other) const {
  std::sort(ways.begin(), ways.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [cost, to] : ways) {
    if (!(cost < other)) {
      break;
    }
    if (leg_ok(std::nullopt, p, to, request_)) {
      return cost;
    }
  }
  return other;
}

double HomeField::from(const Vec3& p, double enough) const {
  std::vector<Way> ways;
  for (const Lattice::Link& link : lattice_.links(p)) {
    const Vec3 there = lattice_.position(link.cell);
    const double rest = at(link.cell);
    ways.emplace_back(rest + (rest < kInfinity && link.length > 0 ? cost_(p, there) : 0), there);
  }
  const double over_lattice = best_of(p, ways, kInfinity);
  if (over_lattice <= enough ||
      (over_lattice == kInfinity && !leg_ok(std::nullopt, p, p, request_))) {  // it cannot be there
    return over_lattice;
  }
  ways.clear();
  for (const Vec3& home : homes_) {
    ways.emplace_back(p == home ? 0 : cost_(p, home), home);
  }
  return best_of(p, ways, over_lattice);
}
}  // namespace altiplan::kit
