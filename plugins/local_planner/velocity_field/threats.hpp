// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "altiplan/local_planner.hpp"
#include "field.hpp"

namespace velocity_field {

/// The discs of a world, indexed by position: a grid whose cells list the discs that reach into
/// them. The cost of a query depends on the number of nearby discs, not on the total.
class Threats {
 public:
  Threats() = default;
  /// Discs act as far as `reach` from their edges.
  Threats(std::vector<Disc> discs, double reach);

  const std::vector<Disc>& all() const { return discs_; }
  double reach() const { return reach_; }
  /// Indices of discs that include all that act at p; ascending.
  std::span<const std::uint32_t> near(const Vec2& p) const;
  /// True if the circles of two discs overlap; touching does not count.
  bool overlap(std::uint32_t i, std::uint32_t j) const {
    const double touch = discs_[i].radius + discs_[j].radius;
    return (discs_[i].centre - discs_[j].centre).squaredNorm() < touch * touch;
  }
  /// True if another disc overlaps this one.
  bool has_partner(std::uint32_t disc) const;

 private:
  void choose_cells();
  void list_discs();
  /// The first and last column (axis 0) or row (axis 1) that the disc grown by `by` touches.
  std::pair<int, int> span_of(const Disc& disc, double by, int axis) const;
  /// Calls `call` with each cell that the disc grown by `by` touches, until a call returns true.
  template <class Call>
  bool any_cell(const Disc& disc, double by, const Call& call) const;

  std::vector<Disc> discs_;
  double reach_ = 0;
  Vec2 low_{0, 0};
  double side_ = 1;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint32_t> cells_from_;  ///< one entry per cell, plus one
  std::vector<std::uint32_t> cells_;
};

/// Tracks the observed changes of the known world's threats.
class ThreatFeed {
 public:
  /// Radii are grown by `room`, the required clearance.
  ThreatFeed(const altiplan::Request& request, double reach);
  /// Adopts an observation; returns true if threats were added, removed or moved, or the goal was.
  /// Allocates only then.
  bool update(const altiplan::Observation& seen);
  const Threats& threats() const { return threats_; }
  double room() const { return room_; }

 private:
  bool is_as_before(const altiplan::World& world) const;
  void load(const altiplan::World& world);

  double room_;
  double reach_;
  altiplan::Vec3 goal_;
  const altiplan::World* world_ = nullptr;  ///< only for comparison
  std::uint64_t revision_ = 0;
  std::vector<std::shared_ptr<const altiplan::Environment>> layers_;
  Threats threats_;
};
}  // namespace velocity_field
