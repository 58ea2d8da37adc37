// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "host/autopilot/failsafe_return.hpp"

namespace altiplan::host {

/// A part of a flight as places in which the vehicle may be, and when it is there: in the middle
/// between the fastest and the slowest flight. Along a part time passes evenly, but for what it
/// waits at its end.
class FlownPlaces {
 public:
  FlownPlaces(const FlownPart& part, std::array<double, 2> time_s, double before_latest_s,
              const Eigen::Vector2d& to);

  const FlownPart& part() const { return *part_; }
  double end_s() const { return time_s_[1]; }

  using Judge = std::function<bool(const Whereabouts&)>;
  using Refuse = std::function<void(const Whereabouts&)>;
  /// What holds for a place holds for every part of it: places that together cover the strips begin
  /// wide, and are halved until they are valid, or refused when they are `finest_m` long.
  void judge(double finest_m, const Judge& is_valid, const Refuse& refuse) const;

  /// Latest time, of the slowest flight, at which it may be in a place.
  double latest_s(const Whereabouts& place) const;
  /// From when to when it may be in a place that is so long.
  std::array<double, 2> times_of(const Whereabouts& place, double length_m) const;

 private:
  /// How much of the part's way is flown so far beyond the place.
  double share_of(const Whereabouts& place, double beyond_m, double unknown) const;

  const FlownPart* part_;
  std::array<double, 2> time_s_;
  double before_latest_s_;
  Eigen::Vector2d from_;
  Eigen::Vector2d to_;
  double waits_within_m_ = 0;  ///< of its end
};

/// The parts of a mission that are flown somewhere, in their order.
std::vector<FlownPlaces> flown_places_of(const FlownMission& mission,
                                         const formats::MissionFile& plan, const Frame& frame);
}  // namespace altiplan::host
