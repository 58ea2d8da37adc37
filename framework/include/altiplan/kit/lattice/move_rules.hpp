// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/kit/lattice/step_ground.hpp"
#include "altiplan/kit/lattice/steps.hpp"

namespace altiplan::kit {

/// How a step of a lattice is held to the obstacles.
enum class MoveCheck {
  exact,  ///< the straight leg, by the world's exact queries
  cells,  ///< by the cells that it leads through: cells that an obstacle overlaps are closed
};

/// What blocks moves by cells: the cells of the lattice that an obstacle, grown by the clearance
/// needed, overlaps; the layers' own cells where nothing else is in the world and no clearance is
/// needed.
ALTIPLAN_API std::shared_ptr<const VoxelGrid> occupancy(const Request& request,
                                                        const Lattice& lattice);

/// The judge's rules for the steps of a lattice, sorted by what they depend on: what depends on the
/// direction alone (climb, leg length) or on two directions (turns) is answered from masks, what
/// depends on the place by few queries of the world. A step is accepted if and only if leg_ok
/// accepts it (with `cells`: and its cells are free).
/// Belongs to one search; counts what each rule refused.
class ALTIPLAN_API MoveRules {
 public:
  /// All of it must outlive the rules. With `cells` the occupancy is asked for here.
  MoveRules(const Request& request, const Lattice& lattice, MoveCheck check, CornerRule corner);

  /// Whether with moves by cells the cells and the direction of a step decide alone: no rule looks
  /// at the ground, at two legs or at the whole route, and there are no constraints.
  static bool cells_decide(const Request& request);

  /// Directions out of c, reached by the step `in` (kHere: not by a step), that keep the rules
  /// answered from masks; the others still have to pass `leg_free`.
  DirectionMask candidates(const Cell& c, int in) {
    const DirectionMask open = out_of(c);
    const DirectionMask kept = directions_of(after(in));
    refused_[by_turn] += __builtin_popcount(open & ~kept);
    return open & kept;
  }
  /// Those that keep the rules whatever led to c.
  DirectionMask out_of(const Cell& c) {
    DirectionMask open = steps_ & lattice_.inside(c);
    if (grid_ != nullptr) {
      const DirectionMask free = free_steps(blocked_around(*grid_, c), corner_);
      refused_[by_cells] += __builtin_popcount(open & ~free);
      open &= free;
    }
    return open;
  }
  /// Directions of steps to c that keep them: a step back keeps what the step keeps.
  DirectionMask into(const Cell& c) { return reversed(out_of(c)); }
  /// Steps that may follow the step `in` by the limits on turns, and those that one may follow.
  StepMask after(int in) const { return after_[std::size_t(in)]; }
  StepMask before(int out) const { return before_[std::size_t(out)]; }
  /// The step in direction d after the step `in`, by its number for `after`.
  int step_after(int in, int d) const { return headings_last_ ? kit::step_after(in, d) : d; }
  /// Whether headings last through steps straight up and down, and some limit looks at that.
  bool headings_last() const { return headings_last_; }
  /// Whether a leg after the step has to be held to what came before the steps: the masks know a
  /// vehicle's heading by its steps alone.
  bool is_first(int step) const {
    return step == kHere || (headings_last_ && heading_of(step) < 0);
  }
  /// How the vehicle comes to a cell, where it is at `here`, by a step; with kHere by the link from
  /// the start, or (`at_start`) by being there.
  std::optional<Approach> approach(int step, const Vec3& here, bool at_start) const;
  /// Whether a step may be refused for what led to its first cell, beside the turn.
  bool looks_beyond_turns() const { return !constraints_.empty(); }
  /// Counts moves that blocked cells have ruled out.
  void count_blocked(std::int64_t refused) { refused_[by_cells] += refused; }
  /// Counts what limits on turns have ruled out of steps that are left.
  void count_turns(StepMask left, StepMask kept) {
    refused_[by_turn] += __builtin_popcount(directions_of(left) & ~directions_of(kept));
  }

  /// What is known of a cell's distance to obstacles: a lower bound, sharpened while a search asks
  /// for steps around the cell. (Of the ground StepGround knows more.)
  struct KnownClearance {
    float least = -std::numeric_limits<float>::infinity();
    bool asked = false;

    void learn(double bound) {
      if (bound > least) {
        least = std::nextafterf(float(bound), -std::numeric_limits<float>::infinity());
      }
    }
  };

  /// Whether the step a–b, from c in direction d, keeps the rules that depend on the place alone.
  bool place_free(const Cell& c, int d, const Vec3& a, const Vec3& b, KnownClearance& near_a,
                  KnownClearance& near_b);
  /// Whether the constraints admit the leg after what led to it.
  bool admits(const std::optional<Approach>& before, const Vec3& a, const Vec3& b) {
    return constraints_.empty() || admitted(before, a, b);
  }
  bool leg_free(const std::optional<Approach>& before, const Cell& c, int d, const Vec3& a,
                const Vec3& b, KnownClearance& near_a, KnownClearance& near_b) {
    return place_free(c, d, a, b, near_a, near_b) && admits(before, a, b);
  }

  /// Whether the straight leg between the centres of two cells, for a vehicle that comes from
  /// `before`, keeps the rules of a leg: as leg_ok says, and with moves by cells if line_of_sight
  /// says so too. The world is then asked for ground and constraints alone, where there are any,
  /// never for obstacles: none reaches into free cells.
  bool sees(const std::optional<Approach>& before, const Cell& a, const Cell& b);

  /// What `sees` asks for beside the cells.
  bool keeps_rules(const std::optional<Approach>& before, const Vec3& a, const Vec3& b);
  /// Whether the leg keeps the limits on length, climb and the turn before it.
  bool keeps_limits(const std::optional<Approach>& before, const Vec3& a, const Vec3& b) {
    return keeps_limits(before, a, b, (b - a).norm());
  }

  /// Directions that keep the rules which depend on the direction alone.
  DirectionMask steps() const { return steps_; }
  /// The occupancy, with moves by cells; else null.
  const VoxelGrid* grid() const { return grid_.get(); }
  const std::shared_ptr<const VoxelGrid>& shared_grid() const { return grid_; }

  /// leg_ok for legs that are no steps (the links of start and goal; the first step of a vehicle
  /// that has a heading), counted by rule.
  bool any_leg_ok(const std::optional<Approach>& before, const Vec3& a, const Vec3& b);

  /// Whether a rule that looks at the leg before refused anything: then one parent a cell may be
  /// too few, and finding nothing proves nothing.
  bool parent_mattered() const { return refused_[by_turn] > 0 || admit_needed_parent_; }
  std::int64_t moves_checked() const { return moves_checked_; }
  /// Whether the cell itself is closed, which only moves by cells know.
  bool cell_blocked(const Cell& c) {
    const bool blocked = grid_ != nullptr && grid_->blocked(c);
    refused_[by_cells] += blocked;
    return blocked;
  }
  /// The rules that refused moves, the busiest first: "ground_clearance (120), turn_angle (7)", and
  /// what no step can do; "" if nothing was refused.
  std::string refusals() const;

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
    by_link,
    rule_count
  };
  DirectionMask directions_kept();
  void find_turns();
  Vec3 heading_vector(int step) const;
  bool keeps_limits(const std::optional<Approach>& before, const Vec3& a, const Vec3& b,
                    double length);
  bool keeps_turn(const Approach& before, const Vec3& a, const Vec3& leg) const;
  bool keeps_ground(const Vec3& a, const Vec3& b);
  bool keeps_ground(const Cell& c, int d, const Vec3& a, const Vec3& b);
  bool keeps_off(const World& layers, const Vec3& a, const Vec3& b);
  bool keeps_off(int d, const Vec3& a, const Vec3& b, KnownClearance& near_a,
                 KnownClearance& near_b);
  void ask(KnownClearance& known, const Vec3& at) const;
  void sort_layers();
  void find_gaps();
  bool admitted(const std::optional<Approach>& before, const Vec3& a, const Vec3& b);

  const Request& request_;
  const Lattice& lattice_;
  CornerRule corner_;
  double needed_;
  double spare_;  ///< clearance beyond half a leg that makes it free for certain
  bool asks_world_;
  struct {
    double climb = 0;
    double turn = 0;
    double turn_space = 0;
  } cosines_;  ///< of the limits on angles
  bool wants_clearance_ = false;
  bool has_ground_rules_ = false;
  std::vector<NamedConstraint> constraints_;
  std::shared_ptr<const VoxelGrid> grid_;
  World obstacles_;    ///< the layers that are more than their ground
  World bare_ground_;  ///< the others
  std::optional<StepGround> ground_;
  double certain_gap_ = 0;  ///< above ground by this, a leg keeps off it and keeps its rules
  double needed_gap_ = -kInfinity;  ///< below this it does not
  Rule too_low_ = by_ground;        ///< the rule that then refuses
  bool has_ceiling_over_ground_ = false;
  DirectionMask steps_ = 0;
  bool headings_last_ = false;
  std::array<StepMask, kSteps> after_{};   ///< by incoming step
  std::array<StepMask, kSteps> before_{};  ///< by outgoing step
  std::array<std::int64_t, rule_count> refused_{};
  std::string refused_constraint_;
  std::string refused_layer_;
  std::string refused_link_;
  std::string steps_refused_by_;
  std::int64_t moves_checked_ = 0;
  bool admit_needed_parent_ = false;
};
}  // namespace altiplan::kit
