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

namespace {

constexpr int kMaxSteps = 100'000;
constexpr std::size_t kFlownAnew = 3;   // times that a leg is flown before it is known
constexpr double kFarthest = 300'000;   // metres
constexpr std::size_t kMaxJumps = 250;  // without a position between them
constexpr const char* kJumpsAlone =
    "jumps from jump to jump: where it flies when the autopilot gives up is not judged";
}  // namespace

FlownMission Walker::fly() {
  place_home();
  remark_parameters();
  if (check_upload(commands_, flight_)) {
    if (const std::string other = parameters_.of_another(); !other.empty()) {
      give_up(0, "the parameters are those of " + other + ", not of " + autopilot_.name() +
                     ": give those of the vehicle that flies it");
    }
    walk(0);
    rests_.clear();  // before it had all its speeds
    check_fences();
  }
  mission_.parameters = parameters_.used();
  return std::move(mission_);
}

Eigen::Vector2d Walker::to_local(double lon, double lat) const {
  const auto [x, y] = world_.frame().to_local(lon, lat);
  return {x, y};
}

void Walker::place_home() {
  if (plan_.home) {
    home_ = to_local(plan_.home->lon, plan_.home->lat);
    home_z_ = plan_.home->altitude_m;
  } else {
    for (std::size_t n = 0; n < commands_.size(); ++n) {
      if (commands_[n].has_position()) {
        home_ = to_local(commands_[n].lon, commands_[n].lat);
        break;
      }
    }
    home_z_ = flight_.ground(home_);
  }
  flight_.home = home_;
  flight_.home_ground = home_z_;
  flight_.wind_mps = options_.wind_mps;
}

Eigen::Vector2d Walker::here() const {
  return is_winged_ ? wing_->mean_place() : hover_ ? hover_->at : home_;
}

bool Walker::keeps_height(const MissionCommand& command) const {
  const Task task = formats::command_task(command.number).task;
  return !is_px4() && autopilot_.is_copter() && command.altitude_m == 0 &&
         (task == Task::waypoint || task == Task::loiter_forever || task == Task::loiter_turns ||
          task == Task::loiter_time || task == Task::spline || task == Task::arc);
}

Destination Walker::destination(std::size_t n) const {
  const MissionCommand& command = commands_[n];
  Destination to;
  to.at = command.has_position() ? to_local(command.lon, command.lat) : here();
  if (keeps_height(command)) {
    to.low = low();
    to.high = high();
    return to;
  }
  if (formats::is_above_ground(command.frame)) {
    const std::optional<double> ground = world_.ground(to.at.x(), to.at.y());
    if (!ground && world_.has_ground()) {
      throw Error(name_of_command(command) +
                  ": its altitude is above ground, and the world has no ground there");
    }
    to.above_ground = command.altitude_m;
    const auto grounds = flight_.known_grounds(to.at);
    const auto [lowest, highest] = std::minmax(grounds[0], grounds[1]);
    to.low = lowest + command.altitude_m;
    to.high = highest + command.altitude_m;
    return to;
  }
  if (!formats::is_of_home(command.frame)) {
    to.low = to.high = command.altitude_m;
    return to;
  }
  if (!plan_.home && !has_new_home_) {
    throw Error(name_of_command(command) +
                ": its altitude is relative to home, and the file has no home position");
  }
  to.low = to.high = home_z_ + command.altitude_m;
  if (former_home_z_) {
    to.low = std::min(to.low, *former_home_z_ + command.altitude_m);
    to.high = std::max(to.high, *former_home_z_ + command.altitude_m);
  }
  return to;
}

std::optional<Destination> Walker::next_destination(std::size_t n) const {
  const auto next = commands_.next_position(n);
  return next ? std::optional(destination(*next)) : std::nullopt;
}

void Walker::walk(std::size_t n) {
  std::size_t jumps = 0;  // since the last command of another kind
  bool ends = false;
  for (int steps = 0; n < commands_.size() && !ends; ++steps) {
    if (steps == kMaxSteps) {
      flight_.remark(Weight::not_judged, "not_judged", n, "the flight has too many steps");
      return;
    }
    if (!commands_.is_done(n)) {
      ++n;
      continue;
    }
    if (commands_.is_jump(n) && has_joined_) {
      give_up(n, "how often a return that has joined the mission jumps is not judged");
      return;
    }
    if (commands_.is_jump(n)) {
      fly_rounds(n);
      const std::optional<std::size_t> next = commands_.after_jump(n);
      if (!next && jumps > 0) {
        give_up(n, kJumpsAlone);
        return;
      }
      if (!next) {
        flight_.take({0, kInfinity});
        flight_.fly_again(commands_.target_of(n).value(), n);
        if (!goes_on_when_told(n, "jumps back for ever")) {
          return;
        }
        ++n;
        continue;
      }
      if (++jumps > kMaxJumps) {
        give_up(n, kJumpsAlone);
        return;
      }
      n = *next;
      continue;
    }
    jumps = formats::flies_to_position(task_of(n)) ? 0 : jumps;
    ends = carry_out(n);
    ++n;
  }
  if (ends && n < commands_.size()) {
    note_unflown(n - 1);
  }
  if (!ends && n == commands_.size() && has_flown_) {
    finish();
  }
}

bool Walker::give_up(std::size_t n, const std::string& why) {
  flight_.remark(Weight::not_judged, "not_judged", n, why);
  return true;
}

void Walker::fly_rounds(std::size_t n) {
  constexpr double kEqual = 1e-6;  // seconds
  Round& last = rounds_[n];
  const TimeSpan time{mission_.time.min_s - last.end.min_s, mission_.time.max_s - last.end.max_s};
  const bool is_alike = way_to(n) == last.way && std::abs(time.min_s - last.time.min_s) < kEqual &&
                        std::abs(time.max_s - last.time.max_s) < kEqual;
  last = {mission_.time, way_to(n), time, is_alike ? last.alike + 1 : 0};
  if (last.alike <= kFlownAnew) {
    return;
  }
  if (const int rounds = commands_.make_all_jumps(n); rounds > 0) {
    flight_.take({rounds * time.min_s, rounds * time.max_s});
    flight_.fly_again(commands_.target_of(n).value(), n);
  }
}

Walker::Way Walker::way_to(std::size_t n) const {
  return {double(flight_.before), double(n),      home_.x(),       home_.y(),       home_z_,
          wing_speed_[0],         wing_speed_[1], hover_speed_[0], hover_speed_[1], climb_rate_[0],
          climb_rate_[1],         sink_rate_[0],  sink_rate_[1]};
}

std::vector<std::size_t> Walker::positions_after(std::size_t n) const {
  std::vector<std::size_t> all;
  for (++n; n < commands_.size(); ++n) {
    if (formats::flies_to_position(task_of(n))) {
      all.push_back(n);
    }
  }
  return all;
}

void Walker::note_unflown(std::size_t n) {
  const std::vector<std::size_t> unflown = positions_after(n);
  if (unflown.empty()) {
    return;
  }
  if (!has_flown_) {
    give_up(unflown.front(), "is not flown: the mission ends before anything is");
    return;
  }
  const std::string last = name_of_command(commands_[unflown.back()]);
  flight_.remark(
      Weight::note, "not_flown", unflown.front(),
      unflown.size() == 1
          ? "is not flown, and not judged: the flight ends before it"
          : "from here to " + last + " nothing is flown, nor judged: the flight ends before it");
}

bool Walker::goes_on_when_told(std::size_t n, const std::string& what) {
  if (has_joined_) {
    const bool is_copter = autopilot_.is_copter();  // an aeroplane's return may end on a circle
    flight_.remark(is_copter ? Weight::fails : Weight::note, "never_ends", n,
                   "a return " + what + ": it does not land");
    return false;
  }
  bool leads_on = !positions_after(n).empty();
  for (std::size_t i = n + 1; i < commands_.size(); ++i) {
    leads_on = leads_on || task_of(i) == Task::return_home;
  }
  flight_.remark(Weight::note, "never_ends", n,
                 what + ": the flight has no end" +
                     (leads_on ? ", and what follows is judged as if it were told to go on" : ""));
  return leads_on;
}

void Walker::note_lost_orders(std::size_t n) {
  const Task task = task_of(n);
  const bool may_be_there = task == Task::waypoint || task == Task::spline;
  if (orders_.size() > 1 && may_be_there && has_flown_ && commands_[n].has_position()) {
    const Destination to = destination(n);
    const double accepts = is_winged_
                               ? 2 * std::max({wing_->farthest_turn(to.low), commands_[n].params[1],
                                               parameter("WP_RADIUS")})
                           : autopilot_.is_copter() ? parameter("WP_RADIUS_M")
                                                    : 2;
    const double above = is_winged_ ? 0 : std::max(to.low - hover_->high, hover_->low - to.high);
    if (std::hypot((to.at - here()).norm(), std::max(above, 0.0)) <= accepts) {
      for (std::size_t i = 1; i < orders_.size(); ++i) {
        const Task order = task_of(orders_[i]);
        if (order == Task::speed || order == Task::set_home || order == Task::fence ||
            order == Task::parachute || order == Task::engine) {
          give_up(orders_[i],
                  "may be lost: the next item is reached at once, and ArduPilot starts one order "
                  "before it alone");
        }
      }
    }
  }
  orders_.clear();
}

bool Walker::carry_out(std::size_t n) {
  constexpr int kLastOfItems = 95;  // MAV_CMD_NAV_LAST
  const Task task = task_of(n);
  if (commands_[n].number > kLastOfItems) {
    orders_.push_back(n);
  } else if (!is_px4()) {
    note_lost_orders(n);
  }
  const auto& p = commands_[n].params;
  switch (task) {
    case Task::take_off:
    case Task::vtol_take_off:
      return take_off(n);
    case Task::return_home:
      return_home(n);
      return true;
    case Task::delay:
      return delay(n);
    case Task::condition:
      is_pending_ = true;
      return false;
    case Task::speed:
      change_speed(n);
      return false;
    case Task::set_home:
      return set_home(n);
    case Task::parachute:
      if (p[0] == 2) {
        flight_.remark(Weight::not_judged, "not_judged", n,
                       "where a parachute drifts is not judged");
        return true;
      }
      return false;
    case Task::change_altitude:
      flight_.remark(Weight::not_judged, "not_judged", n,
                     "where this flies is not judged: replace it by waypoints");
      return true;
    case Task::transition:
      return transition(n);
    default:
      break;
  }
  if (!formats::flies_to_position(task)) {
    return false;
  }
  const bool begins = !has_flown_;
  begin_in_the_air(n);
  if (is_winged_ && !begins && flight_.before == n) {
    return give_up(n,
                   "how an aeroplane turns back to the item that it has just passed is not "
                   "judged");
  }
  if (is_too_far(n, destination(n).at)) {
    return true;
  }
  if (keeps_height(commands_[n]) && formats::is_above_ground(commands_[n].frame)) {
    return give_up(n, "an altitude of 0 keeps the height above the ground, which is not judged");
  }
  Flown& flown = flown_[way_to(n)];
  flight_.repeats = flown.times++;
  if (flight_.repeats > kFlownAnew) {  // nothing new is seen
    flight_.take(flown.time);
    if (is_winged_) {
      wing_.emplace(*flown.wing);
    } else {
      hover_.emplace(*flown.hover);
    }
    flight_.fly_again(n, n);
    flight_.before = n;
    return false;
  }
  const TimeSpan begun = mission_.time;
  const bool ends = is_winged_ ? fly_wing(n) : fly_hover(n);
  if (wing_) {
    flown.wing.emplace(*wing_);
  }
  if (hover_) {
    flown.hover.emplace(*hover_);
  }
  flown.time = {mission_.time.min_s - begun.min_s, mission_.time.max_s - begun.max_s};
  if (flight_.repeats > 0) {
    flight_.fly_again(n, n);
  }
  flight_.before = n;
  former_home_z_.reset();
  is_pending_ = false;
  return ends;
}

bool Walker::is_too_far(std::size_t n, const Eigen::Vector2d& at) {
  const double distance = (at - here()).norm();
  if (distance <= kFarthest) {
    return false;
  }
  flight_.remark(Weight::not_judged, "not_judged", n,
                 "lies " + std::to_string(std::llround(distance / 1000)) +
                     " km away: ways of more than 300 km are not judged");
  return true;
}

FlownMission fly_mission(const formats::MissionFile& plan, formats::Autopilot autopilot,
                         const World& world, const FlightOptions& options) {
  return Walker(plan, autopilot, world, options).fly();
}
}  // namespace altiplan::host
