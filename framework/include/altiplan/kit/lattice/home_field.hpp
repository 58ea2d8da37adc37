// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "altiplan/energy.hpp"
#include "altiplan/kit/lattice/lattice.hpp"
#include "altiplan/kit/zero_memory.hpp"

namespace altiplan::kit {

/// What the best way home takes, from everywhere: one search backward from home over the steps of a
/// lattice (E. W. Dijkstra, A Note on Two Problems in Connexion with Graphs, 1959), by time or by
/// energy, in wind, with its climbs and descents.
///
/// What it says is never less than what a way home takes that can be flown: every step and link of
/// one is a leg that leg_ok accepts for the way home's limits, and its cost is rounded up, by 1e-9
/// of four times the way through the whole lattice. It may say more, and infinite where a lattice
/// of smaller cells has a way. So a route that keeps a limit with it has a way home that keeps it.
class ALTIPLAN_API HomeField {
 public:
  /// Cells may take so much.
  static constexpr LatticeMemory kMemory{std::size_t{4} << 30, sizeof(std::int32_t)};
  /// Cost of a straight leg; it depends on the heights of its ends and the way between them alone.
  using LegCost = std::function<double(const Vec3& from, const Vec3& to)>;

  /// Wh of flight at the vehicle's speeds and in the request's wind. Throws Error for a vehicle
  /// whose speed depends on the place (speed_near).
  static LegCost energy(const Request& request, std::shared_ptr<const Power> power);

  /// Obstacles, ground, heights, slopes and constraints are those of the request; a way home has no
  /// limits on turns and lengths. `homes`, at least one: where it may end.
  HomeField(const Request& request, const std::vector<Vec3>& homes, const Vec3& cell_m,
            LegCost cost);

  const Lattice& lattice() const { return lattice_; }
  /// From the middle of a cell; infinite where no way leads home.
  double at(const Cell& c) const {
    const std::int32_t left = lefts()[index(c)];
    return left == 0 ? kInfinity : (kLongest - left) * quantum_;
  }
  /// From anywhere: straight home, or by a link to the lattice, which alone is asked where it takes
  /// no more than `enough`.
  double from(const Vec3& p, double enough = 0) const;

 private:
  static constexpr std::int32_t kLongest = 1 << 30;  ///< of all ways, in quanta
  struct Moves;
  using Way = std::pair<double, Vec3>;  ///< what it takes, and where its first leg leads
  double best_of(const Vec3& p, std::vector<Way> ways, double other) const;
  /// Columns of cells lie together, within a border: what is one step from a cell is near it in
  /// memory.
  std::uint32_t index(const Cell& c) const {
    return numbers_.index({c[2] + 1, c[0] + 1, c[1] + 1});
  }
  std::int32_t* lefts() const { return static_cast<std::int32_t*>(memory_.data()); }
  std::vector<Moves> moves_by_level(DirectionMask steps);
  void close_border();
  void search();

  Request request_;
  std::vector<Vec3> homes_;
  LegCost cost_;
  Lattice lattice_;
  CellIndex numbers_;  ///< by level, east, north
  double quantum_ = 1;
  /// By cell, how much shorter than the longest way home its best one is; 0: none is known.
  ZeroMemory memory_;
};
}  // namespace altiplan::kit
