// SPDX-License-Identifier: Apache-2.0
#pragma once

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

class Walker;

/// The paths on which an autopilot returns when a failsafe ends a mission: to home or a rally
/// point, as its parameters say. Copters and aeroplanes; what else a return may do is remarked as
/// not judged.
class FailsafeReturns {
 public:
  FailsafeReturns(const formats::MissionFile& plan, formats::Autopilot autopilot,
                  const World& world, const FlightOptions& options);
  ~FailsafeReturns();

  /// The mission as it is flown without a failsafe.
  const FlownMission& mission() const { return mission_; }
  /// The return from anywhere in a place at which that command is carried out, whatever the heading
  /// there: its strips contain every path, its time is that of the return alone.
  FlownMission from(std::size_t command, const Whereabouts& place) const;

 private:
  std::unique_ptr<Walker> walker_;
  FlownMission mission_;
};
}  // namespace altiplan::host
