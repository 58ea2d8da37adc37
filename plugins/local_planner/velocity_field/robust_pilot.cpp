// SPDX-License-Identifier: Apache-2.0
#include "robust_pilot.hpp"

#include <algorithm>

#include "pilot_ends.hpp"

namespace velocity_field {
namespace {
/// How far from the goal's place a level flight at height z has arrived.
double tolerance_at(const Goal& goal, double z) {
  const double off = goal.position.z() - z;
  return std::sqrt(std::max(0.0, goal.tolerance_m * goal.tolerance_m - off * off));
}

std::string_view what(RobustFlight::Kind kind, bool has_guide) {
  switch (kind) {
    case RobustFlight::Kind::field:
      return "follows the field along the guide";
    case RobustFlight::Kind::way_out:
      return "flies its way out, through where no circle is free";
    case RobustFlight::Kind::circle:
      return has_guide ? "circles: the next step toward the goal is not known to be safe"
                       : "circles: no way to the goal is known";
    case RobustFlight::Kind::unproven:
      break;
  }
  return "keeps away from threats: no way out is known";
}

std::optional<Vec2> course_of(const State& state) {
  const Vec2 velocity = state.velocity.head<2>();
  const double speed = velocity.norm();
  return speed > 0 ? std::optional<Vec2>(velocity / speed) : std::nullopt;
}
}  // namespace

RobustPilot::RobustPilot(const Params& params, const Request& request)
    : p_(params),
      field_(params.field()),
      speed_(request.vehicle.speed_mps),
      min_radius_(std::max(params.min_radius(), request.limits.min_turn_radius)),
      min_fillet_(request.limits.min_turn_radius),
      max_turn_(std::min(request.limits.max_turn_horizontal, request.limits.max_turn_space)),
      max_step_(request.limits.max_leg),
      feed_(request, std::max(params.ring_m, Freedom::reach_m(steps_of(params.step_s)))),
      flight_(field_, feed_.threats(), steps_of(params.step_s), request.budget),
      dt_(params.step_s) {
  const Vec2 here = request.start.position.head<2>();
  const std::optional<Vec2> course = course_of(request.start);
  flight_.set_world(request.goal.position.head<2>(),
                    tolerance_at(request.goal, request.start.position.z()), here, course);
  expected_ = {here, course.value_or(Vec2(0, 0))};
}

Steps RobustPilot::steps_of(double step_s) const {
  const double length = std::min(speed_ * step_s, max_step_);
  return {length, min_circle(length, min_radius_, min_fillet_), max_turn_};
}

PilotStep RobustPilot::do_step(const Observation& seen) {
  if (const auto end = end_of_flight(seen, true)) {
    return *end;
  }
  if (steps_ == p_.max_steps) {
    return stuck(seen,
                 tolerance_at(seen.goal, seen.state.position.z()) < flight_.steps().length_m() / 2
                     ? "max_steps steps did not lead to the goal, whose tolerance is less than "
                       "half a step at this height"
                     : "max_steps steps did not lead to the goal");
  }
  const Vec2 here = seen.state.position.head<2>();
  const std::optional<Vec2> course = course_of(seen.state);
  const double dt = std::min({p_.step_s, seen.max_dt_s, max_step_ / speed_});
  take_news(seen, here, course, dt);
  if (steps_ == 0 && !flight_.is_safe()) {
    return stuck(seen, course ? "from the course here no turn is known that enters no threat"
                              : "no course from here is known that enters no threat");
  }
  if (steps_ == 0 && !flight_.has_guide()) {
    return stuck(seen, flight_.gave_up()
                           ? "the search for a way between so many threats was given up"
                           : "there is no way to the goal between the threats");
  }
  ++steps_;
  return fly(seen, flight_.step(here, course, push_of_movers(seen, here)), dt);
}

void RobustPilot::take_news(const Observation& seen, const Vec2& here,
                            const std::optional<Vec2>& course, double dt) {
  const bool other_steps = dt != dt_;
  if (other_steps) {
    dt_ = dt;
    flight_.set_steps(steps_of(dt));
  }
  const double off = (here - expected_.at).norm();
  const bool turned = course && (*course - expected_.course).norm() > kAngleTolerance;
  const bool other_guide = other_steps && steps_ == 0;
  if (feed_.update(seen) || off > min_radius_ || other_guide) {
    flight_.set_world(seen.goal.position.head<2>(),
                      tolerance_at(seen.goal, seen.state.position.z()), here, course);
  } else if (other_steps || turned || off > kLengthTolerance) {
    flight_.check_way_out(here, course);
  }
}

Vec2 RobustPilot::push_of_movers(const Observation& seen, const Vec2& here) const {
  Vec2 push(0, 0);
  for (const SensedObstacle& moving : seen.moving) {
    push += field_.of_threat(here, {moving.position.head<2>(), moving.radius},
                             seen.goal.position.head<2>() - here);
  }
  return push;
}

PilotStep RobustPilot::fly(const Observation& seen, const Pose& next, double dt) {
  expected_ = next;
  const Vec3 course(next.course.x(), next.course.y(), 0);
  const State state{seen.state.time_s + dt,
                    {next.at.x(), next.at.y(), seen.state.position.z()},
                    flight_.steps().length_m() / dt * course};
  return {state,
          seen.goal.reached_at(state.position) ? PilotStep::Outcome::arrived
                                               : PilotStep::Outcome::flying,
          what(flight_.kind(), flight_.has_guide())};
}

Counters RobustPilot::do_counters() const {
  const RobustFlight::Counts& counts = flight_.counts();
  return {{"guides", counts.guides},
          {"turn_limit_steps", counts.turn_limit_steps},
          {"way_out_steps", counts.way_out_steps},
          {"circle_steps", counts.circle_steps},
          {"unproven_steps", counts.unproven_steps},
          {"ways_out_lost", counts.ways_out_lost}};
}
}  // namespace velocity_field
