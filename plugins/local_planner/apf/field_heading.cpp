// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "altiplan/check.hpp"
#include "field_pilot.hpp"

namespace apf {

/// What a step must keep; each row of kStages gives up more than the row before.
struct Stage {
  bool turn;       ///< the turn limit of repair 4
  bool rules;      ///< every rule of check.hpp, else obstacles, volume and level alone
  bool ahead;      ///< nothing in the way for the reaction time
  double horizon;  ///< moving obstacles over this share of it; 0: for this step alone
};

namespace {
constexpr std::array<Stage, 8> kStages{{{true, true, true, 1},
                                        {true, true, false, 1},
                                        {true, true, false, 0.4},
                                        {false, true, true, 1},
                                        {false, true, false, 0.4},
                                        {false, true, false, 0},
                                        {false, false, false, 0.4},
                                        {false, false, false, 0}}};
}  // namespace

std::optional<PilotStep> FieldPilot::last_leg(const Observation& seen) {
  constexpr double kSteps = 4;
  const Vec3 way = seen.goal.position - here_;
  const double longest = seen.max_dt_s * speed_;
  const double legs = std::ceil(way.norm() / longest - 1e-9);
  if (legs > kSteps || (p_.turn_limit && turn_to(way) > max_turn()) ||
      !keeps(seen, seen.goal.position, kStages[2])) {
    return std::nullopt;
  }
  if (legs > 1) {
    const Vec3 to = here_ + way / legs;
    return keeps(seen, to, kStages[2]) ? std::optional(fly(seen, to)) : std::nullopt;
  }
  PilotStep step = fly(seen, seen.goal.position);
  step.outcome = PilotStep::Outcome::arrived;
  step.why = "reached the goal";
  return step;
}

std::optional<Vec3> FieldPilot::choose(const Observation& seen, const Vec3& wish) {
  Vec3 first = here_ + wish * step_;
  if (p_.turn_limit && moves_) {
    first = clamp_turn(here_ - heading_ * step_, here_, first, max_turn());
    const Vec3 way = first - here_;
    const double shrunk = way.norm();
    if (shrunk > 1e-9 * step_ && shrunk < step_ / 4) {
      first = here_ + way * (step_ / 4 / shrunk);
    }
  }
  if (first != here_ && keeps(seen, first, kStages[0])) {
    return first;
  }
  const double by_heading = bearing_change(wish, heading_);
  const double side = by_heading != 0 ? by_heading : bearing_change(wish, to_target_);
  fan_.fill(wish, max_climb(), request_.level_m.has_value(), side < 0 ? -1 : 1);
  for (const Stage& stage : kStages) {
    if (stage.turn && first != here_ && keeps(seen, first, stage)) {
      return first;
    }
    for (int i = 0; i < fan_.size(); ++i) {
      const Vec3 to = here_ + fan_.direction(i) * step_;
      if (keeps(seen, to, stage)) {
        clamp_yielded_ += p_.turn_limit && turn_to(to - here_) > max_turn() + kAngleTolerance;
        limits_yielded_ += !stage.rules;
        return to;
      }
    }
  }
  return std::nullopt;
}

bool FieldPilot::keeps(const Observation& seen, const Vec3& to, const Stage& stage) const {
  const Vec3 way = to - here_;
  if (stage.turn && p_.turn_limit && turn_to(way) > max_turn() + kAngleTolerance) {
    return false;
  }
  const double length = way.norm();
  const Vec3 direction = way / length;
  const double horizon = std::max(length / speed_, stage.horizon * p_.reaction_s);
  for (const SensedObstacle& moving : seen.moving) {
    if (!keeps_off(moving, direction, horizon)) {
      return false;
    }
  }
  if (stage.rules
          ? !leg_ok(before_, here_, to, request_)
          : !request_.volume.contains(to, kLengthTolerance) ||
                !seen.world->ground_below(here_, to) || seen.world->blocked(here_, to, required_)) {
    return false;
  }
  if (!stage.ahead) {
    return true;
  }
  // As far as the vehicle needs to turn away, but not past the target.
  const double look = std::clamp(std::max(4 * step_, speed_ * p_.reaction_s), length,
                                 std::max(length, (seen.local_target - here_).norm()));
  const Vec3 far = here_ + direction * look;
  return seen.world->ground_below(here_, far) && !seen.world->blocked(here_, far, required_) &&
         (!request_.limits.min_ground_clearance ||
          seen.world->ground_gap(here_, far, room_of_ground()) >= room_of_ground());
}

bool FieldPilot::keeps_off(const SensedObstacle& moving, const Vec3& direction,
                           double horizon) const {
  const Vec3 r = here_ - moving.position;
  const Vec3 w = direction * speed_ - moving.velocity.value_or(Vec3::Zero());
  const double margin = 0.01 * p_.influence_m;
  const double core = moving.radius + required_;
  const double nearest = point_leg_distance(Vec3::Zero(), r, r + w * horizon) - core;
  return nearest >= std::min(margin, r.norm() - core - kLengthTolerance);
}
}  // namespace apf
