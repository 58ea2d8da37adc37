// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "altiplan/kit/dubins/wind.hpp"
#include "altiplan/plan_result.hpp"
#include "altiplan/request.hpp"

namespace altiplan::kit {

/// A path between two poses without regard to obstacles.
struct PosePath {
  std::vector<Leg> legs;
  double length = 0;  ///< through the air, horizontal, metres: the time by the airspeed
};

/// The motion of an aeroplane in a request: its limits, the air, and what it flies between poses.
class ALTIPLAN_API Steering {
 public:
  /// The request must outlive this object.
  Steering(const Request& request, double radius);

  const AirplaneLimits& limits() const { return limits_; }
  /// True if the wind can hold the aeroplane in one place.
  bool is_too_windy() const { return strongest_ >= speed_; }
  bool is_calm() const { return strongest_ == 0; }
  /// True if the wind is not the same at all heights of the volume.
  bool is_layered() const { return is_layered_; }
  /// Upper bound of the distance over the ground, in units of the length through the air.
  double ground_per_air() const { return (speed_ + strongest_) / speed_; }

  /// The pose at a share of a leg: in layers of wind with the heading that holds the leg's course
  /// in the wind there, which need not be that in which the leg was steered. `heading` is the one
  /// without layers.
  Pose pose_on(const Leg& leg, double share, double heading) const;

  /// A piece of a given length through the air: with a turn (radians, 0: straight) and a gradient.
  Leg piece(const Pose& from, double length, double turn, double gradient) const;
  /// The same that ends in a pose.
  Leg piece_to(const Pose& to, double length, double turn, double gradient) const;

  /// The shortest path through the air to a pose, all in the wind halfway: of poses in
  /// other wind the courses over the ground are kept, as a straight leg keeps its own across a
  /// border. Turns are not flown there, so that constraints refuse such a path. None if there is
  /// none.
  std::optional<PosePath> path(const Pose& from, const Pose& to) const;
  /// Its length; infinite if there is none, or if it is more than `at_most`, which takes less time.
  double length(const Pose& from, const Pose& to, double at_most = kInfinity) const;
  /// A lower bound of that, which takes far less.
  double min_length(const Pose& from, const Pose& to) const;
  /// A lower bound on the length to the goal, of which the ground covered takes at least
  /// `over_ground`.
  double min_length_to_goal(const Pose& from, double over_ground) const;

  /// The pose on a path from a pose after a length through the air, at most that of the path.
  Pose pose_at(const Pose& from, const PosePath& path, double length) const;

 private:
  /// Of the air between two heights.
  Vec3 wind_between(const Pose& from, const Pose& to) const {
    return wind_.at((from.position + to.position) / 2);
  }

  /// The pose with its course over the ground in another wind; none if that does not allow it.
  std::optional<Pose> in_wind(const Pose& pose, const Vec3& wind) const;

  AirplaneLimits limits_;
  double speed_;
  double strongest_ = 0;  ///< wind, m/s
  bool is_layered_ = false;
  const Wind& wind_;
  const Goal& goal_;
};

/// The route of legs, or of a point alone where there are none: equal pieces in a row become one
/// leg where every constraint allows it.
ALTIPLAN_API Route route_of(const std::vector<Leg>& legs, const Vec3& alone,
                            const Request& request);

/// The result of a search in a wind that is as fast as the aeroplane.
ALTIPLAN_API PlanResult too_windy();
/// The result of a request that no search with that turn radius (0: straight legs) can solve: from
/// or to a loiter circle with straight legs, or in too much wind.
ALTIPLAN_API std::optional<PlanResult> unsolvable(const Request& request, double turn_radius);
}  // namespace altiplan::kit
