// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "altiplan/local_planner.hpp"
#include "field_params.hpp"
#include "terrain_sections.hpp"

namespace velocity_field {

/// The ground in a flight by the field: round its sections at the flight's level, and over them
/// where that leads nowhere.
class TerrainFlight {
 public:
  TerrainFlight(const Params& params, const Request& request);

  /// Takes over what is observed. Allocates only where the ground or the goal changed.
  void update(const Observation& seen);
  /// V_P + V_G of the disc that stands for the sections there.
  Vec2 push(const Field& field, const Vec2& here, const Vec2& to_target);
  /// One step of the length: by the wish, its heading and climb within what the least radius allows
  /// after `state`.
  Vec3 step(const State& state, const std::vector<Disc>& threats, const Vec2& wish, double length);

  /// Whether it circles above a goal that it does not dare to go down to.
  bool is_kept_above() const { return near_goal_ > kMaxCircling * min_radius_; }
  /// Whether the goal's height can be flown to.
  bool climbs() const { return slope_ > 0; }
  /// How far the last leg to the goal may be.
  double reach() const { return climbs() ? 3 * ring_ : ring_; }
  std::string_view why() const;
  std::int64_t climbs_over() const { return climbs_over_; }
  std::int64_t low_steps() const { return low_steps_; }
  std::int64_t turn_limit_steps() const { return turn_limit_steps_; }

 private:
  static constexpr double kMaxCircling = 60;
  struct Attitude {
    Vec2 heading{1, 0};
    double climb = 0;
  };
  void look_at_ground(const World& world);
  void set_level();
  double radius_at(double length) const;
  /// Height lost against a climb at the limit while pulling up from the climb.
  double lag(double climb, double radius) const;
  /// Whether the way over is to be begun or ended.
  void watch_progress(const Vec3& here, double length);
  /// The climb that leads to the level, or down to the goal.
  double wished_climb(const Vec3& here, double radius) const;
  /// The climb, and the heading as near the wish as the radius leaves beside it.
  Attitude turned(const Attitude& now, const Vec2& wish, double climb, double most) const;
  Attitude within_radius(const Vec3& here, const Attitude& now, const Vec2& wish, double length);
  /// Whether a straight leg to the goal is free and keeps every limit. A flight that is not yet as
  /// steep as the leg comes down to it from above.
  bool is_last_leg(const Vec3& here, const std::vector<Disc>& threats, const Attitude& now,
                   double most) const;

  // What is asked.
  Box volume_;
  double min_radius_;
  double min_fillet_;
  double max_turn_level_;
  double max_turn_space_;
  double max_climb_;
  double slope_;  ///< of max_climb_
  double detour_;
  double ring_;
  GroundRules rules_;
  double start_height_;

  // What is known.
  std::vector<std::shared_ptr<const Environment>> grounds_;
  std::optional<TerrainSections> sections_;
  std::vector<float> round_;  ///< gaps to the sections at the flight's level
  std::vector<float> over_;   ///< gaps to ground too high for the ceiling
  Vec3 goal_;
  double level_ = 0;

  // How the flight stands.
  bool goes_over_ = false;
  bool last_leg_ = false;
  bool pushed_ = false;      ///< by a section, since the mark
  double mark_ = kInfinity;  ///< distance to the goal from which the detour counts
  double since_mark_ = 0;    ///< length flown since
  double near_goal_ = 0;     ///< length flown close to the goal
  double round_below_ = 0;   ///< distance to the goal at which it may be level flight again
  std::int64_t climbs_over_ = 0;
  std::int64_t low_steps_ = 0;
  std::int64_t turn_limit_steps_ = 0;
};
}  // namespace velocity_field
