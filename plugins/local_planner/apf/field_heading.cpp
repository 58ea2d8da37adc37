// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "altiplan/check.hpp"
#include "field_pilot.hpp"

namespace apf {

/// Requirements on a step; each row of kStages relaxes more than the row before.
struct Stage {
  bool turn;       ///< the turn limit of repair 4
  bool rules;      ///< every constraint of check.hpp, else obstacles, volume and level alone
  bool ahead;      ///< no obstacle ahead for the reaction time
  double horizon;  ///< moving obstacles over this fraction of it; 0: for this step alone
  bool escape;     ///< after the step, a straight path to where no mover comes remains
};

namespace {
constexpr std::array<Stage, 8> kStages{{{true, true, true, 1, true},
                                        {true, true, false, 1, true},
                                        {true, true, false, 0.4, true},
                                        {true, true, false, 0, true},
                                        {false, true, true, 1, true},
                                        {false, true, false, 0.4, true},
                                        {false, true, false, 0, true},
                                        {false, false, false, 0, true}}};
/// For the last leg: no need to look beyond the goal.
constexpr Stage kLastLeg{true, true, false, 0, false};
}  // namespace

std::optional<PilotStep> FieldPilot::last_leg(const Observation& seen) {
  constexpr double kSteps = 4;
  const Vec3 way = seen.goal.position - here_;
  const double longest = seen.max_dt_s * speed_;
  const double legs = std::ceil(way.norm() / longest - 1e-9);
  Prospect whole{seen.goal.position};
  if (legs > kSteps || !keeps(seen, whole, kLastLeg)) {
    return std::nullopt;
  }
  if (legs > 1) {
    Prospect part{here_ + way / legs};
    return keeps(seen, part, kLastLeg) ? std::optional(fly(seen, take(part.to, true)))
                                       : std::nullopt;
  }
  PilotStep step = fly(seen, take(seen.goal.position, true));
  step.outcome = PilotStep::Outcome::arrived;
  step.why = "reached the goal";
  return step;
}

std::optional<FieldPilot::Leg> FieldPilot::choose(const Observation& seen, const Vec3& wish) {
  const Instant now{seen.state.time_s, here_};
  planned_ = moving_.empty() ? std::nullopt : escape_.next(outlook_, now, seen.max_dt_s);
  prospects_[0] = {clamped(wish)};
  const bool turns = prospects_[0].to != here_;
  if (turns && keeps(seen, prospects_[0], kStages[0])) {
    return take(prospects_[0], true);
  }
  begin_prospects(wish);
  for (const Stage& stage : kStages) {
    if (!stage.rules) {  // an escape that satisfies them comes first
      if (const auto leg = escape(seen)) {
        return leg;
      }
    }
    for (int i = turns ? 0 : 1; has_prospect(i); ++i) {
      if (keeps(seen, prospects_[i], stage)) {
        return take(prospects_[i], stage.rules);
      }
    }
  }
  return longest_free(seen);
}

std::optional<FieldPilot::Leg> FieldPilot::escape(const Observation& seen) {
  const Instant now{seen.state.time_s, here_};
  auto next = planned_;
  Vec3 ahead(heading_.x(), heading_.y(), 0);
  ahead = ahead.norm() > 0 ? ahead.normalized() : Vec3(1, 0, 0);
  const double side = bearing_change(heading_, seen.local_target - here_) < 0 ? -1 : 1;
  if ((!next || escape_.looks_again(now.time_s)) &&
      escape_.find(outlook_, now, speed_, ahead, turned_left(ahead, 0, side))) {
    next = escape_.next(outlook_, now, seen.max_dt_s);
  }
  if (!next) {
    return std::nullopt;
  }
  ++escapes_;
  Leg leg = take(next->at, leg_ok(before_, here_, next->at, request_));
  leg.seconds = next->time_s - now.time_s;
  return leg;
}

Vec3 FieldPilot::clamped(const Vec3& wish) const {
  const Vec3 to = here_ + wish * step_;
  if (!p_.turn_limit || !moves_) {
    return to;
  }
  const Vec3 way = clamp_turn(here_ - heading_ * step_, here_, to, max_turn()) - here_;
  const double shrunk = way.norm();
  return shrunk > 1e-9 * step_ && shrunk < step_ / 4 ? Vec3(here_ + way * (step_ / 4 / shrunk))
                                                     : Vec3(here_ + way);
}

void FieldPilot::begin_prospects(const Vec3& wish) {
  const double by_heading = bearing_change(wish, heading_);
  const double side = by_heading != 0 ? by_heading : bearing_change(wish, to_target_);
  fan_.begin(wish, max_climb(), request_.level_m.has_value(), side < 0 ? -1 : 1);
  count_ = 1;
}

bool FieldPilot::has_prospect(int index) {
  if (index == count_) {
    if (const auto direction = fan_.next()) {
      prospects_[std::size_t(count_++)] = {here_ + *direction * step_};
    }
  }
  return index < count_;
}

FieldPilot::Leg FieldPilot::take(const Prospect& prospect, bool keeps_rules) {
  const Leg leg = take(prospect.to, keeps_rules);
  if (prospect.escape == Answer::yes) {
    escape_.keep({seen_s_ + prospect.lasts, prospect.to},
                 {seen_s_ + prospect.safe.time_s, prospect.safe.at}, speed_);
  }
  return leg;
}

FieldPilot::Leg FieldPilot::take(const Vec3& to, bool keeps_rules) {
  clamp_yielded_ += p_.turn_limit && turn_to(to - here_) > max_turn() + kAngleTolerance;
  limits_yielded_ += !keeps_rules;
  return {to, (to - here_).norm() / speed_};
}

std::optional<FieldPilot::Leg> FieldPilot::longest_free(const Observation& seen) {
  Prospect* best = nullptr;
  double longest = -1;
  constexpr Stage kObstacles{false, false, false, 0, false};
  for (int i = 1; has_prospect(i); ++i) {
    Prospect& prospect = prospects_[i];
    const double free =
        outlook_.seconds_to_contact(here_, 0, (prospect.to - here_) / step_ * speed_, 0);
    if (free > longest && is_allowed(seen, prospect, kObstacles)) {
      longest = free;
      best = &prospect;
    }
  }
  return best != nullptr ? std::optional(take(best->to, best->rules == Answer::yes)) : std::nullopt;
}

bool FieldPilot::keeps(const Observation& seen, Prospect& prospect, const Stage& stage) const {
  const Vec3 way = prospect.to - here_;
  if (prospect.turn < 0) {
    const double length = way.norm();
    prospect.turn = turn_to(way);
    prospect.contact =
        outlook_.seconds_to_contact(here_, 0, way / length * speed_, outlook_.margin());
    prospect.lasts = length / speed_;
  }
  if (stage.turn && p_.turn_limit && prospect.turn > max_turn() + kAngleTolerance) {
    return false;
  }
  if (prospect.contact < std::max(prospect.lasts, stage.horizon * p_.reaction_s)) {
    return false;
  }
  return is_allowed(seen, prospect, stage) && (!stage.escape || has_escape(prospect));
}

bool FieldPilot::is_allowed(const Observation& seen, Prospect& prospect, const Stage& stage) const {
  const Vec3& to = prospect.to;
  const auto known = [](Answer& answer, const auto& ask) {
    if (answer == Answer::unasked) {
      answer = ask() ? Answer::yes : Answer::no;
    }
    return answer == Answer::yes;
  };
  if (stage.rules) {
    if (!known(prospect.rules,
               [&] { return !ends_too_low(seen, to) && leg_ok(before_, here_, to, request_); })) {
      return false;
    }
  } else if (!known(prospect.open, [&] {
               return request_.volume.contains(to, kLengthTolerance) &&
                      climb_angle(to - here_) <= max_climb() + kAngleTolerance &&
                      seen.world->ground_below(here_, to) &&
                      !outlook_.is_blocked(here_, to, required_);
             })) {
    return false;
  }
  return !stage.ahead || known(prospect.ahead, [&] { return is_open_ahead(seen, to); });
}

bool FieldPilot::ends_too_low(const Observation& seen, const Vec3& to) const {
  const std::optional<double> ground = seen.world->ground(to.x(), to.y());
  return ground && to.z() - *ground < room_of_ground() - kLengthTolerance;
}

bool FieldPilot::is_open_ahead(const Observation& seen, const Vec3& to) const {
  // As far as the vehicle needs to turn away, but not past the target.
  const double length = (to - here_).norm();
  const double look = std::clamp(std::max(4 * step_, speed_ * p_.reaction_s), length,
                                 std::max(length, (seen.local_target - here_).norm()));
  return outlook_.is_open(here_, here_ + (to - here_) / length * look);
}

bool FieldPilot::has_escape(Prospect& prospect) const {
  if (moving_.empty()) {
    return true;
  }
  if (prospect.escape == Answer::unasked) {
    prospect.escape = Answer::no;
    const Vec3 onward = (prospect.to - here_).normalized() * speed_;
    const int first = bearing_change(onward, to_target_) < 0 ? -1 : 1;
    for (int k = 0; k <= Fan::kHalf && prospect.escape == Answer::no; ++k) {
      for (const int side : {first * k, -first * k}) {
        const Vec3 velocity = fan_.turned(onward, side);
        if (const auto lasts = outlook_.seconds_to_safety(prospect.to, prospect.lasts, velocity,
                                                          outlook_.margin(), p_.reaction_s)) {
          prospect.escape = Answer::yes;
          prospect.safe = {prospect.lasts + *lasts, prospect.to + velocity * *lasts};
          break;
        }
      }
    }
  }
  return prospect.escape == Answer::yes;
}
}  // namespace apf
