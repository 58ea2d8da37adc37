// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "altiplan/kit/dubins/steering.hpp"
#include "altiplan/kit/sampling/leg_rules.hpp"

namespace altiplan::kit {

/// The judge's constraints for planners that join poses by the paths of a Steering. The legs of a
/// path are determined by its two poses. Belongs to one search; records the refusals.
class ALTIPLAN_API PathRules {
 public:
  struct Arrival {
    double length = 0;                 ///< of the path, as of Steering
    std::optional<Approach> approach;  ///< to its end
  };

  /// The request must outlive this object.
  PathRules(const Request& request, double turn_radius);

  const Steering& steering() const { return steering_; }
  const LegRules& legs() const { return rules_; }

  /// Where a route may start and arrive: of a free heading and of a loiter circle, some poses.
  std::vector<Pose> starts() const;
  std::vector<Pose> goals() const;

  /// Arrival by the path between two poses for a vehicle that reaches the first by `before`; none
  /// if there is no path, or a constraint refuses a leg of it.
  std::optional<Arrival> arrival(std::optional<Approach> before, const Pose& from, const Pose& to);
  /// True if a path that has been found free may also be flown after another approach to the same
  /// pose: paths meet tangentially, so only constraints that look at slopes or at three points, and
  /// layers of wind, can refuse that.
  bool follows(const std::optional<Approach>& before, const Pose& from, const Pose& to);
  /// True if some constraint can do so.
  bool looks_back() const { return looks_back_; }

  /// The route through poses, at least one, that are joined by paths.
  Route route_through(const std::vector<Pose>& poses) const;

 private:
  const Request& request_;
  LegRules rules_;
  Steering steering_;
  bool looks_back_;
};

inline bool are_same(const Pose& a, const Pose& b) {
  return a.position == b.position && a.heading == b.heading;
}
}  // namespace altiplan::kit
