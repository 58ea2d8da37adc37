// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "altiplan/local_planner.hpp"
#include "field_params.hpp"
#include "robust_flight.hpp"

namespace velocity_field {

/// One flight of the robust variant: level, at the vehicle's speed.
class RobustPilot final : public Pilot {
 public:
  RobustPilot(const Params& params, const Request& request);

 private:
  PilotStep do_step(const Observation& seen) override;
  double do_reach_m() const override { return flight_.reach_m(); }
  Counters do_counters() const override;

  Steps steps_of(double step_s) const;
  /// Takes over what has changed: threats, the goal, the step, or where the vehicle is.
  void take_news(const Observation& seen, const Vec2& here, const std::optional<Vec2>& course,
                 double dt);
  /// V_P + V_G of what moves; where it will be is not known.
  Vec2 push_of_movers(const Observation& seen, const Vec2& here) const;
  PilotStep fly(const Observation& seen, const Pose& next, double dt);

  Params p_;
  Field field_;
  double speed_;
  double min_radius_;
  double min_fillet_;
  double max_turn_;
  double max_step_;
  ThreatFeed feed_;
  RobustFlight flight_;
  Pose expected_;  ///< where the last step led to
  double dt_;
  std::int64_t steps_ = 0;
};
}  // namespace velocity_field
