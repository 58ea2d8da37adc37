// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "robust_safety.hpp"

namespace velocity_field {

/// One flight of the `robust` variant, in 2-D: the field attracts toward a virtual target that
/// moves along a guide, and a step is taken only if an escape path is known after it.
class RobustFlight {
 public:
  enum class Kind : std::uint8_t { field, way_out, circle, unproven };
  struct Counts {
    std::int64_t guides = 0;
    std::int64_t turn_limit_steps = 0;
    std::int64_t way_out_steps = 0;
    std::int64_t circle_steps = 0;
    std::int64_t unproven_steps = 0;
    std::int64_t ways_out_lost = 0;
  };

  /// The threats must outlive the flight; their reach must be at least that of `Freedom`. A guide
  /// search obeys the budget's deadline and stop token.
  RobustFlight(const Field& field, const Threats& threats, const Steps& steps,
               const altiplan::Budget& budget = {});

  /// Adopts the current threats and the goal: searches for a guide, and keeps the escape path if it
  /// is still free. Not part of a step: takes memory and a search.
  void set_world(const Vec2& goal, double tolerance_m, const Vec2& at,
                 const std::optional<Vec2>& course);
  /// Changes the length or turn of the following steps.
  void set_steps(const Steps& steps) { freedom_ = Freedom(*threats_, steps); }
  /// Must be called if the vehicle is not where the last step led, or the steps have changed.
  void check_way_out(const Vec2& at, const std::optional<Vec2>& course);

  bool has_guide() const { return !guide_.empty(); }
  /// True if a guide may exist that was not found, as the search exceeded its limits.
  bool gave_up() const { return effort_.given_up; }
  /// True if an escape path is known; without a course, if there is a course with one.
  bool is_safe() const { return safe_; }
  /// Threats farther away than this affect the vehicle only after it has moved: no chosen guide
  /// leads there.
  double reach_m() const;
  const Steps& steps() const { return freedom_.steps(); }
  const Guide& guide() const { return guide_; }
  const WayOut& way_out() const { return way_out_; }
  const Counts& counts() const { return counts_; }

  /// The next step; `course` is that of the last one, empty before the first. `push` is added to
  /// the field.
  Pose step(const Vec2& at, const std::optional<Vec2>& course, const Vec2& push = {0, 0});
  Kind kind() const { return kind_; }  ///< of the last step

 private:
  void find_guide(const Vec2& at, const std::optional<Vec2>& course);
  /// The shortest path that keeps the berth from all threats; empty if there is none.
  Guide guide_with(double berth, const Vec2& at, const std::optional<Vec2>& course);
  /// The point of the guide beside the vehicle, starting from that of the previous step.
  double follow(const Vec2& at, double along) const;
  /// V_T: to the virtual target, ahead on the guide; advances `along`.
  Vec2 pull(const Vec2& at, const std::optional<Vec2>& course, double& along) const;
  /// V_T + sum (V_P + V_G).
  Vec2 wish(const Vec2& at, const Vec2& pull, const Vec2& push) const;
  /// A step by the field or, if there is no course yet, one as near to it as possible.
  std::optional<Pose> follow_field(const Vec2& at, const std::optional<Vec2>& course,
                                   const Vec2& push);
  std::optional<Pose> begin_flight(const Vec2& at, const Vec2& wish);
  /// If nothing is proven: the step, of three, with the most free distance.
  Pose roomiest(const Pose& pose) const;

  void begin_way_out(const Pose& from);
  /// Searches an escape path from there and keeps it if found: by the pull, or by one manoeuvre.
  bool find_way_out(const Pose& from);
  bool follow_pull(Pose& pose);
  /// Straight on, or by the tightest turn to one side.
  bool go_on(const Pose& from);
  /// Adds a step as near to the wish as possible, if it is free.
  bool try_step(Pose& pose, const Vec2& wish);
  bool ends_in_circle(const Pose& pose);
  bool is_goal(const Vec2& at) const { return (at - goal_).norm() <= tolerance_m_; }

  Field field_;
  const Threats* threats_;
  Freedom freedom_;
  GuideEffort effort_;
  Guide guide_;
  Vec2 goal_{0, 0};
  double tolerance_m_ = 0;
  double along_ = 0;     ///< position of the guide's point beside the vehicle
  bool pushed_ = true;   ///< true if the guide keeps off threats far enough for their push
  double circling_ = 0;  ///< metres of circles since the guide was found
  WayOut way_out_;
  WayOut tried_;  ///< its courses in the order of flight
  bool safe_ = true;
  bool known_ = false;  ///< true if an escape path is to be kept
  Kind kind_ = Kind::field;
  Counts counts_;
};
}  // namespace velocity_field
