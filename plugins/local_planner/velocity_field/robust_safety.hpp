// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "robust_guide.hpp"
#include "threats.hpp"

namespace velocity_field {

/// A place, and the course of the step that led to it: a unit vector.
struct Pose {
  Vec2 at{0, 0};
  Vec2 course{1, 0};
};

/// Steps of one length; the corners of the tightest turn, at most a right angle a step, lie on a
/// circle of the least radius.
class Steps {
 public:
  Steps(double length_m, double min_radius_m, double max_turn);
  double length_m() const { return length_m_; }
  double radius_m() const { return radius_m_; }
  Vec2 limited(const Vec2& course, const Vec2& wish) const {
    return limit_.held(course, wish.normalized());
  }
  Pose after(const Vec2& at, const Vec2& course) const { return {at + length_m_ * course, course}; }
  /// After the tightest turn to that side, +1 left or -1 right.
  Pose turned(const Pose& pose, int side) const;
  /// Of the circle whose inside holds all further steps of that turn.
  Vec2 circle_centre(const Pose& pose, int side) const;

 private:
  double length_m_;
  double radius_m_;
  TurnLimit limit_;
  TurnLimit half_;
};

/// Which moves enter no threat: exact, no samples.
class Freedom {
 public:
  /// The threats' reach must be at least reach_m(steps).
  Freedom(const Threats& threats, const Steps& steps) : threats_(&threats), steps_(steps) {}
  static double reach_m(const Steps& steps) { return 2 * (steps.radius_m() + steps.length_m()); }

  const Steps& steps() const { return steps_; }
  bool is_leg_free(const Vec2& a, const Vec2& b) const;
  /// Whether the tightest turn to that side can be flown for ever.
  bool is_circle_free(const Pose& pose, int side) const;
  /// The side of a free circle, the one toward `target` before the other; 0 where there is none.
  int free_circle(const Pose& pose, const Vec2& target) const;

 private:
  const Threats* threats_;
  Steps steps_;
};

/// Steps that end where a circle is free: while they are flown no threat is entered, and on the
/// circle none ever.
struct WayOut {
  std::vector<Vec2> courses;  ///< of the steps, the next one last
  int circle = 0;             ///< its side; 0: it ends at the goal instead

  bool is_free(const Freedom& freedom, const Pose& from) const;
  Vec2 end(const Steps& steps, const Vec2& from) const;
};
}  // namespace velocity_field
