// SPDX-License-Identifier: Apache-2.0
#include "paper_pilot.hpp"

#include <algorithm>
#include <cstdio>

#include "pilot_ends.hpp"

namespace velocity_field {

PaperPilot::PaperPilot(const Params& params, const Request& request)
    : p_(params),
      field_(params.field()),
      vehicle_(request.vehicle),
      min_radius_(std::max(params.min_radius(), request.limits.min_turn_radius)),
      min_fillet_(request.limits.min_turn_radius),
      max_turn_(std::min(request.limits.max_turn_horizontal, request.limits.max_turn_space)),
      max_step_(request.limits.max_leg),
      turn_limit_(kPi),
      feed_(request, params.ring_m),
      virtual_targets_(field_.balance(), params.release_m) {
  virtual_targets_.reset(feed_.threats());
  inside_.reserve(feed_.threats().all().size());
  if (params.terrain == Terrain::sections) {
    terrain_.emplace(params, request);
  }
}

PilotStep PaperPilot::do_step(const Observation& seen) {
  if (const auto end = end_of_flight(seen, is_level())) {
    return *end;
  }
  if (++steps_ > p_.max_steps) {
    return stuck(seen, why_not_reached(seen));
  }
  take_news(seen);
  if (terrain_ && terrain_->is_kept_above()) {
    return stuck(
        seen,
        "the goal lies lower than the flight can go and climb out again, and no straight leg "
        "leads down to it");
  }
  const Vec2 here = seen.state.position.head<2>();
  const Vec3& target = p_.toward == Toward::goal ? seen.goal.position : seen.local_target;
  const Vec2 aim = virtual_targets_.aim(feed_.threats(), target.head<2>(), here,
                                        heading_.value_or(target.head<2>() - here), inside_);
  const double v = speed(seen);
  const double dt = step_time(seen, v);
  const Vec2 wished = wish(seen, here, aim - here);
  if (terrain_) {
    return fly(seen, terrain_->step(seen.state, feed_.threats().all(), wished, v * dt), v, dt);
  }
  const Vec2 heading = flyable(wished, v * dt);
  return fly(seen, {heading.x(), heading.y(), 0}, v, dt);
}

void PaperPilot::take_news(const Observation& seen) {
  if (feed_.update(seen)) {
    virtual_targets_.reset(feed_.threats());
    inside_.reserve(feed_.threats().all().size());
  }
  if (terrain_) {
    terrain_->update(seen);
  }
  const Vec2 here = seen.state.position.head<2>();
  const Vec2 velocity = seen.state.velocity.head<2>();
  const double flown = velocity.norm();
  heading_ = flown > 0 ? std::optional<Vec2>(velocity / flown) : std::nullopt;
  inside_.clear();
  for (const std::uint32_t i : feed_.threats().near(here)) {
    const Disc& disc = feed_.threats().all()[i];
    const double reach = disc.radius + field_.ring;
    if ((here - disc.centre).squaredNorm() <= reach * reach) {
      inside_.push_back(i);
    }
  }
}

Vec2 PaperPilot::wish(const Observation& seen, const Vec2& here, const Vec2& to_target) {
  Vec2 sum = field_.of_target(to_target);
  for (const std::uint32_t i : inside_) {
    sum += field_.of_threat(here, feed_.threats().all()[i], to_target);
  }
  for (const SensedObstacle& moving : seen.moving) {
    sum += field_.of_threat(here, {moving.position.head<2>(), moving.radius}, to_target);
  }
  if (terrain_) {
    sum += terrain_->push(field_, here, to_target);
  }
  const double size = sum.norm();
  return size > 0 ? Vec2(sum / size) : heading_.value_or(Vec2(1, 0));
}

Vec2 PaperPilot::flyable(const Vec2& wish, double step) {
  if (!heading_) {
    return wish;
  }
  if (step != limit_step_) {
    turn_limit_ = TurnLimit(
        std::min(max_turn(step, min_circle(step, min_radius_, min_fillet_)), max_turn_));
    limit_step_ = step;
  }
  const Vec2 held = turn_limit_.held(*heading_, wish);
  turn_limit_steps_ += held != wish;
  return held;
}

double PaperPilot::speed(const Observation& seen) const {
  return vehicle_.speed_near.empty()
             ? vehicle_.speed_mps
             : vehicle_.speed_at(seen.world->clearance(seen.state.position));
}

double PaperPilot::step_time(const Observation& seen, double speed) const {
  return std::min({p_.step_s, seen.max_dt_s, max_step_ / speed});
}

PilotStep PaperPilot::fly(const Observation& seen, const Vec3& ahead, double speed, double dt) {
  const State next{seen.state.time_s + dt, seen.state.position + speed * dt * ahead, speed * ahead};
  return {next,
          seen.goal.reached_at(next.position) ? PilotStep::Outcome::arrived
                                              : PilotStep::Outcome::flying,
          news_of_virtual_target()};
}

std::string_view PaperPilot::why_not_reached(const Observation& seen) {
  constexpr std::string_view kGivenUp = "max_steps steps are flown, and the goal is not reached";
  const double v = speed(seen);
  const double half_step = v * step_time(seen, v) / 2;
  if (seen.goal.tolerance_m >= half_step) {
    return kGivenUp;
  }
  const int length = std::snprintf(
      why_.data(), why_.size(), "%s; the goal's tolerance of %g m is less than half a step, %g m",
      kGivenUp.data(), seen.goal.tolerance_m, half_step);
  return {why_.data(), std::min(std::size_t(length), why_.size() - 1)};
}

std::string_view PaperPilot::news_of_virtual_target() {
  if (terrain_ && !terrain_->why().empty()) {
    return terrain_->why();
  }
  const auto active = virtual_targets_.active();
  if (!active) {
    return "follows the field";
  }
  if (virtual_targets_.entries() != told_) {
    told_ = virtual_targets_.entries();
    const int length = std::snprintf(
        why_.data(), why_.size(), "follows the field to the virtual target of threat %u%s",
        *active + 1,
        virtual_targets_.is_inside_another() ? ", which lies inside another threat" : "");
    why_length_ = std::min(std::size_t(length), why_.size() - 1);
  }
  return {why_.data(), why_length_};
}

Counters PaperPilot::do_counters() const {
  Counters counters{{"trap_entries", virtual_targets_.entries()},
                    {"potential_virtual_targets", virtual_targets_.potential()},
                    {"virtual_targets_used", virtual_targets_.used()},
                    {"virtual_targets_inside_threats", virtual_targets_.inside_threats()},
                    {"turn_limit_steps", turn_limit_steps_}};
  if (terrain_) {
    counters.back().value = terrain_->turn_limit_steps();
    counters.insert(counters.end(), {{"climbs_over", terrain_->climbs_over()},
                                     {"low_steps", terrain_->low_steps()}});
  }
  return counters;
}
}  // namespace velocity_field
