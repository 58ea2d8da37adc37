// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "altiplan/local_planner.hpp"
#include "apf_field.hpp"
#include "apf_params.hpp"

namespace apf {

struct Stage;

/// One flight by the field: what is seen, the force there, the nearest heading that keeps the
/// rules.
class FieldPilot final : public Pilot {
 public:
  FieldPilot(const Params& params, const Request& request);

 private:
  PilotStep do_step(const Observation& seen) override;
  double do_reach_m() const override { return p_.influence_m; }
  Counters do_counters() const override;

  /// Takes over what is seen: place, heading, speed.
  void observe(const Observation& seen);
  double max_turn() const { return radians(p_.max_turn_deg); }
  double turn_to(const Vec3& direction) const;
  double max_climb() const { return request_.level_m ? 0 : request_.limits.max_climb; }
  double room_of_ground() const { return request_.limits.min_ground_clearance.value_or(0); }
  PilotStep fly(const Observation& seen, const Vec3& to);
  /// Keeps places at least a hundredth of the influence, or kWindow steps, apart.
  void remember();
  /// Whether the last places lie close together; begins to count anew when they do.
  bool no_progress();

  // The force: field_force.cpp.
  /// The field's direction, eq. (20), no steeper than the climb limit.
  Vec3 wished_direction(const Observation& seen);
  void add(const Layer& layer, const Nearby& nearby);
  /// Between now (far in time) and the closest approach (at hand).
  void add(const SensedObstacle& moving);
  /// Eq. (18), with the modified repulsion and repair 1; `away` is a unit vector, `room` metres.
  void repel(Vec3 away, double room);

  // What is flown of it: field_heading.cpp.
  /// Straight to the goal over the last steps, where nothing forbids it: the field would push the
  /// vehicle past a goal near an obstacle.
  std::optional<PilotStep> last_leg(const Observation& seen);
  /// The end of the step nearest to the wish that keeps the most.
  std::optional<Vec3> choose(const Observation& seen, const Vec3& wish);
  bool keeps(const Observation& seen, const Vec3& to, const Stage& stage) const;
  /// Whether the obstacle and a flight along the direction stay apart, or at least part.
  bool keeps_off(const SensedObstacle& moving, const Vec3& direction, double horizon) const;

  struct Past {
    Vec3 position{0, 0, 0};
    double flown = 0;
  };
  static constexpr std::int64_t kWindow = 64;

  Params p_;
  Request request_;
  double unit_;
  double ground_influence_;
  double target_;
  double goal_zone_;
  double step_far_;
  double step_near_;
  double required_;
  double start_to_goal_;
  Fan fan_;
  std::array<Past, kWindow> past_{};
  double flown_ = 0;
  std::int64_t places_ = 0;
  std::int64_t since_ = 0;
  std::int64_t local_minima_ = 0;
  std::int64_t oscillations_ = 0;
  std::int64_t clamp_yielded_ = 0;
  std::int64_t limits_yielded_ = 0;

  // Of the present step.
  Vec3 here_{0, 0, 0};
  Vec3 heading_{1, 0, 0};
  Vec3 to_target_{0, 0, 0};
  Vec3 to_goal_{0, 0, 0};
  Vec3 force_{0, 0, 0};
  std::optional<Vec3> before_;
  bool moves_ = false;
  bool steep_goal_ = false;  ///< close, but too far above or below to be reached straight
  double speed_ = 0;
  double step_ = 0;
};
}  // namespace apf
