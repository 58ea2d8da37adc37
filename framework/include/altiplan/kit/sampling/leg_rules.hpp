// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/request.hpp"

namespace altiplan::kit {

/// The judge's constraints for planners that check many arbitrary legs: the answers of leg_ok,
/// faster where all layers are cells of one grid and no clearance is required. (As everywhere where
/// cells decide, a layer is taken to block exactly its own cells.)
/// Belongs to one search; records the refusals.
class ALTIPLAN_API LegRules {
 public:
  /// The request must outlive this object.
  explicit LegRules(const Request& request);

  /// Same answer as leg_ok.
  bool ok(const std::optional<Approach>& before, const Vec3& a, const Vec3& b);
  bool ok(const std::optional<Approach>& before, const Leg& leg);
  /// True if a constraint depends on the point before a leg.
  bool looks_back() const { return looks_back_; }
  /// True if the leg a–b, known to be free, satisfies the constraints that depend on the point
  /// before it.
  bool follows(const Approach& before, const Vec3& a, const Vec3& b);
  /// True if a vehicle may be at p, by obstacles, ground and altitude limits.
  bool point_ok(const Vec3& p) const;

  std::int64_t checked() const { return checked_; }
  /// The constraints and layers that refused the last legs, the most frequent first:
  /// "ground_clearance (40), 'radar' (7)"; "" if nothing was refused.
  std::string refusals() const;

 private:
  enum class Answer { free, blocked, unsure };
  struct Refused {
    std::optional<Approach> before;
    Vec3 a;
    Vec3 b;
  };
  struct RefusedTurn {
    std::optional<Approach> before;
    Leg leg;
  };
  struct CellLeg;
  static constexpr std::size_t kRemembered = 64;

  bool leg_kept(const std::optional<Approach>& before, const Vec3& a, const Vec3& b) const;
  Answer by_cells(const Vec3& a, const Vec3& b) const;
  // Points and legs are in cells of the grid, from its lower corner.
  bool in_grid(const Vec3& p) const;
  bool surely_blocked(const Vec3& p) const;
  Answer by_layers(const CellLeg& leg) const;
  Answer walk(const CellLeg& leg) const;
  std::string refused_by(const RefusedTurn& leg, const Request& open) const;
  std::optional<GridSpec> cells_that_decide() const;

  const Request& request_;
  bool looks_back_;
  bool cells_alone_ = false;               ///< true if apart from the grid only the volume matters
  std::shared_ptr<const VoxelGrid> grid_;  ///< null where cells do not decide
  Vec3 per_cell_{1, 1, 1};
  Request rest_;  ///< by cells: the problem without its layers; else: with the limits that a point
                  ///< can satisfy
  std::int64_t checked_ = 0;
  std::uint64_t refused_count_ = 0;
  std::array<Refused, kRemembered> refused_;  ///< straight legs
  std::vector<RefusedTurn> refused_turns_;
  std::uint64_t refused_turn_count_ = 0;
};
}  // namespace altiplan::kit
