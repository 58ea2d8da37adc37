// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/kit/lattice/clearance_steps.hpp"
#include "altiplan/kit/lattice/ground_steps.hpp"
#include "altiplan/kit/lattice/steps.hpp"

namespace altiplan::kit {

/// How a step of a lattice is checked against the obstacles.
enum class MoveCheck {
  exact,  ///< the straight leg, by the world's exact queries
  cells,  ///< by the cells that it crosses: cells that an obstacle overlaps are closed
};

/// Occupancy for moves by cells: the cells of the lattice that an obstacle, grown by the required
/// clearance, overlaps; the layers' own cells where the world contains nothing else and no
/// clearance is required.
ALTIPLAN_API std::shared_ptr<const VoxelGrid> occupancy(const Request& request,
                                                        const Lattice& lattice);

/// What of the request a search that knows only which cells of a level are free cannot satisfy, or
/// "": "limits on turns".
ALTIPLAN_API std::string beyond_cells(const Request& request);

/// Largest radius of a turn from one of the steps into another: their fillet radius
/// min(a, b) / (2 tan(turn / 2)) for steps of lengths a and b whose headings differ; on level
/// squares 1.207 times the edge. (Longer legs allow wider turns.)
ALTIPLAN_API double max_turn_radius(const Lattice& lattice, DirectionMask steps);

/// The judge's constraints for the steps of a lattice, sorted by what they depend on: those on the
/// direction alone (climb, leg length) or on two directions (turns) are answered from masks, those
/// on the position by few queries of the world. A step is accepted if and only if leg_ok accepts it
/// (with `cells`: and its cells are free).
/// Belongs to one search; counts the refusals per constraint.
class ALTIPLAN_API MoveRules {
 public:
  /// All arguments must outlive this object. With `cells` the occupancy is built here.
  MoveRules(const Request& request, const Lattice& lattice, MoveCheck check, CornerRule corner);

  /// True if, with moves by cells, the cells and the direction of a step alone decide: no limit
  /// depends on the ground, on two legs or on the whole route, and there are no constraints.
  static bool cells_decide(const Request& request);

  /// Directions out of c, reached by the step `in` (kHere: not by a step), that pass the checks
  /// answered from masks; they still have to pass `legs_free`.
  DirectionMask candidates(const Cell& c, int in) {
    const DirectionMask open = out_of(c);
    const DirectionMask kept = directions_of(after(in));
    refused_[by_turn] += __builtin_popcount(open & ~kept);
    return open & kept;
  }
  /// Those that pass them whatever step led to c.
  DirectionMask out_of(const Cell& c) { return beside(c, steps_); }
  /// Directions of steps into c that pass them: a reversed step passes whatever the step passes,
  /// but in wind, and where a descent may be steeper than a climb or less steep.
  DirectionMask into(const Cell& c) { return reversed(beside(c, reversed(steps_))); }
  /// Steps that may follow the step `in` by the turn limits, and steps that `out` may follow.
  StepMask after(int in) const { return after_[std::size_t(in)]; }
  StepMask before(int out) const { return before_[std::size_t(out)]; }
  /// The step in direction d after the step `in`, as numbered for `after`.
  int step_after(int in, int d) const { return headings_last_ ? kit::step_after(in, d) : d; }
  /// True if headings persist through vertical steps, and some limit depends on that.
  bool headings_last() const { return headings_last_; }
  /// True if a leg after the step has to be checked against what came before the steps: the masks
  /// know a vehicle's heading by its steps alone.
  bool is_first(int step) const {
    return step == kHere || (headings_last_ && heading_of(step) < 0);
  }
  /// The approach to a cell, at position `here`, by a step; with kHere by the link from the start,
  /// or (`at_start`) the approach to the start itself.
  std::optional<Approach> approach(int step, const Vec3& here, bool at_start) const;
  /// True if a step may be refused because of the path to its first cell, apart from the turn.
  bool looks_beyond_turns() const { return judges_pairs_; }
  /// Counts moves that blocked cells ruled out.
  void count_blocked(std::int64_t refused) { refused_[by_cells] += refused; }
  /// Counts the remaining steps that turn limits ruled out.
  void count_turns(StepMask left, StepMask kept) {
    refused_[by_turn] += __builtin_popcount(directions_of(left) & ~directions_of(kept));
  }

  /// Directions among `wanted` in which the step out of c, or `inward` the step from there into c,
  /// satisfies the constraints that depend on the position alone.
  DirectionMask places_free(const Cell& c, DirectionMask wanted, bool inward = false);
  bool place_free(const Cell& c, int d) { return places_free(c, DirectionMask{1} << d) != 0; }
  /// True if every step between two cells of the 3 x 3 x 3 around c is known to satisfy them.
  bool all_free_around(const Cell& c) {
    return !wind_varies_ && (!ground_steps_ || ground_steps_->permits_all_around(c)) &&
           (!clearance_steps_ || clearance_steps_->permits_all_around(c));
  }
  /// True if the constraints, and the vehicle's body, admit the leg after its approach.
  bool admits(const std::optional<Approach>& before, const Vec3& a, const Vec3& b) {
    return !judges_pairs_ || (constraints_admit(before, a, b) && body_fits(before, a, b));
  }
  /// Directions among `wanted` in which the step out of c, at `here`, satisfies the constraints on
  /// a leg that follows the approach.
  DirectionMask legs_free(const std::optional<Approach>& before, const Cell& c, const Vec3& here,
                          DirectionMask wanted);

  /// True if the straight leg between the centres of two cells, for a vehicle that comes from
  /// `before`, satisfies the constraints on a leg: as by leg_ok, and with moves by cells also by
  /// line_of_sight. The world is then queried for ground and constraints only, if there are any,
  /// never for obstacles: none extends into free cells.
  bool sees(const std::optional<Approach>& before, const Cell& a, const Cell& b);

  /// The checks of `sees` apart from the cells. `is_wide`: the leg is known to be free of obstacles
  /// within reach of the vehicle's body.
  bool keeps_rules(const std::optional<Approach>& before, const Vec3& a, const Vec3& b,
                   bool is_wide = false);
  /// True if the leg satisfies the limits on length, climb and the turn before it.
  bool keeps_limits(const std::optional<Approach>& before, const Vec3& a, const Vec3& b) {
    return keeps_limits(before, a, b, (b - a).norm());
  }

  /// Directions that pass the checks which depend on the direction alone.
  DirectionMask steps() const { return steps_; }
  /// The occupancy, with moves by cells; else null.
  const VoxelGrid* grid() const { return grid_.get(); }
  const std::shared_ptr<const VoxelGrid>& shared_grid() const { return grid_; }
  /// With moves by cells and a body: through its free cells the body passes in any attitude. Else
  /// null.
  const std::shared_ptr<const VoxelGrid>& wide_grid() const { return wide_grid_; }

  /// leg_ok for legs that are no steps (the links of start and goal; legs of any angle; the first
  /// step of a vehicle that has a heading), with refusals counted.
  bool any_leg_ok(const std::optional<Approach>& before, const Vec3& a, const Vec3& b);

  /// True if a check that depends on the previous leg refused anything: then one parent per cell
  /// may be too few, and finding nothing proves nothing.
  bool parent_mattered() const { return refused_[by_turn] > 0 || admit_needed_parent_; }
  std::int64_t moves_checked() const { return moves_checked_; }
  /// Bytes of what is known of the ground and the obstacles.
  std::size_t bytes() const {
    return (ground_steps_ ? ground_steps_->bytes() : 0) +
           (clearance_steps_ ? clearance_steps_->bytes() : 0);
  }
  /// True if the cell itself is closed, which only moves by cells know.
  bool cell_blocked(const Cell& c) {
    const bool blocked = grid_ != nullptr && grid_->blocked(c);
    refused_[by_cells] += blocked;
    return blocked;
  }
  /// The constraints that refused moves, the most frequent first: "ground_clearance (120),
  /// turn_angle (7)", and the directions ruled out; "" if nothing was refused.
  std::string refusals() const;
  /// Explains that no turn between two steps has the required radius: "; turns of cells of 200 m
  /// have …"; "" if some turn has.
  std::string sharp_turns() const;

 private:
  enum Rule {
    by_cells,
    by_leg_length,
    by_climb,
    by_turn,
    by_clearance,
    by_no_ground,
    by_ground,
    by_altitude,
    by_constraint,
    by_body,
    by_link,
    rule_count
  };
  /// Directions among `wanted` to cells of the lattice, by moves by cells with a free way there.
  DirectionMask beside(const Cell& c, DirectionMask wanted) {
    DirectionMask open = wanted & lattice_.inside(c);
    if (grid_ != nullptr) {
      const DirectionMask free = free_steps(blocked_around(*grid_, c), corner_);
      refused_[by_cells] += __builtin_popcount(open & ~free);
      open &= free;
    }
    return open;
  }
  bool keeps_climb(const Vec3& a, const Vec3& b) const;
  DirectionMask directions_kept();
  /// The constraint that refused the last leg that is no step.
  /// Of a step: in wind its climb through the air and its course are judged as one.
  std::string climb_rule() const;
  std::string link_refused_by() const;
  /// The height of cells whose climbing steps the climb limit would keep, if it rules some out.
  std::string lower_cells(int ruled_out) const;
  void find_turns();
  Vec3 heading_vector(int step) const;
  bool keeps_limits(const std::optional<Approach>& before, const Vec3& a, const Vec3& b,
                    double length);
  bool keeps_turn(const Approach& before, const Vec3& a, const Vec3& leg) const;
  bool keeps_ground(const Vec3& a, const Vec3& b);
  bool keeps_off(const World& layers, const Vec3& a, const Vec3& b);
  static Rule rule_of(GroundRules::Refusal refusal);
  bool constraints_admit(const std::optional<Approach>& before, const Vec3& a, const Vec3& b);
  bool body_fits(const std::optional<Approach>& before, const Vec3& a, const Vec3& b);
  void refuse_body(const std::optional<Approach>& before, const Vec3& a, const Vec3& b);
  bool body_free(const std::optional<Approach>& before, const Cell& c, int d, const Vec3& a,
                 const Vec3& b);

  const Request& request_;
  const Lattice& lattice_;
  CornerRule corner_;
  double needed_;
  double reach_;  ///< clearance in which the vehicle's body passes in any attitude
  bool asks_world_;
  struct {
    double climb = 0;
    double sink = 0;
    double turn = 0;
    double turn_space = 0;
  } cosines_;                  ///< of the limits on angles
  bool judges_pairs_ = false;  ///< by constraints, or by the vehicle's body
  std::vector<NamedConstraint> constraints_;
  std::shared_ptr<const VoxelGrid> grid_;
  std::shared_ptr<const VoxelGrid> wide_grid_;
  GroundRules ground_;
  std::optional<GroundSteps> ground_steps_;        ///< where there is ground
  std::optional<ClearanceSteps> clearance_steps_;  ///< where the world is asked for obstacles
  std::optional<ClearanceSteps> wide_steps_;       ///< the same for a body in any attitude
  /// With what the judge asks of a leg in the wind, climb and course, alone; none: nothing of it.
  std::optional<Request> in_wind_;
  bool wind_varies_ = false;  ///< and what it asks depends on the place
  DirectionMask steps_ = 0;
  bool headings_last_ = false;
  std::array<StepMask, kSteps> after_{};   ///< by incoming step
  std::array<StepMask, kSteps> before_{};  ///< by outgoing step
  std::array<std::int64_t, rule_count> refused_{};
  std::string refused_constraint_;
  std::string refused_layer_;
  struct {
    std::optional<Approach> before;
    Vec3 a, b;
  } refused_link_;  ///< the last one
  std::string steps_refused_by_;
  std::int64_t moves_checked_ = 0;
  bool admit_needed_parent_ = false;
};
}  // namespace altiplan::kit
