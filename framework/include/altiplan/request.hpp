// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "altiplan/budget.hpp"
#include "altiplan/constraint.hpp"
#include "altiplan/objective.hpp"
#include "altiplan/random.hpp"
#include "altiplan/trace.hpp"
#include "altiplan/vehicle.hpp"
#include "altiplan/wind.hpp"
#include "altiplan/world.hpp"

namespace altiplan {

/// A point with a tolerance, a pose, or a circle around the position, which a route joins anywhere,
/// tangentially.
struct Goal {
  Vec3 position{0, 0, 0};
  double tolerance_m = 0;
  std::optional<double> heading{};  ///< on arrival, through the air, counter-clockwise from east
  std::optional<Loiter> loiter{};

  bool reached_at(const Vec3& p) const {
    return loiter ? loiter->passes(position, p)
                  : (p - position).norm() <= tolerance_m + kLengthTolerance;
  }
};

/// A planning problem: the complete input of a planner, local planner or smoother.
struct ALTIPLAN_API Request {
  std::shared_ptr<const World> world;  ///< the known world
  Vehicle vehicle;
  State start;  ///< a non-zero velocity gives the heading that the first leg must follow
  Goal goal;
  Wind wind;
  Limits limits;
  std::vector<NamedConstraint> constraints;
  std::shared_ptr<const Objective> objective;  ///< what routes minimise; null: length
  Box volume;                                  ///< bounded
  std::optional<double> level_m;               ///< level flight: z of every waypoint
  Budget budget;
  int threads = 1;
  RandomStream random;
  Trace* trace = nullptr;

  /// The approach to the first point of a route, if the start has a velocity or is a loiter circle:
  /// from the point one second before, or on the tangent.
  std::optional<Approach> before_start(const Vec3& first) const;
  std::optional<Approach> before_start() const { return before_start(start.position); }
  /// Direction over the ground, of any length, that a route must have on arrival at its last point,
  /// if the goal has a heading or is a loiter circle.
  std::optional<Vec3> arrival_course(const Vec3& last) const;
  /// The poses from which a route may start: one if the start has a velocity, else `count` of all
  /// headings, or of all points of the loiter circle.
  std::vector<Pose> start_poses(int count) const;
  /// The poses in which a route may arrive at the goal's position or loiter circle.
  std::vector<Pose> goal_poses(int count) const;
  /// The heading through the air that holds a course over the ground at a place; none if the wind
  /// prevents it.
  std::optional<double> heading_on(const Vec3& course, const Vec3& at) const;
  /// Velocity over the ground of a vehicle with a pose.
  Vec3 ground_velocity(const Pose& pose) const {
    return air_speed() * unit_heading(pose.heading) + wind.at(pose.position);
  }
  /// Airspeed, m/s: of an aeroplane its own, else the vehicle's speed.
  double air_speed() const { return vehicle.wing ? vehicle.wing->airspeed_mps : vehicle.speed_mps; }
  /// A position for messages: "(12, -340, 528)", with longitude and latitude if the world has a
  /// place on the Earth.
  std::string place_text(const Vec3& p) const;
  /// True if what precedes a leg may refuse it by more than a limit on turns.
  bool judges_pairs() const;
  /// True if headings persist through legs that have none, and some limit depends on that.
  bool headings_last() const {
    return !vehicle.turns_on_the_spot &&
           (limits.max_turn_horizontal < kPi || limits.min_turn_radius > 0);
  }
};
}  // namespace altiplan
