// SPDX-License-Identifier: Apache-2.0
#include "host/autopilot/failsafe_return.hpp"

#include <algorithm>
#include <cmath>

#include "host/autopilot/walker.hpp"

namespace altiplan::host {

FailsafeReturns::FailsafeReturns(const formats::MissionFile& plan, formats::Autopilot autopilot,
                                 const World& world, const FlightOptions& options)
    : walker_(std::make_unique<Walker>(plan, autopilot, world, options)),
      mission_(walker_->fly()) {}

FailsafeReturns::~FailsafeReturns() = default;

FlownMission FailsafeReturns::from(std::size_t command, const Whereabouts& place) const {
  return walker_->return_from(command, place);
}

FlownMission Walker::return_from(std::size_t n, const Whereabouts& place) {
  mission_ = FlownMission{};
  mission_.autopilot = autopilot_;
  failsafe_ = place;
  has_flown_ = true;
  flight_.before = n;
  if (autopilot_.airframe == formats::Airframe::vtol) {
    give_up(n, "the failsafe return of a VTOL is not judged");
  } else if (homes_set_ > 0) {
    give_up(n, "a failsafe return in a mission that sets another home is not judged");
  } else {
    remark_return_parameters(n);
    is_winged_ = !autopilot_.is_copter();
    hover_.reset();
    wing_.reset();
    if (is_winged_) {
      wing_.emplace(flight_);
      wing_->be_anywhere(place);
    } else {
      hover_.emplace(flight_, place.at, place.low_m);
      hover_->high = place.high_m;
    }
    return_home(n);
    check_fences();
  }
  mission_.parameters = parameters_.used();
  return std::move(mission_);
}
}  // namespace altiplan::host
