// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "field_pilot.hpp"

namespace apf {
namespace {
constexpr double kProgress = 0.1;  ///< fraction of the distance flown; less is none
}

FieldPilot::FieldPilot(const Params& params, const Request& request)
    : p_(params),
      request_(request),
      unit_(params.length_unit_m.value.value_or(params.influence_m / 3)),
      ground_influence_(params.ground_influence_m.value.value_or(params.influence_m / 10)),
      target_(params.target_m.value.value_or(params.influence_m * 2 / 3)),
      goal_zone_(params.goal_zone_m.value.value_or(params.influence_m)),
      step_far_(params.step_far_m.value.value_or(params.influence_m / 6)),
      step_near_(params.step_near_m.value.value_or(params.influence_m / 30)),
      required_(std::max(request.limits.min_clearance, request.vehicle.radius_m)),
      start_to_goal_(std::max((request.goal.position - request.start.position).norm(), 1e-6)),
      lowest_(request.volume.min.z()),
      highest_(request.volume.max.z()),
      outlook_(request_, required_, 0.01 * params.influence_m, params.reaction_s),
      escape_(request_) {
  for (const AltitudeBand& band : request.limits.altitude) {
    if (band.datum == AltitudeBand::Datum::sea) {
      lowest_ = std::max(lowest_, band.min);
      highest_ = std::min(highest_, band.max);
    }
  }
  if (params.variant != Variant::improved) {
    p_.turned_repulsion = p_.stronger_goal = p_.two_steps = p_.turn_limit = false;
    p_.side = Side::field;
  }
}

PilotStep FieldPilot::do_step(const Observation& seen) {
  observe(seen);
  if (seen.goal.reached_at(here_)) {
    return {{seen.state.time_s + std::min(seen.max_dt_s, 1e-3), here_, seen.state.velocity},
            PilotStep::Outcome::arrived,
            "at the goal"};
  }
  if (no_progress()) {
    ++local_minima_;
    const bool again = p_.side == Side::field || insists();
    trap_ = here_;
    if (again) {
      passing_ = Passing::nothing;
      return {seen.state, PilotStep::Outcome::stuck, why_trapped(seen)};
    }
  }
  if (const auto last = last_leg(seen)) {
    return *last;
  }
  const Vec3 wish = wished_direction(seen);
  const auto step = choose(seen, wish);
  if (!step) {
    return {seen.state, PilotStep::Outcome::stuck, why_no_heading(seen)};
  }
  return fly(seen, *step);
}

Counters FieldPilot::do_counters() const {
  return {{"local_minima", local_minima_},
          {"oscillations", oscillations_},
          {"clamp_yielded", clamp_yielded_},
          {"limits_yielded", limits_yielded_},
          {"escapes", escapes_}};
}

void FieldPilot::observe(const Observation& seen) {
  // Non-owning, so that it does not allocate: the world outlives the step.
  request_.world = std::shared_ptr<const World>(std::shared_ptr<const World>(), seen.world);
  request_.goal = seen.goal;
  seen_s_ = seen.state.time_s;
  here_ = seen.state.position;
  const double flown = seen.state.velocity.norm();
  moves_ = flown > 0;
  const Vec3 to_target = seen.local_target - here_;
  heading_ = moves_ ? Vec3(seen.state.velocity / flown)
                    : (to_target.norm() > 0 ? Vec3(to_target.normalized()) : Vec3(1, 0, 0));
  before_.reset();
  if (moves_) {
    before_ = here_ - seen.state.velocity;
  }
  moving_ = seen.moving;
  outlook_.see_world(*seen.world, here_);
  double clearance = outlook_.clearance();
  room_ = std::clamp(clearance - required_ - kLengthTolerance, 0.0, outlook_.margin());
  for (const SensedObstacle& moving : seen.moving) {
    clearance = std::min(clearance, (here_ - moving.position).norm() - moving.radius);
  }
  speed_ = request_.vehicle.speed_at(clearance);
  outlook_.see_movers(seen, speed_);
  const double wanted = p_.two_steps && clearance > speed_ * p_.reaction_s ? step_far_ : step_near_;
  step_ = std::min({wanted, seen.max_dt_s * speed_, request_.limits.max_leg});
  to_goal_ = seen.goal.position - here_;
  const bool close = to_goal_.norm() < 3 * step_;
  steep_goal_ = close && climb_angle(to_goal_) > max_climb();
  if (p_.turn_limit && close && !steep_goal_ && turn_to(to_goal_) > max_turn()) {
    step_ = std::min(step_, to_goal_.norm() / 2);  // shorter steps need less space to turn
  }
}

double FieldPilot::turn_to(const Vec3& direction) const {
  return moves_ ? turn_angle_in_space(heading_, direction) : 0;
}

PilotStep FieldPilot::fly(const Observation& seen, const Leg& leg) {
  const Vec3 way = leg.to - here_;
  const double length = way.norm();
  swing(way);
  remember();
  flown_ += length;
  const double dt = std::min(leg.seconds, seen.max_dt_s);
  return {
      {seen.state.time_s + dt, leg.to, way / dt}, PilotStep::Outcome::flying, "follows the field"};
}

void FieldPilot::remember() {
  const Past& last = past_[std::size_t((places_ + kWindow - 1) % kWindow)];
  if (places_ == 0 || flown_ - last.flown >= 0.01 * p_.influence_m || ++since_ >= kWindow) {
    past_[std::size_t(places_++ % kWindow)] = {here_, flown_};
    since_ = 0;
  }
}

void FieldPilot::swing(const Vec3& way) {
  if (course_.dot(way) > 0) {
    return;
  }
  course_ = way;
  const double left = to_goal_.norm();
  if (swings_ == 0 || nearest_ - left > kProgress * (flown_ - flown_then_)) {
    nearest_ = left;
    flown_then_ = flown_;
    swings_ = 1;
    return;
  }
  oscillations_ += ++swings_ > 2;
}

bool FieldPilot::no_progress() {
  if (places_ < kWindow) {
    return false;
  }
  const Past& oldest = past_[std::size_t(places_ % kWindow)];
  if ((here_ - oldest.position).norm() > kProgress * (flown_ - oldest.flown)) {
    return false;
  }
  places_ = 0;
  return true;
}
}  // namespace apf
