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

bool Walker::fly_hover(std::size_t n) {
  Destination to = destination(n);
  const MissionCommand& command = commands_[n];
  const Task task = task_of(n);
  const bool is_copter = autopilot_.is_copter();
  if (!command.has_position() && hover_->is_on_circle()) {
    return give_up(n, "where on its circle it is when it is sent to its own place is not judged");
  }
  if (task == Task::land || task == Task::vtol_land || task == Task::payload_place) {
    to.low = hover_->low;
    to.high = hover_->high;
    to.above_ground.reset();
    arrive(n, to);
    const double top_low = hover_->low;
    const double top_high = hover_->high;
    hover_->land(n, task == Task::payload_place ? "the descent to place" : "the landing");
    if (task == Task::payload_place) {
      hover_->climb(n, "the climb after placing", top_low, top_high);
      return false;
    }
    return !takes_off_again(n);
  }
  if (task == Task::loiter_turns && is_copter && command.params[2] == 0) {
    // It turns in yaw at 20 degrees a second on its way to the centre, its height unchanged.
    const double reached = 0.7 * hover_->speed_mps[0] * 18 * command.params[0];
    if (to.above_ground || (to.at - hover_->at).norm() > reached) {
      flight_.remark(Weight::not_judged, "not_judged", n,
                     "turns without a radius are judged near the place before, at a height that "
                     "does not follow the ground, alone");
    }
    to.low = hover_->low;
    to.high = hover_->high;
    to.above_ground.reset();
  } else if (task == Task::loiter_turns) {
    const double radius = std::min(std::abs(command.params[2]), 2000.0);
    if (is_copter &&
        std::min(hover_->speed_mps[1], std::sqrt(1.25 * radius)) > parameter("WP_SPD") + 1e-6) {
      flight_.remark(Weight::not_judged, "not_judged", n,
                     "a circle at more than its own speed (WP_SPD), which a copter that cannot "
                     "fly so fast leaves outward, is not judged");
    }
    hover_->circle(n, to, radius, command.params[0], command.params[2] > 0);
    return false;
  }
  if (task == Task::spline) {
    flight_.remark(Weight::not_judged, "not_judged", n,
                   "the curve of a spline is not judged: replace it by waypoints");
  }
  if (task == Task::arc && std::abs(command.params[0]) >= 1) {
    constexpr double kMaxRadius = 100'000;
    const double angle = radians(command.params[0]);
    const double radius = (to.at - hover_->at).norm() / (2 * std::sin(std::abs(angle) / 2));
    if (!to.above_ground && std::abs(angle) < 2 * kPi && radius > 0 && radius <= kMaxRadius) {
      TimeSpan begun = mission_.time;
      // Some versions know of an arc from a waypoint before it alone, of the same kind of height.
      if (hover_->stops || formats::is_above_ground(commands_[flight_.before].frame)) {
        Hover(*hover_).go(n, "", to);
        std::swap(mission_.time, begun);
      }
      hover_->arc(n, to, angle);
      hover_->stops = false;
      return false;
    }
    flight_.remark(
        Weight::not_judged, "not_judged", n,
        "an arc above the ground, of a full turn or more, or of more than 100 km radius, "
        "is not judged");
  }
  // PX4 changes its height there; so does ArduPilot where the height is 0.
  if (task == Task::loiter_to_altitude && (is_px4() || (is_copter && command.altitude_m == 0))) {
    Destination level = to;
    level.low = hover_->low;
    level.high = hover_->high;
    level.above_ground.reset();
    arrive(n, level);
    hover_->climb(n, "the way to its height", to.low, to.high);
    return false;
  }
  const double acceptance =
      task == Task::waypoint && std::isfinite(command.params[1]) ? command.params[1] : 0;
  hover_->next_acceptance_m = acceptance;
  arrive(n, to);
  const double hold = task == Task::waypoint || task == Task::loiter_time || task == Task::spline
                          ? command.params[0]
                          : 0;
  hover_->acceptance_m = acceptance;
  hover_->stops = hold > 0 || task != Task::waypoint;
  if (hold > 0) {
    flight_.hold(hold);
  }
  if (task == Task::loiter_forever) {
    flight_.take({0, kInfinity});
    return !goes_on_when_told(n, "stays here for ever");
  }
  return false;
}

// AP_Mission::continue_after_land_check_for_takeoff, Copter::auto_disarm_check. What is not known
// of the parameters is judged as if the flight went on, which holds the one that ends here.
bool Walker::takes_off_again(std::size_t n) {
  constexpr int kContinueAfterLand = 1 << 2;
  if (is_px4() || !autopilot_.is_copter()) {  // PX4 refuses a second take-off
    return false;
  }
  double waits_s = 0;
  std::size_t next = n + 1;
  for (; next < commands_.size(); ++next) {
    const Task task = task_of(next);
    if (task == Task::delay) {
      const double seconds = commands_[next].params[0];
      waits_s += seconds > 0 ? seconds : kInfinity;  // until a time of day
    } else if (task == Task::jump || task == Task::jump_to_tag) {
      if (flight_.is_given("MIS_OPTIONS") && (int(parameter("MIS_OPTIONS")) & kContinueAfterLand)) {
        give_up(next, "whether it takes off again after a jump behind its landing is not judged");
      }
      return false;
    } else if (task != Task::payload && task != Task::speed && task != Task::condition &&
               task != Task::set_home && task != Task::fence && task != Task::jump_tag) {
      break;  // the others move nothing
    }
  }
  if (next == commands_.size() ||
      (task_of(next) != Task::take_off && task_of(next) != Task::vtol_take_off)) {
    return false;
  }
  const double disarms_s = parameter("DISARM_DELAY");
  const bool disarms = disarms_s > 0 && waits_s >= disarms_s;
  if ((flight_.is_given("MIS_OPTIONS") && !(int(parameter("MIS_OPTIONS")) & kContinueAfterLand)) ||
      (flight_.is_given("DISARM_DELAY") && disarms)) {
    return false;
  }
  if (!flight_.is_given("MIS_OPTIONS") || disarms) {
    flight_.remark(Weight::note, "takes_off_again", n,
                   std::string("takes off again with MIS_OPTIONS 4") +
                       (disarms ? " and DISARM_DELAY 0 or above its wait" : "") +
                       " alone: else the flight ends here");
  }
  return true;
}

void Walker::arrive(std::size_t n, const Destination& to) {
  constexpr double kThere = 1e-3;
  const bool is_there = (to.at - hover_->at).norm() < kThere &&
                        std::abs(to.low - hover_->low) < kThere && flight_.before == n;
  if (!is_there) {
    hover_->go(n, "", to);
  } else if (!commands_.next_position(n)) {
    hover_->go(n, "its place", to);
  }
}

void Walker::fly_wing_to(std::size_t n, const char* what, const Destination& to, bool at_once) {
  const MissionCommand& command = commands_[n];
  Wing::Leg leg{to, next_destination(n)};
  leg.at_once = at_once;
  if (task_of(n) == Task::waypoint && !is_px4()) {
    leg.acceptance_m = command.params[1] > 0 ? command.params[1] : 0;
    leg.pass_by_m = command.params[2] > 0 ? command.params[2] : 0;
    leg.turns_at_90 = n + 1 < commands_.size() && task_of(n + 1) == Task::delay;
  }
  wing_->go(n, what, leg);
}

bool Walker::fly_wing(std::size_t n) {
  const Task task = task_of(n);
  Destination to = destination(n);
  const bool lands = task == Task::land || task == Task::vtol_land || task == Task::payload_place;
  if (!commands_[n].has_position()) {
    return give_up(n, "where on its way it is when it is sent to its own place is not judged");
  }
  if (lands && autopilot_.airframe == Airframe::vtol) {
    to.low = wing_->low();
    to.high = wing_->high();
    to.above_ground.reset();
    const Eigen::Vector2d track = (to.at - wing_->mean_place()).normalized();
    const double v = wing_->speed_mps[1] + flight_.wind_mps;
    if (!is_px4() && (to.at - wing_->mean_place()).norm() < v * v / (2 * kVtolBrakes)) {
      flight_.remark(Weight::not_judged, "not_judged", n,
                     "lies nearer than it can slow down on wings: how it gets here is not judged");
    }
    fly_wing_to(n, "", to, true);
    if (is_px4()) {  // it may drift beyond while it slows down
      constexpr double kReach = 8;
      const Eigen::Vector2d beyond = to.at + v * v / (2 * kVtolBrakes) * track;
      flight_.begin(n, "the change to hover");
      flight_.add_strip({to.at.x(), to.at.y(), to.low}, to.high, {beyond.x(), beyond.y(), to.low},
                        to.high, kReach);
      flight_.take({0, v / 2});
    }
    hover_.emplace(flight_, to.at, wing_->low());
    hover_->high = wing_->high();
    is_winged_ = false;
    hover_->land(n, "the landing");
    return true;
  }
  if (task == Task::land) {
    wing_->land(n, to);
    flight_.remark(Weight::note, "abort", n, "where an aborted landing flies is not judged");
    return true;
  }
  switch (task) {
    case Task::loiter_forever:
    case Task::loiter_turns:
    case Task::loiter_time:
    case Task::loiter_to_altitude:
      return circle_wing(n, to);
    default:
      if (flight_.before != n || !commands_.next_position(n)) {  // else it begins there
        fly_wing_to(n, "", to, false);
      }
      return false;
  }
}

bool Walker::circle_wing(std::size_t n, const Destination& to) {
  const MissionCommand& command = commands_[n];
  const Task task = task_of(n);
  const double own = parameter(is_px4() ? "NAV_LOITER_RAD" : "WP_LOITER_RAD");
  double given = command.params[task == Task::loiter_to_altitude ? 1 : 2];
  given = std::isfinite(given) ? given : 0;
  const bool is_own = is_px4() ? given == 0 : std::abs(given) <= 1 || task == Task::loiter_time;
  const double radius = is_own ? std::abs(own) : std::abs(given);
  const bool clockwise = given != 0 ? given > 0 : own >= 0;
  Wing::Leg leg{to, next_destination(n)};
  leg.acceptance_m = leg.circle_m = radius;
  leg.at_once = is_px4() && task != Task::loiter_to_altitude;
  if (is_px4() && task == Task::loiter_to_altitude) {
    leg.to.low = leg.to.high = wing_->low();  // level to the circle
    leg.at_once = true;
  }
  const bool follows_circle = task_of(flight_.before) == Task::loiter_turns ||
                              task_of(flight_.before) == Task::loiter_time ||
                              task_of(flight_.before) == Task::loiter_to_altitude;
  if (follows_circle && !is_px4()) {
    flight_.remark(Weight::not_judged, "not_judged", n,
                   "some versions take a circle after a circle for reached, and leave it at once");
  }
  wing_->go(n, "", leg);
  Wing::Stay stay;
  stay.turns = task == Task::loiter_turns ? command.params[0] : 0;
  stay.seconds = task == Task::loiter_time ? command.params[0] : 0;
  stay.until_high = task == Task::loiter_to_altitude;
  wing_->circle(n, "its circle", to, radius, clockwise, stay, leg.next, command.params[3] > 0);
  if (task == Task::loiter_forever) {
    flight_.take({0, kInfinity});
    return !goes_on_when_told(n, "stays here for ever");
  }
  return false;
}
}  // namespace altiplan::host
