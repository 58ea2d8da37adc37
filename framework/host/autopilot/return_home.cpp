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

void Walker::finish() {
  flight_.repeats = 0;
  const std::size_t last = commands_.size() - 1;
  if (autopilot_.is_copter()) {
    flight_.remark(has_joined_ ? Weight::fails : Weight::note, "end", last,
                   has_joined_ ? "a return along the mission ends in the air: it hovers there"
                               : "the mission ends in the air: it hovers there");
  } else if (is_winged_ && is_px4()) {
    Destination there;
    there.at = wing_->mean_place();
    there.low = wing_->low();
    there.high = wing_->high();
    wing_->circle(last, "the circle at the end", there, parameter("NAV_LOITER_RAD"), true, {}, {},
                  false);
    flight_.take({0, kInfinity});
  } else if (is_winged_) {
    return_home(last);
  }
}

void Walker::return_home(std::size_t n) {
  flight_.repeats = 0;
  if (!has_flown_) {
    return;
  }
  if (const auto joined = return_by_mission(); joined && parameter("RTL_AUTOLAND") != 1) {
    join_mission(n, *joined, failsafe_ ? *failsafe_ : wing_->whereabouts());
    return;
  }
  if (!plan_.home && !has_new_home_) {
    flight_.remark(Weight::not_judged, "not_judged", n,
                   "where home is, to which it returns, the file does not say");
    return;
  }
  if (is_too_far(n, home_)) {
    return;
  }
  const bool are_above_home =
      std::all_of(plan_.rally.begin(), plan_.rally.end(), [](const formats::MissionPoint& rally) {
        return rally.frame == formats::AltitudeFrame::home;
      });
  if (!is_px4() && !are_above_home) {
    give_up(n,
            "some versions take a rally point's height as one above home, whatever its frame: "
            "give it so");
    return;
  }
  const std::optional<Hover> hover = hover_;
  const std::optional<Wing> wing = wing_;
  const bool is_winged = is_winged_;
  const TimeSpan begin = mission_.time;
  const std::size_t begun = mission_.parts.size();
  TimeSpan end{kInfinity, 0};
  for (const Refuge& refuge : refuges()) {
    mission_.time = begin;
    if (hover) {
      hover_.emplace(*hover);
    }
    if (wing) {
      wing_.emplace(*wing);
    }
    is_winged_ = is_winged;
    is_winged_ ? return_wing(n, refuge) : return_hover(n, refuge);
    end = {std::min(end.min_s, mission_.time.min_s), std::max(end.max_s, mission_.time.max_s)};
  }
  mission_.time = end;
  for (std::size_t part = begun; part < mission_.parts.size(); ++part) {
    mission_.parts[part].is_return = true;
  }
  flight_.before = n;
}

int Walker::type_of_return() const {
  return is_px4() ? int(std::lround(parameter("RTL_TYPE"))) : 0;
}

std::optional<std::size_t> Walker::only_landing() const {
  std::optional<std::size_t> landing;
  for (std::size_t n = 0; n < commands_.size(); ++n) {
    const Task task = task_of(n);
    const bool lands = task == Task::land || task == Task::vtol_land;
    if (task == Task::landing_start || (lands && landing)) {
      return std::nullopt;
    }
    landing = lands ? std::optional(n) : landing;
  }
  const bool is_known = landing && task_of(*landing) == Task::land &&
                        commands_[*landing].has_position() &&
                        !formats::is_above_ground(commands_[*landing].frame);
  return is_known ? landing : std::nullopt;
}

// RTL::setRtlTypeAndDestination. Some versions know no type 5: to them it is 0.
std::string Walker::unjudged_type() const {
  const int type = type_of_return();
  const bool has_landing =
      std::any_of(plan_.commands.begin(), plan_.commands.end(), [](const auto& command) {
        const Task task = formats::command_task(command.number).task;
        return task == Task::landing_start || task == Task::land || task == Task::vtol_land;
      });
  if (type == 5 && plan_.rally.empty()) {
    return "a return to a safe point where there is none (RTL_TYPE 5)";
  }
  // Its copters sink on the whole way to a landing of the mission, once they have climbed.
  if ((type == 1 || type == 3) && has_landing) {
    return "a return that may go to the mission's landing (RTL_TYPE)";
  }
  return type == 0 || type == 1 || type == 3 || type == 5
             ? ""
             : "a return along the mission (RTL_TYPE " + std::to_string(type) + ")";
}

std::vector<Walker::Refuge> Walker::refuges() const {
  constexpr double kAlike = 20;   // metres
  constexpr double kAtHome = 12;  // metres: PX4 knows no safe point within 10 of home
  const int type = type_of_return();
  const double doubt = failsafe_ ? failsafe_->radius_m : 0;
  const auto distance = [&](const Refuge& refuge) { return (refuge.at - here()).norm(); };
  const double limit_km = is_px4() ? 0 : parameter("RALLY_LIMIT_KM");
  const double limit = limit_km > 0 ? 1000 * limit_km : kInfinity;
  std::vector<Refuge> all;
  double nearest = kInfinity;  // of those that are certainly near enough
  for (const formats::MissionPoint& point : plan_.rally) {
    const double base = point.frame == formats::AltitudeFrame::home ? home_z_ : 0;
    const Refuge rally{to_local(point.lon, point.lat), point.altitude_m, base + point.altitude_m};
    if (distance(rally) <= limit + doubt) {
      all.push_back(rally);
    }
    const bool is_home = is_px4() && type != 5 && (rally.at - home_).norm() <= kAtHome;
    if (distance(rally) <= limit - doubt && !is_home) {
      nearest = std::min(nearest, distance(rally));
    }
  }
  const Refuge home{home_, {}, home_z_};
  // PX4's type 1 flies to a safe point even where home is nearer. Some versions do so by type 5,
  // and some not of copters.
  const bool leaves_home_out = type == 1 && !autopilot_.is_copter() && !plan_.rally.empty();
  const bool may_leave_home_out = type == 1 || type == 5;
  if (!leaves_home_out && (is_px4() || parameter("RALLY_INCL_HOME") != 0)) {
    all.push_back(home);
    nearest = may_leave_home_out ? nearest : std::min(nearest, distance(home));
  } else if (!std::isfinite(nearest)) {
    all.push_back(home);
  }
  std::erase_if(
      all, [&](const Refuge& refuge) { return distance(refuge) > nearest + kAlike + 2 * doubt; });
  return all;
}

// AC: RTL::compute_return_target. PX4: RTL::calculate_return_alt_from_cone_half_angle, with heights
// above the place that it returns to; some versions take those of home.
std::array<double, 2> Walker::return_heights(double z, double distance,
                                             const Refuge& refuge) const {
  const double doubt = failsafe_ ? failsafe_->radius_m : 0;
  const double nearest = std::max(distance - doubt, 0.0);
  if (is_px4()) {
    const double above = parameter("RTL_RETURN_ALT");
    double minimum = above;
    double maximum = above;
    if (autopilot_.is_copter()) {
      // Beside the cone it returns at full height; within NAV_ACC_RAD at twice the distance.
      const double cone = parameter("RTL_CONE_ANG");
      const double near = parameter("NAV_ACC_RAD");
      const double radius = std::max(near, parameter("RTL_MIN_DIST"));
      const double slope = 1 / std::tan(radians(std::clamp(cone, 1.0, 89.0)));
      if (cone > 0 && nearest <= radius) {
        minimum = std::min(above, std::min(slope, 2.0) * nearest);
      }
      if (cone > 0 && distance + doubt <= radius) {
        maximum = std::max(std::min(above, slope * (distance + doubt)), 2 * near);
      } else if (cone > 0 && nearest <= radius) {
        maximum = std::max(above, 2 * near);
      }
    }
    return {std::max(z, std::min(home_z_, refuge.z) + minimum),
            std::max(z, std::max(home_z_, refuge.z) + maximum)};
  }
  if (!autopilot_.is_copter()) {
    return {std::max(z, home_z_ + 15), std::max(z, home_z_ + 15)};
  }
  const double present = z - home_z_;
  const double full = std::max({present + parameter("RTL_CLIMB_MIN_M"), parameter("RTL_ALT_M"),
                                refuge.height_m.value_or(0)});
  constexpr int kHeights = 1;  // of the types of fence
  const bool is_fenced = (parameter("FENCE_ENABLE") != 0 || parameter("FENCE_AUTOENABLE") != 0) &&
                         (int(parameter("FENCE_TYPE")) & kHeights) != 0;
  const auto at = [&](double metres) {
    double height = full;
    const double cone = parameter("RTL_CONE_SLOPE");
    if (cone >= 0.5) {
      height = std::min(height, std::max(cone * metres, present));
    }
    if (is_fenced) {
      height = std::max(present,
                        std::min(height, parameter("FENCE_ALT_MAX") - parameter("FENCE_MARGIN")));
    }
    return home_z_ + std::max(height, 0.3);
  };
  return {at(nearest), at(distance + doubt)};
}

void Walker::return_hover(std::size_t n, const Refuge& refuge) {
  if (const std::string type = unjudged_type(); !type.empty()) {
    give_up(n, type + " is not judged");
    return;
  }
  forget_speeds();
  const double distance = (refuge.at - hover_->at).norm();
  double lowest = return_heights(hover_->low, distance, refuge)[0];
  double highest = return_heights(hover_->high, distance, refuge)[1];
  if (former_home_z_) {  // its height above the former home may count
    const double shift = home_z_ - *former_home_z_;
    lowest = std::min(lowest, return_heights(hover_->low + shift, distance, refuge)[0]);
    highest = std::max(highest, return_heights(hover_->high + shift, distance, refuge)[1]);
  }
  if (failsafe_) {
    hover_->return_from(n, *failsafe_, lowest, highest, refuge.at);
  } else {
    if (lowest != hover_->low || highest != hover_->high) {
      hover_->climb(n, "the climb of its return", lowest, highest);
    }
    Destination home;
    home.at = refuge.at;
    home.low = hover_->low;
    home.high = hover_->high;
    hover_->go(n, "the way home", home);
  }
  hover_->land(n, "the landing at home");
}

void Walker::return_wing(std::size_t n, const Refuge& refuge) {
  forget_speeds();
  if (const std::string type = unjudged_type(); !type.empty()) {
    give_up(n, type + " is not judged");
    return;
  }
  const bool has_landing =
      std::any_of(plan_.commands.begin(), plan_.commands.end(), [](const auto& command) {
        const Task task = formats::command_task(command.number).task;
        constexpr int kReturnPathStart = 188;
        return task == Task::landing_start || task == Task::land || task == Task::vtol_land ||
               command.number == kReturnPathStart;
      });
  const bool is_quadplane = !is_px4() && autopilot_.airframe == Airframe::vtol;
  const bool goes_to_landing = has_landing && is_quadplane && parameter("RTL_AUTOLAND") != 0;
  if (goes_to_landing || (!is_px4() && parameter("Q_RTL_MODE") != 0)) {
    flight_.remark(Weight::not_judged, "not_judged", n,
                   "a return that goes to a landing or ends in hover is not judged");
    return;
  }
  const double above =
      is_px4() ? parameter("RTL_RETURN_ALT") : refuge.height_m.value_or(parameter("RTL_ALTITUDE"));
  Wing::Leg leg;
  leg.to.at = refuge.at;
  leg.to.low = std::min(home_z_, is_px4() ? refuge.z : home_z_) + above;
  leg.to.high = std::max(home_z_, is_px4() ? refuge.z : home_z_) + above;
  if (is_px4() || above < 0) {  // it does not sink
    leg.to.low = std::max(failsafe_ ? wing_->low() : wing_->high(), is_px4() ? leg.to.low : -1e6);
    leg.to.high = std::max(wing_->high(), is_px4() ? leg.to.high : -1e6);
  }
  leg.at_once = wing_->low() < leg.to.low;
  const double own = parameter(is_px4() ? "NAV_LOITER_RAD" : "WP_LOITER_RAD");
  const double given = is_px4() ? 0 : parameter("RTL_RADIUS");
  const double radius = std::abs(given != 0 ? given : own);
  const std::optional<Failsafe> joined = return_by_mission();
  if (failsafe_ || joined) {
    constexpr double kNearHeight = 10;  // metres within which its height is reached
    const double minimum =
        is_px4() ? std::min(home_z_, refuge.z) + parameter("RTL_DESCEND_ALT") : leg.to.low;
    const Whereabouts from = failsafe_ ? *failsafe_ : wing_->whereabouts();
    Whereabouts circle =
        wing_->return_from(n, from, leg.to, is_px4() ? std::abs(own) : 0, radius, minimum);
    if (joined) {
      // ModeRTL::navigate: near the height that it seeks when it takes up the circle, which may
      // still be one of the slope there.
      circle.low_m = leg.to.low - kNearHeight;
      circle.high_m = std::max(leg.to.high, circle.high_m) + kNearHeight;
      flight_.take({0, wing_->to_reach_s(from, leg.to, radius)});
      join_mission(n, *joined, circle);
    }
    return;
  }
  if (is_px4() && wing_->low() < leg.to.low) {
    Destination there;
    there.at = wing_->mean_place();
    there.low = leg.to.low;
    there.high = leg.to.high;
    wing_->circle(n, "the climb of its return", there, own, true, {}, leg.to, false);
  }
  wing_->leave_track();
  wing_->go(n, "the way home", leg);
  if (is_px4() && autopilot_.airframe == Airframe::vtol) {
    Destination low_circle = leg.to;
    low_circle.low = low_circle.high = std::min(home_z_, refuge.z) + parameter("RTL_DESCEND_ALT");
    wing_->circle(n, "the circle at home", low_circle, radius, true, {1, 0, true}, leg.to, false);
    hover_.emplace(flight_, refuge.at, low_circle.low);
    hover_->land(n, "the landing at home");
    return;
  }
  Destination circle = leg.to;
  if (is_px4()) {
    circle.low = circle.high = std::min(home_z_, refuge.z) + parameter("RTL_DESCEND_ALT");
  }
  wing_->circle(n, "the circle at home", circle, radius, own >= 0, {}, {}, false);
  flight_.take({0, kInfinity});
  flight_.remark(Weight::note, "end", n, "it circles at home for ever: it does not land");
}
}  // namespace altiplan::host
