// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "altiplan/local_planner.hpp"
#include "field_params.hpp"
#include "terrain_flight.hpp"
#include "threats.hpp"
#include "virtual_targets.hpp"

namespace velocity_field {

/// One flight of the published method: level, by the field, the heading held to the least turn
/// radius.
class PaperPilot final : public Pilot {
 public:
  PaperPilot(const Params& params, const Request& request);

 private:
  PilotStep do_step(const Observation& seen) override;
  double do_reach_m() const override {
    return (terrain_ ? terrain_->reach() : field_.ring) + feed_.room();
  }
  Counters do_counters() const override;

  void take_news(const Observation& seen);
  /// V = V_T + sum (V_P + V_G), as a unit vector.
  Vec2 wish(const Observation& seen, const Vec2& here, const Vec2& to_target);
  /// The heading nearest to the wish that the least turn radius leaves, after the step before.
  Vec2 flyable(const Vec2& wish, double step);
  double speed(const Observation& seen) const;
  double step_time(const Observation& seen, double speed) const;
  PilotStep fly(const Observation& seen, const Vec3& ahead, double speed, double dt);
  bool is_level() const { return !terrain_ || !terrain_->climbs(); }
  std::string_view news_of_virtual_target();
  /// After max_steps steps; names a goal too small for them.
  std::string_view why_not_reached(const Observation& seen);

  Params p_;
  Field field_;
  Vehicle vehicle_;
  double min_radius_;
  double min_fillet_;
  double max_turn_;
  double max_step_;
  TurnLimit turn_limit_;
  double limit_step_ = 0;  ///< the length of step that turn_limit_ is for
  ThreatFeed feed_;
  VirtualTargets virtual_targets_;
  std::optional<TerrainFlight> terrain_;  ///< where ground is seen
  std::vector<std::uint32_t> inside_;     ///< threats whose ring the vehicle is in
  std::optional<Vec2> heading_;           ///< of the vehicle; none before the first step
  std::array<char, 160> why_{};
  std::size_t why_length_ = 0;
  std::int64_t told_ = 0;  ///< entries when why_ was written
  std::int64_t steps_ = 0;
  std::int64_t turn_limit_steps_ = 0;
};
}  // namespace velocity_field
