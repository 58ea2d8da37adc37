// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>

#include "host/autopilot/flown_mission.hpp"

namespace altiplan::host {

/// Where a vehicle may be when a failsafe sends it home: anywhere above a disc, between two
/// heights.
struct Whereabouts {
  Eigen::Vector2d at{0, 0};  ///< local metres
  double radius_m = 0;
  double low_m = 0;  ///< above sea level
  double high_m = 0;
};

/// How an aeroplane without its engine comes down over the ground, from anywhere in a place, at any
/// heading, in wind from anywhere: it turns toward a site, and glides there straight.
struct Glide {
  double room_m = 0;       ///< beside the place, within which it turns
  double turned_m = 0;     ///< from the middle of the place, where it has turned
  double turn_loss_m = 0;  ///< height lost by then
  double ratio = 0;        ///< metres on per metre of height, from then on; 0: the wind holds it
  double circle_m = 0;     ///< radius in which it circles over its site
  double zoom_m = 0;       ///< that it may rise while it slows down to the speed of its glide

  /// Height that is lost at the most to a site so far from the middle of the place.
  double lost_m(double distance_m) const {
    return ratio > 0 ? turn_loss_m + std::max(distance_m - turned_m, 0.0) / ratio : kInfinity;
  }
};

class Walker;

/// The paths on which an autopilot returns when a failsafe ends a mission: to home, a rally point,
/// or ArduPilot's along the mission, as its parameters say. Copters and aeroplanes; what else a
/// return may do is remarked as not judged.
class FailsafeReturns {
 public:
  FailsafeReturns(const formats::MissionFile& plan, formats::Autopilot autopilot,
                  const World& world, const FlightOptions& options);
  ~FailsafeReturns();

  /// The mission as it is flown without a failsafe.
  const FlownMission& mission() const { return mission_; }
  /// False of a part that a failsafe does not end.
  bool may_return_from(const FlownPart& part) const;
  /// The return from anywhere in a place at which that command is carried out, whatever the heading
  /// there: its strips contain every path, its time is that of the return alone.
  FlownMission from(std::size_t command, const Whereabouts& place) const;
  /// Of an aeroplane that glides so far in still air (metres on per metre of height), at the speeds
  /// that it may have; sites are not lower than `lowest_m`.
  Glide glide_in(const Whereabouts& place, double ratio, double lowest_m) const;
  /// The glide to a place above a site, a circle there, and the air below it down to the site. It
  /// may sink less, and is as high as at its beginning at the most.
  FlownMission glide(std::size_t command, const Whereabouts& place, const Glide& glide,
                     const Vec3& site) const;

 private:
  std::unique_ptr<Walker> walker_;
  FlownMission mission_;
};
}  // namespace altiplan::host
