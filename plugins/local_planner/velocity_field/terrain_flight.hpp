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

/// Ground in a flight by the field: around its sections at the flight's level, and over them where
/// that leads nowhere.
class TerrainFlight {
 public:
  TerrainFlight(const Params& params, const Request& request);

  /// Adopts an observation. Allocates only if the ground or the goal changed.
  void update(const Observation& seen);
  /// V_P + V_G of the disc that represents the sections there.
  Vec2 push(const Field& field, const Vec2& here, const Vec2& to_target);
  /// One step of the length: by the wish, its heading and climb within what the minimum radius
  /// allows after `state`.
  Vec3 step(const State& state, const std::vector<Disc>& threats, const Vec2& wish, double length);

  /// True if it circles above a goal to which it cannot safely descend.
  bool is_kept_above() const { return near_goal_ > kMaxCircling * min_radius_; }
  /// True if the goal's height can be reached.
  bool climbs() const { return slope_ > 0; }
  /// Maximum length of the last leg to the goal.
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
  /// Decides if the flight over the ground is to begin or end.
  void watch_progress(const Vec3& here, double length);
  /// The climb that leads to the level, or down to the goal.
  double wished_climb(const Vec3& here, double radius) const;
  /// The climb, and the heading as near to the wish as the radius then allows.
  Attitude turned(const Attitude& now, const Vec2& wish, double climb, double maximum) const;
  Attitude within_radius(const Vec3& here, const Attitude& now, const Vec2& wish, double length);
  /// True if a straight leg to the goal is free and satisfies every limit. A flight that is not yet
  /// as steep as the leg descends to it from above.
  bool is_last_leg(const Vec3& here, const std::vector<Disc>& threats, const Attitude& now,
                   double maximum) const;

  // Requirements.
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

  // Known world.
  std::vector<std::shared_ptr<const Environment>> grounds_;
  std::optional<TerrainSections> sections_;
  std::vector<float> round_;  ///< gaps to the sections at the flight's level
  std::vector<float> over_;   ///< gaps to ground too high for the ceiling
  Vec3 goal_;
  double level_ = 0;

  // State of the flight.
  bool goes_over_ = false;
  bool last_leg_ = false;
  bool pushed_ = false;      ///< by a section, since the mark
  double mark_ = kInfinity;  ///< distance to the goal from which the detour counts
  double since_mark_ = 0;    ///< length flown since
  double near_goal_ = 0;     ///< length flown close to the goal
  double round_below_ = 0;   ///< distance to the goal at which it may fly level again
  std::int64_t climbs_over_ = 0;
  std::int64_t low_steps_ = 0;
  std::int64_t turn_limit_steps_ = 0;
};
}  // namespace velocity_field
