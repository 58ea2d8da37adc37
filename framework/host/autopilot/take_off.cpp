// SPDX-License-Identifier: Apache-2.0
#include "host/autopilot/walker.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"

namespace altiplan::host {

using formats::Airframe;
using formats::MissionCommand;
using formats::Task;
using Weight = Remark::Weight;

void Walker::begin_in_the_air(std::size_t n) {
  if (has_flown_) {
    return;
  }
  has_flown_ = true;
  flight_.before = n;
  const Destination to = destination(n);
  const bool climbs = is_px4() && autopilot_.is_copter() && plan_.home;
  if (climbs) {
    hover_.emplace(flight_, home_, std::min(home_z_, flight_.ground(home_)));
    hover_->is_on_ground = true;
    hover_->climb(n, "the climb from home", to.low, to.high);
    set_hover_speed();
    return;
  }
  flight_.remark(Weight::note, "no_take_off", n,
                 "the mission has no take-off: it is judged from here on, the way to here is not");
  // A landing sinks from the height at which the vehicle is, whatever its own altitude says.
  const Task task = task_of(n);
  if (task == Task::land || task == Task::vtol_land || task == Task::payload_place) {
    flight_.remark(Weight::not_judged, "not_judged", n,
                   "the height from which it sinks to this landing is not in the mission: begin "
                   "with a take-off or a waypoint");
  }
  if (autopilot_.is_copter()) {
    hover_.emplace(flight_, to.at, to.low);
    hover_->high = to.high;
    set_hover_speed();
  } else {
    is_winged_ = true;
    wing_.emplace(flight_);
    set_wing_speed();
    const auto next = next_destination(n);
    wing_->start(to.at, to.low, next ? next->at : to.at + Eigen::Vector2d(1, 0), true);
    if (plan_.home && next && task_of(n) == Task::waypoint) {
      turn_in(n, to);
    }
  }
}

// It comes from where home lies, as far as is known: the turn at its first item is the mission's.
void Walker::turn_in(std::size_t n, const Destination& to) {
  const Eigen::Vector2d way = to.at - home_;
  const double accepted = is_px4() ? parameter("NAV_ACC_RAD") : commands_[n].params[1];
  const double begins = std::max(wing_->farthest_turn(to.low), accepted);
  if (way.norm() <= begins) {
    return;
  }
  const TimeSpan begun = mission_.time;
  wing_->start(to.at - begins * way.normalized(), to.low, to.at, true);
  fly_wing_to(n, "the turn at its beginning", to, true);
  mission_.time = begun;
}

bool Walker::take_off(std::size_t n) {
  flight_.repeats = 0;
  const bool is_first = !has_flown_;
  if (is_first) {
    flight_.before = n;
    hover_.emplace(flight_, home_, std::min(home_z_, flight_.ground(home_)));
    hover_->is_on_ground = true;
    set_hover_speed();
  } else if (is_px4()) {
    return !autopilot_.is_copter() ? false : fly_hover(n);
  } else if (is_winged_) {
    const bool is_above = autopilot_.airframe == Airframe::plane && low() >= destination(n).high;
    return !is_above && give_up(n, "a take-off in flight is not judged");
  }
  has_flown_ = true;
  if (is_px4() && autopilot_.airframe == Airframe::vtol && task_of(n) == Task::take_off) {
    return give_up(
        n, "takes off as a copter and flies on as one, which is not judged: VTOL take-off (84)");
  }
  if (autopilot_.airframe == Airframe::plane) {
    return take_off_along_runway(n);
  }
  const Destination to = destination(n);
  const double top = top_of_take_off(n, to);
  hover_->climb(n, "the climb after take-off", top, top);
  if (is_px4() && commands_[n].has_position()) {
    Destination there = to;
    there.low = there.high = top;
    if (autopilot_.is_copter()) {
      hover_->go(n, "the way from home", there);
    } else {
      const bool is_here = (there.at - hover_->at).norm() < 1;
      if (!(is_here ? begin_to_next(n) : begin_to_wing(n, there.at))) {
        return true;
      }
      if (!is_here) {
        fly_wing_to(n, "the way from home", there, true);
      }
    }
  } else if (!autopilot_.is_copter() && !begin_to_next(n)) {
    return true;
  }
  flight_.before = n;
  return false;
}

double Walker::top_of_take_off(std::size_t n, const Destination& to) {
  if (autopilot_.airframe == Airframe::vtol && !is_px4()) {
    constexpr int kKeepsFrame = 8;
    const bool keeps_frame = int(parameter("Q_OPTIONS")) & kKeepsFrame;
    if (keeps_frame) {
      return to.low;
    }
    if (!formats::is_of_home(commands_[n].frame)) {
      flight_.remark(
          Weight::fails, "take_off_frame", n,
          "climbs by " + std::to_string(int(commands_[n].altitude_m)) +
              " m from where it stands, whatever the frame of the altitude says: give it "
              "relative to home");
    }
    return hover_->low + commands_[n].altitude_m;
  }
  return std::max(to.low, hover_->low + 1);
}

bool Walker::take_off_along_runway(std::size_t n) {
  const Destination to = destination(n);
  wing_.emplace(flight_);
  set_wing_speed();
  is_winged_ = true;
  std::optional<double> heading;
  if (options_.runway_deg) {
    heading = radians(90 - *options_.runway_deg);
  } else if (is_px4() && (to.at - home_).norm() > 10) {
    heading = std::atan2(to.at.y() - home_.y(), to.at.x() - home_.x());
  }
  if (!heading) {
    flight_.remark(Weight::not_judged, "not_judged", n,
                   "where an aeroplane takes off depends on its runway: give the heading "
                   "(--runway DEGREES)");
    const auto next = next_destination(n);
    wing_->start(to.at, to.low, next ? next->at : to.at + Eigen::Vector2d(1, 0));
    return false;
  }
  wing_->take_off(n, home_, *heading, to.low, is_px4() ? 0 : radians(10));
  flight_.before = n;
  return false;
}

bool Walker::begin_to_wing(std::size_t n, const std::optional<Eigen::Vector2d>& toward) {
  constexpr double kLongest = 15;  // seconds: VT_TRANS_TIMEOUT
  constexpr double kReach = 8;     // metres
  if (!toward || (*toward - hover_->at).norm() < 1) {
    return !give_up(n,
                    "where it speeds up after its climb depends on where it points: a waypoint "
                    "must follow");
  }
  const Eigen::Vector2d begin = hover_->at;
  if (!is_px4()) {  // which turns on the spot first; it speeds up where it points, and turns then
    constexpr double kAlong = radians(15);
    const Eigen::Vector2d way = *toward - begin;
    const double heading = radians(90 - options_.runway_deg.value_or(0));
    const double off = std::remainder(std::atan2(way.y(), way.x()) - heading, 2 * kPi);
    if (!options_.runway_deg || std::abs(off) > kAlong) {
      flight_.remark(Weight::not_judged, "not_judged", n,
                     "how it turns to its way after its climb depends on where it points: give its "
                     "heading (--runway DEGREES), within 15 degrees of that way");
    }
  }
  forget_speeds();
  wing_.emplace(flight_);
  set_wing_speed();
  is_winged_ = true;
  const Eigen::Vector2d end =
      begin + kLongest * wing_->speed_mps[1] * (*toward - begin).normalized();
  flight_.begin(n, "the transition to flight on wings");
  flight_.add_strip({begin.x(), begin.y(), hover_->low}, hover_->high,
                    {end.x(), end.y(), hover_->low}, hover_->high, kReach);
  flight_.take({0, kLongest});
  wing_->start_on(begin, end, hover_->low);
  return true;
}

bool Walker::begin_to_next(std::size_t n) {
  const auto next = next_destination(n);
  return begin_to_wing(n, next ? std::optional(next->at) : std::nullopt);
}

bool Walker::transition(std::size_t n) {
  constexpr double kToWing = 4;
  if (commands_[n].params[0] == kToWing && hover_ && !is_winged_) {
    return !begin_to_next(n);
  } else if (commands_[n].params[0] != kToWing && is_winged_) {
    return give_up(n, "where the vehicle stops when it changes to hover is not judged");
  }
  return false;
}
}  // namespace altiplan::host
