// SPDX-License-Identifier: Apache-2.0
#include "host/autopilot/walker.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {

using formats::Airframe;
using formats::MissionCommand;
using formats::Task;
using Weight = Remark::Weight;

bool Walker::delay(std::size_t n) {
  if (!autopilot_.is_copter()) {
    if (is_px4()) {
      flight_.remark(Weight::not_judged, "not_judged", n, "where an aeroplane waits is not judged");
    }
    return false;
  }
  const double seconds = commands_[n].params[0];
  constexpr double kDay = 86400;
  if (seconds > 0) {
    flight_.hold(seconds);
  } else {
    flight_.take({0, kDay});
  }
  if (hover_) {
    hover_->go_on_circling(seconds > 0 ? seconds : kDay);
    hover_->stops = true;
  }
  return false;
}

bool Walker::set_home(std::size_t n) {
  constexpr int kMaxHomes = 100;
  constexpr double kLevel = 0.5;  // metres
  const MissionCommand& command = commands_[n];
  const bool is_nowhere = !command.has_position() && command.altitude_m == 0;
  const bool is_here = command.params[0] == 1 || (is_nowhere && autopilot_.is_copter());
  former_home_z_ = home_z_;
  if (is_pending_) {
    const bool has_condition = std::any_of(orders_.begin(), orders_.end(), [&](std::size_t k) {
      return task_of(k) == Task::condition;
    });
    return give_up(n, has_joined_ && !has_condition
                          ? "whether it sets its home where it joins the mission is not judged"
                          : "whether and when a condition lets it set its home is not judged");
  }
  if (++homes_set_ > kMaxHomes) {
    return give_up(n, "sets its home more than 100 times: what it flies then is not judged");
  }
  if (is_here && (is_winged_ || (hover_ && hover_->is_on_circle()))) {
    give_up(n, "where on its way it is when it sets its home there is not judged");
  }
  if (is_here && high() - low() > kLevel) {
    give_up(n, "how high it is when it sets its home there is not judged");
  }
  const auto next = commands_.next_position(n);
  const bool takes_off =
      next && (task_of(*next) == Task::take_off || task_of(*next) == Task::vtol_take_off);
  if (is_here && !has_flown_ && !takes_off) {
    return give_up(n, "where it is when it sets its home there is not judged");
  }
  if (is_here) {
    home_ = here();
    home_z_ = low();
  } else if (formats::is_above_ground(command.frame)) {
    return give_up(n, "a home at a height above the ground is not judged");
  } else {
    home_ = to_local(command.lon, command.lat);
    home_z_ =
        formats::is_of_home(command.frame) ? home_z_ + command.altitude_m : command.altitude_m;
  }
  has_new_home_ = true;
  flight_.remark(Weight::note, "set_home", n,
                 "from here on heights relative to home count from " +
                     std::to_string(int(std::lround(home_z_))) + " m above sea level");
  return false;
}

void Walker::set_hover_speed() {
  if (hover_speed_[1] > 0 && hover_) {
    hover_->speed_mps[0] = hover_speed_[0];
    hover_->speed_mps[1] = hover_speed_[1];
  }
  if (climb_rate_[1] > 0 && hover_) {
    std::copy_n(climb_rate_, 2, hover_->climb_mps);
  }
  if (sink_rate_[1] > 0 && hover_) {
    std::copy_n(sink_rate_, 2, hover_->sink_mps);
  }
}

void Walker::set_wing_speed() {
  if (options_.wind_mps > min_airspeed() / 2) {
    give_up(0, "flight in a wind of more than half its minimum airspeed, " +
                   with_digits(min_airspeed(), 3) +
                   " m/s, is not judged: give its parameters (--params), or less wind");
  } else if (options_.wind_mps == 0) {
    flight_.remark(Weight::note, "wind", 0, "is judged in still air (--wind)");
  }
  if (wing_speed_[1] > 0) {
    wing_->set_speed(wing_speed_[0], wing_speed_[1]);
    return;
  }
  const char* name = is_px4() ? "FW_AIRSPD_TRIM" : "AIRSPEED_CRUISE";
  const double cruise = parameter(name);
  const double planned = plan_.cruise_mps > 0 && !parameters_.is_given(name)
                             ? std::clamp(plan_.cruise_mps, min_airspeed(), max_airspeed())
                             : cruise;
  wing_->set_speed(std::min(cruise, planned), std::max(cruise, planned));
}

void Walker::change_rate(std::size_t n) {
  constexpr double kFastest = 10;  // the range of WP_SPD_UP and of WP_SPD_DN
  const double value = commands_[n].params[1];
  const bool is_climb = commands_[n].params[0] == 2;
  if (value <= 0 || !(is_climb || commands_[n].params[0] == 3)) {
    return;
  }
  if (value > kFastest) {
    give_up(n, "a rate of climb or descent above 10 m/s is not judged");
  }
  const double rates[2] = {value, value};
  take_speed(true, rates, is_climb ? climb_rate_ : sink_rate_,
             parameter(is_climb ? "WP_SPD_UP" : "WP_SPD_DN"));
  set_hover_speed();
}

void Walker::change_speed(std::size_t n) {
  const auto& p = commands_[n].params;
  const double value = p[1];
  if (autopilot_.is_copter() && !is_px4() && p[0] != 0 && p[0] != 1) {
    change_rate(n);
    return;
  }
  double speeds[2] = {value, value};
  bool counts = value > 0;
  if (autopilot_.is_copter()) {
    if (is_px4()) {
      const double own = flight_.cruise_mps();
      const double limited = std::min(value, parameter("MPC_XY_VEL_MAX"));
      speeds[0] = speeds[1] = value > 0 ? limited : own;
      counts = true;
    }
    take_speed(counts, speeds, hover_speed_, flight_.cruise_mps());
    set_hover_speed();
    return;
  }
  const double cruise = parameter(is_px4() ? "FW_AIRSPD_TRIM" : "AIRSPEED_CRUISE");
  if (is_px4()) {
    speeds[0] = speeds[1] = value > 0 ? std::clamp(value, min_airspeed(), max_airspeed()) : cruise;
    counts = true;
  } else if (p[0] == 1) {  // a minimum ground speed, whatever airspeeds are sought later
    min_ground_mps_ = std::max(is_pending_ ? min_ground_mps_ : 0, std::min(value, max_airspeed()));
    counts = true;
    std::copy(std::begin(airspeed_), std::end(airspeed_), std::begin(speeds));
    if (airspeed_[1] == 0) {
      speeds[0] = speeds[1] = cruise;
    }
  } else {
    counts = p[0] == 0 && (value == -2 || (value >= min_airspeed() && value <= max_airspeed()));
    if (!counts && value > 0) {
      flight_.remark(Weight::note, "speed", n,
                     p[0] == 0 ? "is ignored: it is not from AIRSPEED_MIN to AIRSPEED_MAX, " +
                                     with_digits(min_airspeed(), 3) + " to " +
                                     with_digits(max_airspeed(), 3) + " m/s"
                               : "is ignored by aeroplanes");
    }
    speeds[0] = speeds[1] = value == -2 ? cruise : value;
    take_speed(counts, speeds, airspeed_, cruise);
  }
  speeds[1] = std::max(speeds[1], min_ground_mps_);
  take_speed(counts, speeds, wing_speed_, cruise);
  if (counts) {
    const bool is_first = all_wing_speeds_[1] == 0;
    all_wing_speeds_[0] = is_first ? speeds[0] : std::min(all_wing_speeds_[0], speeds[0]);
    all_wing_speeds_[1] = std::max(all_wing_speeds_[1], speeds[1]);
  }
  if (wing_) {
    set_wing_speed();
  }
}

// Returns, and PX4's transitions, are flown at the vehicle's own speeds; at those of the mission
// too, in case.
void Walker::forget_speeds() {
  const auto widen = [](double* speeds, double own) {
    if (speeds[1] > 0) {
      speeds[0] = std::min(speeds[0], own);
      speeds[1] = std::max(speeds[1], own);
    }
  };
  if (hover_ && autopilot_.is_copter()) {
    widen(hover_speed_, flight_.cruise_mps());
    if (!is_px4()) {
      widen(climb_rate_, parameter("WP_SPD_UP"));
      widen(sink_rate_, parameter("WP_SPD_DN"));
    }
    set_hover_speed();
  }
  if (!autopilot_.is_copter()) {
    widen(wing_speed_, parameter(is_px4() ? "FW_AIRSPD_TRIM" : "AIRSPEED_CRUISE"));
    if (wing_) {
      set_wing_speed();
    }
  }
}

void Walker::take_speed(bool counts, const double* speeds, double* present, double own) const {
  if (!counts) {
    return;
  }
  const double before[2] = {present[1] > 0 ? present[0] : own, present[1] > 0 ? present[1] : own};
  present[0] = is_pending_ ? std::min(before[0], speeds[0]) : speeds[0];
  present[1] = is_pending_ ? std::max(before[1], speeds[1]) : speeds[1];
}
}  // namespace altiplan::host
