// SPDX-License-Identifier: Apache-2.0
#include "host/autopilot/failsafe_return.hpp"

#include <algorithm>
#include <cmath>

#include "host/autopilot/walker.hpp"

namespace altiplan::host {
namespace {
constexpr double kBesideGlide = 3;  // metres that its line is kept within
}

FailsafeReturns::FailsafeReturns(const formats::MissionFile& plan, formats::Autopilot autopilot,
                                 const World& world, const FlightOptions& options)
    : walker_(std::make_unique<Walker>(plan, autopilot, world, options)),
      mission_(walker_->fly()) {}

FailsafeReturns::~FailsafeReturns() = default;

bool FailsafeReturns::may_return_from(const FlownPart& part) const {
  return walker_->may_return_from(part);
}

FlownMission FailsafeReturns::from(std::size_t command, const Whereabouts& place) const {
  return walker_->return_from(command, place);
}

Glide FailsafeReturns::glide_in(const Whereabouts& place, double ratio, double lowest_m) const {
  return walker_->glide_in(place, ratio, lowest_m);
}

FlownMission FailsafeReturns::glide(std::size_t command, const Whereabouts& place,
                                    const Glide& glide, const Vec3& site) const {
  return walker_->glide(command, place, glide, site);
}

// It may be as fast as the mission has it fly anywhere.
void Walker::be_anywhere(const Whereabouts& place) {
  std::copy(std::begin(all_wing_speeds_), std::end(all_wing_speeds_), std::begin(wing_speed_));
  is_winged_ = true;
  hover_.reset();
  wing_.emplace(flight_);
  wing_->be_anywhere(place);
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
    TimeSpan end{kInfinity, 0};
    for (const Failsafe failsafe : failsafes(n)) {
      mission_.time = {};
      if (!autopilot_.is_copter()) {
        be_anywhere(place);
      } else {
        hover_.emplace(flight_, place.at, place.low_m);
        hover_->high = place.high_m;
      }
      const bool joins =
          failsafe == Failsafe::returns ? fly_on(n, place) : join_mission(n, failsafe, place);
      if (!joins) {
        return_home(n);
      }
      end = {std::min(end.min_s, mission_.time.min_s), std::max(end.max_s, mission_.time.max_s)};
    }
    mission_.time = end;
    check_fences();
  }
  mission_.parameters = parameters_.used();
  return std::move(mission_);
}

Glide Walker::glide_in(const Whereabouts& place, double ratio, double lowest_m) {
  mission_ = FlownMission{};
  be_anywhere(place);
  forget_speeds();
  return wing_->glide_in(place, ratio, lowest_m);
}

FlownMission Walker::glide(std::size_t n, const Whereabouts& place, const Glide& glide,
                           const Vec3& site) {
  mission_ = FlownMission{};
  mission_.autopilot = autopilot_;
  const Eigen::Vector2d to = site.head<2>();
  flight_.before = n;
  flight_.begin(n, "the glide");
  const double length = (to - place.at).norm();
  const double high = place.high_m + glide.zoom_m;
  const double there_m = std::max(length, glide.turned_m + 1);
  flight_.add_fan(place, glide.room_m, to,
                  {{glide.turned_m, place.low_m - glide.turn_loss_m, high},
                   {there_m, place.low_m - glide.lost_m(there_m), high}},
                  kBesideGlide);
  flight_.begin(n, "the circle over its site");
  const double low = place.low_m - glide.lost_m(length);
  flight_.add_tower({to, glide.circle_m, 0, 0}, low, high, kBesideGlide);
  // Somewhere below it comes down, which zones may close; the ground is the site's.
  flight_.begin(n, "the way down to its site").ground = FlownPart::Ground::touched_from_above;
  flight_.add_tower({to, glide.circle_m, 0, 0}, std::min(site.z(), low), low, kBesideGlide);
  mission_.parameters = parameters_.used();
  return std::move(mission_);
}
}  // namespace altiplan::host
