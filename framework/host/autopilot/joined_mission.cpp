// SPDX-License-Identifier: Apache-2.0
// Returns that join the mission and fly it on, ArduPilot's:
// AP_Mission::jump_to_closest_mission_leg, jump_to_landing_sequence. Its copters' failsafes do so
// by AUTO_RTL, its aeroplanes' by RTL_AUTOLAND. PX4's do so by RTL_TYPE.
#include <algorithm>
#include <cmath>

#include "host/autopilot/walker.hpp"

namespace altiplan::host {

using formats::Task;
using Weight = Remark::Weight;

namespace {

constexpr int kLastOfItems = 95;  // MAV_CMD_NAV_LAST
constexpr int kReturnPathStart = 188;
constexpr int kLandingStart = 189;
constexpr int kParachute = 208;
constexpr std::size_t kLooksAt = 1000;  // commands, of all return paths
constexpr double kDoubt = 2;            // metres that it may think that it is elsewhere
constexpr double kOnGround = 1;         // metres above it
constexpr double kLayer = 10;           // metres of height that are told apart
constexpr double kTakesOff = 3;         // metres that it has risen when a failsafe counts
constexpr double kHeightsAlike = 5;     // metres: aeroplanes' heights at an item are told apart by

/// AP_Mission::stored_in_location.
bool has_place(int number) {
  constexpr int kNumbers[] = {16, 17, 18, 19, 21,  22,  30,  31,  36,  82,
                              84, 85, 92, 94, 179, 188, 189, 191, 195, 201};
  return std::find(std::begin(kNumbers), std::end(kNumbers), number) != std::end(kNumbers);
}

/// Metres to the north, to the east and up, as ArduPilot takes them.
Vec3 between(const Vec3& from, const Vec3& to) {
  constexpr double kDegree = 111318.84502145034;
  const double east = std::max(std::cos(radians((from.y() + to.y()) / 2)), 0.01);
  return {(to.y() - from.y()) * kDegree, std::remainder(to.x() - from.x(), 360) * kDegree * east,
          to.z() - from.z()};
}

/// Of a leg; all places in degrees and metres above sea level.
double distance_to(const Vec3& begin, const Vec3& end, const Vec3& place) {
  const Vec3 leg = between(begin, end);
  const Vec3 off = between(begin, place);
  const double square = leg.squaredNorm();
  const double share = square > 0 ? std::clamp(off.dot(leg) / square, 0.0, 1.0) : 0;
  return (off - share * leg).norm();
}
}  // namespace

std::vector<Walker::Failsafe> Walker::failsafes(std::size_t n) {
  std::vector<Failsafe> all;
  const auto add = [&](const std::string& name, double value,
                       std::initializer_list<std::pair<int, std::optional<Failsafe>>> actions) {
    for (const auto& [action, failsafe] : actions) {
      if (std::lround(value) == action) {
        if (failsafe && std::find(all.begin(), all.end(), *failsafe) == all.end()) {
          all.push_back(*failsafe);
        }
        return false;
      }
    }
    return give_up(n, name + " " + std::to_string(std::lround(value)) +
                          ": what that failsafe does is not judged");
  };
  bool is_unknown = false;
  const auto battery_actions = [&](const auto& actions) {
    for (const auto& [name, value] : options_.parameters) {
      if (is_battery_failsafe(name)) {
        is_unknown |= add(name, value.value, actions);
      }
    }
  };
  using Actions = std::initializer_list<std::pair<int, std::optional<Failsafe>>>;
  if (!is_px4() && autopilot_.is_copter()) {
    const Actions of_link = {
        {0, {}}, {1, Failsafe::returns}, {2, Failsafe::returns}, {6, Failsafe::joins_return_path}};
    const Actions of_battery = {{0, {}}, {2, Failsafe::returns}, {6, Failsafe::joins_return_path}};
    for (const char* name : {"FS_THR_ENABLE", "FS_GCS_ENABLE"}) {
      is_unknown |= add(name, parameter(name), of_link);
    }
    battery_actions(of_battery);
  } else if (!is_px4()) {
    // A battery's 2 jumps to a landing without a change of mode: the way there leads along the line
    // from the item that it was sent to. A long 4 begins a mission again that has ended.
    const Actions of_long = {{0, {}}, {1, Failsafe::returns}};
    is_unknown |= add("FS_LONG_ACTN", parameter("FS_LONG_ACTN"), of_long);
    is_unknown |= add("FS_SHORT_ACTN", parameter("FS_SHORT_ACTN"), {{0, {}}, {3, {}}});
    battery_actions(of_long);
  } else {
    const auto add_given = [&](const char* name, const Actions& actions) {
      if (const auto given = options_.parameters.find(name); given != options_.parameters.end()) {
        is_unknown |= add(name, given->second.value, actions);
      }
    };
    add_given("NAV_RCL_ACT", {{0, {}}, {2, Failsafe::returns}});
    add_given("NAV_DLL_ACT", {{0, {}}, {2, Failsafe::returns}});
    add_given("COM_LOW_BAT_ACT", {{0, {}}});
  }
  if (all.empty() && !is_unknown) {
    all.push_back(Failsafe::returns);
  }
  return all;
}

std::optional<Walker::Failsafe> Walker::return_by_mission() const {
  if (is_px4() || autopilot_.airframe != formats::Airframe::plane) {
    return std::nullopt;
  }
  const double autoland = parameter("RTL_AUTOLAND");
  const Failsafe kind = autoland == 4 ? Failsafe::joins_return_path : Failsafe::joins_landing;
  const bool does_join =
      (autoland == 1 || autoland == 2 || autoland == 4) && !entries(kind).empty();
  return does_join ? std::optional(kind) : std::nullopt;
}

std::size_t Walker::end_of_path(std::size_t start) const {
  std::size_t n = start + 1;
  for (; n < commands_.size(); ++n) {
    const int number = commands_[n].number;
    if (number == 21 || number == 85 || number == kParachute || number == kLandingStart) {
      return n + 1;
    }
  }
  return n;
}

std::vector<Walker::Entry> Walker::entries(Failsafe kind) const {
  std::vector<Entry> all;
  const auto is_given = [&](std::size_t n) {
    return has_place(commands_[n].number) &&
           (commands_[n].has_position() || commands_[n].altitude_m != 0);
  };
  for (std::size_t start = 0; start < commands_.size(); ++start) {
    const Task task = task_of(start);
    const bool is_item = task == Task::waypoint || task == Task::take_off || task == Task::land;
    if (kind == Failsafe::joins_item && is_item && commands_[start].has_position()) {
      all.push_back({start, {}});
      if (task == Task::land) {
        break;
      }
    } else if (kind == Failsafe::joins_landing && commands_[start].number == kLandingStart) {
      all.push_back({start, {}});
    } else if (kind == Failsafe::joins_return_path && commands_[start].number == kReturnPathStart) {
      std::optional<std::size_t> before;
      for (std::size_t n = start; n < end_of_path(start); ++n) {
        if (is_given(n) || commands_.is_jump(n)) {
          all.push_back({n, before});
          before = n;
        }
      }
    }
  }
  return all;
}

// A landing without a place of its own has that of the item behind it.
std::optional<Vec3> Walker::place_of_entry(std::size_t command) const {
  const auto& own = commands_[command];
  std::size_t at = command;
  if (own.number == kLandingStart && !own.has_position() && own.altitude_m == 0) {
    while (++at < commands_.size() && commands_[at].number > kLastOfItems &&
           !commands_.is_jump(at)) {
    }
  }
  if (at == commands_.size() || !has_place(commands_[at].number) || !commands_[at].has_position() ||
      formats::is_above_ground(commands_[at].frame)) {
    return std::nullopt;
  }
  const double base = formats::is_of_home(commands_[at].frame) ? home_z_ : 0;
  return Vec3(commands_[at].lon, commands_[at].lat, base + commands_[at].altitude_m);
}

std::vector<Walker::Joined> Walker::joins(std::size_t n, Failsafe kind, const Whereabouts& place) {
  std::size_t looked_at = 0;
  for (std::size_t start = 0; start < commands_.size(); ++start) {
    looked_at += commands_[start].number == kReturnPathStart ? end_of_path(start) - start : 0;
  }
  if (looked_at >= kLooksAt) {
    give_up(n, "return paths (188) of 1000 commands and more are not judged");
    return {};
  }
  const std::vector<Entry> all = entries(kind);
  if (all.size() == 1 && !commands_.is_jump(all.front().command)) {
    return {{all.front().command, place}};
  }
  std::vector<std::pair<Vec3, Vec3>> legs;
  for (const Entry& entry : all) {
    const auto to = place_of_entry(entry.command);
    const auto from = entry.before ? place_of_entry(*entry.before) : to;
    if (!to || !from) {
      give_up(n, "whether it joins the mission at " + name_of_command(commands_[entry.command]) +
                     ", which jumps, has no position or is above the ground, is not judged");
      return {};
    }
    legs.emplace_back(*from, *to);
  }
  const auto [lon, lat] = world_.frame().to_lonlat(place.at.x(), place.at.y());
  const int layers = std::max(1, int(std::ceil((place.high_m - place.low_m) / kLayer)));
  const double half = (place.high_m - place.low_m) / layers / 2;
  const double doubt = std::hypot(place.radius_m, half) + kDoubt / 2;
  const double beside = is_px4() ? 0.005 : 0;  // it measures lengths otherwise
  std::map<std::size_t, Whereabouts> possible;
  for (int layer = 0; layer < layers; ++layer) {
    const Vec3 here(lon, lat, place.low_m + half * (2 * layer + 1));
    std::vector<double> distances;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const auto& [from, to] = legs[k];
      // Of the first item and a leg that is nearest there, the item is certainly taken.
      const bool is_first_leg = k > 0 && all[k].before == all[k - 1].command && !all[k - 1].before;
      const Vec3 leg = between(from, to);
      const bool is_before = between(from, here).dot(leg) < -doubt * leg.norm();
      distances.push_back(is_first_leg && is_before ? kInfinity : distance_to(from, to, here));
    }
    const double nearest = *std::min_element(distances.begin(), distances.end());
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (distances[k] <= nearest + 2 * doubt + beside * nearest) {
        const Whereabouts none{place.at, place.radius_m, kInfinity, -kInfinity};
        Whereabouts& from = possible.try_emplace(all[k].command, none).first->second;
        from.low_m = std::min(from.low_m, here.z() - half);
        from.high_m = std::max(from.high_m, here.z() + half);
      }
    }
  }
  return {possible.begin(), possible.end()};
}

// ArduPilot starts the first of the orders before an item when it starts the item, others later.
bool Walker::is_on_way_home(std::size_t n) const {
  bool is_on_way = false;
  for (std::size_t k = 0; k <= n; ++k) {
    const int number = commands_[k].number;
    const bool follows_item =
        k == 0 || (commands_[k - 1].number <= kLastOfItems && commands_.is_done(k - 1));
    const bool is_start = number == kReturnPathStart || number == kLandingStart;
    if (number == 21 || number == 85 || (is_start && follows_item)) {
      is_on_way = true;
    } else if (number == 22 || number == 84) {
      is_on_way = false;
    }
  }
  bool lands = false;
  for (std::size_t k = 0; k < commands_.size(); ++k) {
    const Task task = task_of(k);
    is_on_way =
        is_on_way && !commands_.is_jump(k) && (k < n || lands || task != Task::loiter_forever);
    lands = lands || (k >= n &&
                      (task == Task::land || task == Task::vtol_land || task == Task::return_home));
  }
  return is_on_way && lands;
}

bool Walker::may_return_from(const FlownPart& part) {
  const bool is_plane = autopilot_.airframe == formats::Airframe::plane;
  if (!is_px4() && is_plane && task_of(part.command) == Task::land) {
    return false;  // it lands, whatever happens
  }
  if (!part.is_return) {
    return true;
  }
  if (!is_px4() && autopilot_.is_copter()) {
    return true;  // a mission's return is none of the mode's: the failsafe begins anew
  }
  mission_ = {};
  const std::vector<Failsafe> all = failsafes(part.command);
  return return_by_mission() || std::any_of(all.begin(), all.end(), [](Failsafe failsafe) {
           return failsafe != Failsafe::returns;  // it leaves the mission's own
         });
}

bool Walker::join_mission(std::size_t n, Failsafe kind, const Whereabouts& place) {
  const bool is_copter = autopilot_.is_copter();
  if (is_copter && is_on_way_home(n)) {
    return true;  // it flies on, as is judged
  }
  if (entries(kind).empty()) {
    return is_copter && kind == Failsafe::joins_return_path &&
           join_mission(n, Failsafe::joins_landing, place);
  }
  if (has_joined_) {
    return give_up(n, "a return along the mission that joins it again is not judged");
  }
  if (!plan_.home) {
    return give_up(n, "where home is, above which its heights are, the file does not say");
  }
  if (homes_set_ > 0) {
    return give_up(n, "a return in a mission that sets another home is not judged");
  }
  Whereabouts from = place;
  if (is_copter) {
    take_any_speed();
    if (const double ground = flight_.ground(from.at); from.low_m < ground + kOnGround) {
      from.low_m = std::min(from.high_m, ground + kTakesOff);
    }
  }
  join_each(n, joins(n, kind, from));
  return true;
}

void Walker::join_each(std::size_t n, const std::vector<Joined>& joined) {
  const TimeSpan begin = mission_.time;
  TimeSpan end{kInfinity, 0};
  const std::size_t remarked = mission_.remarks.size();
  for (const auto& [command, there] : joined) {
    mission_.time = begin;
    if (!autopilot_.is_copter()) {
      be_anywhere(there);
      forget_speeds();
    }
    join_at(n, command, there);
    end = {std::min(end.min_s, mission_.time.min_s), std::max(end.max_s, mission_.time.max_s)};
  }
  mission_.time = end.max_s > 0 ? end : begin;
  for (std::size_t k = remarked; failsafe_ && k < mission_.remarks.size(); ++k) {
    Remark& remark = mission_.remarks[k];
    remark.rule = remark.weight == Weight::not_judged ? "joins" : remark.rule;
  }
}

// RtlMissionFast: on to the next item with a position, or to the nearest one where it holds before
// it returns (COM_FAIL_ACT_T), then all of them as waypoints. It flies at the speed of its
// parameters, and does not wait.
bool Walker::fly_on(std::size_t n, const Whereabouts& place) {
  if (!autopilot_.is_copter() || type_of_return() != 2 || !only_landing()) {
    return false;
  }
  if (!plan_.home) {
    give_up(n, "where home is, above which its heights are, the file does not say");
    return true;
  }
  const std::vector<Entry> items = entries(Failsafe::joins_item);
  std::size_t position = 0;
  for (std::size_t k = 0; k <= *only_landing(); ++k) {
    if (items[position].command == k) {
      ++position;
    } else if (task_of(k) != Task::payload) {
      give_up(n, "a return along a mission (RTL_TYPE 2) with " + name_of_command(commands_[k]) +
                     " is not judged: with waypoints alone");
      return true;
    }
  }
  forget_speeds();
  std::vector<Joined> joined = joins(n, Failsafe::joins_item, place);
  const auto next = std::find_if(items.begin(), items.end(),
                                 [&](const Entry& item) { return item.command >= n; });
  if (next != items.end() && !joined.empty()) {
    std::erase_if(joined, [&](const Joined& one) { return one.first == next->command; });
    joined.emplace_back(next->command, place);
  }
  join_each(n, joined);
  return true;
}

void Walker::join_at(std::size_t n, std::size_t command, const Whereabouts& place) {
  std::size_t item = command;
  while (item < commands_.size() &&
         (commands_[item].number > kLastOfItems || !commands_.is_done(item)) &&
         !commands_.is_jump(item)) {
    ++item;
  }
  const bool is_copter = autopilot_.is_copter();
  const Task task = item < commands_.size() ? task_of(item) : Task::other;
  const bool lands = is_copter && (task == Task::land || task == Task::vtol_land);
  const bool is_circle =
      task == Task::loiter_forever || task == Task::loiter_time ||
      task == Task::loiter_to_altitude ||
      (task == Task::loiter_turns && !(is_copter && commands_[item].params[2] == 0));
  // Some versions take a circle after the one at home for reached.
  const bool is_flown_to = task == Task::waypoint || (is_px4() && task == Task::take_off) ||
                           (is_circle && (is_copter || parameter("RTL_AUTOLAND") != 1));
  if (!(is_flown_to || lands) || !commands_[item].has_position() ||
      (is_copter && !lands && commands_[item].altitude_m == 0) ||
      formats::is_above_ground(commands_[item].frame)) {
    const std::size_t named = std::min(item, commands_.size() - 1);
    give_up(n, "how it joins the mission at " + name_of_command(commands_[named]) +
                   " is not judged: at waypoints and circles with heights of their own alone");
    return;
  }
  Wing::Leg leg;
  leg.to = destination(item);
  if (is_too_far(n, leg.to.at)) {
    return;
  }
  Whereabouts arrival;
  if (is_copter) {
    if (lands) {
      leg.to.low = place.low_m;
      leg.to.high = place.high_m;
    }
    hover_.emplace(flight_, place.at, place.low_m);
    set_hover_speed();
    hover_->join(item, place, leg.to);
    arrival = {leg.to.at, 0, leg.to.low, leg.to.high};
  } else {
    if (task == Task::waypoint) {
      leg.acceptance_m = std::max(commands_[item].params[1], 0.0);
      leg.pass_by_m = std::max(commands_[item].params[2], 0.0);
    }
    arrival = wing_->join(item, place, leg);
    arrival.low_m = kHeightsAlike * std::floor(arrival.low_m / kHeightsAlike);
    arrival.high_m = kHeightsAlike * std::ceil(arrival.high_m / kHeightsAlike);
  }
  const TimeSpan begun = mission_.time;
  const FlownMission& rest = rest_from(n, command, item, arrival);
  for (FlownPart part : rest.parts) {
    part.begin_s += begun.min_s;
    part.time += begun;
    part.until_s += part.until_s > 0 ? begun.max_s : 0;
    mission_.parts.push_back(std::move(part));
  }
  mission_.remarks.insert(mission_.remarks.end(), rest.remarks.begin(), rest.remarks.end());
  mission_.time += rest.time;
}

const FlownMission& Walker::rest_from(std::size_t n, std::size_t command, std::size_t item,
                                      const Whereabouts& arrival) {
  // Whether it counts circles aright depends on what it flew before.
  const double before = task_of(item) == Task::waypoint ? 0 : double(n);
  const auto [known, is_new] =
      rests_.try_emplace({double(command), arrival.low_m, arrival.high_m, before});
  if (!is_new) {
    return known->second;
  }
  FlownMission begun = std::exchange(mission_, {});
  const std::optional<Whereabouts> failsafe = std::exchange(failsafe_, std::nullopt);
  flown_.clear();
  rounds_.clear();
  orders_.clear();
  flight_.repeats = 0;
  is_pending_ = false;
  has_joined_ = true;
  if (!autopilot_.is_copter()) {
    be_anywhere(arrival);
    forget_speeds();
    wing_->pass(destination(item), arrival);
  }
  for (std::size_t order = command; order < item; ++order) {
    if (commands_.is_done(order)) {
      carry_out(order);
      is_pending_ = true;  // the others may be lost where the item is reached at once
    }
  }
  orders_.clear();
  bool ends = false;
  if (autopilot_.is_copter()) {
    flight_.before = item;
    if (task_of(item) == Task::land) {  // above its place, where the way back has led
      hover_->land(item, "the landing");
      ends = !takes_off_again(item);
    } else {
      ends = fly_hover(item);
    }
  } else if (task_of(item) != Task::waypoint) {
    flight_.before = n;
    ends = fly_wing(item);
  }
  flight_.before = item;
  is_pending_ = false;
  if (!ends) {
    walk(item + 1);
  }
  has_joined_ = false;
  failsafe_ = failsafe;
  known->second = std::exchange(mission_, std::move(begun));
  for (FlownPart& part : known->second.parts) {
    part.known = ++known_parts_;
    part.what = part.what.empty() ? "the way along the mission" : part.what;
  }
  return known->second;
}

void Walker::take_any_speed() {
  double* const speeds[] = {hover_speed_, climb_rate_, sink_rate_};
  const char* const names[] = {"WP_SPD", "WP_SPD_UP", "WP_SPD_DN"};
  for (int kind : {0, 1, 2}) {
    speeds[kind][0] = speeds[kind][1] = parameter(names[kind]);
  }
  for (std::size_t n = 0; n < commands_.size(); ++n) {
    const double type = commands_[n].params[0];
    const double value = commands_[n].params[1];
    if (task_of(n) == Task::speed && value > 0 && type >= 0 && type <= 3) {
      double* const taken = speeds[type == 2 ? 1 : type == 3 ? 2 : 0];
      taken[0] = std::min(taken[0], value);
      taken[1] = std::max(taken[1], value);
    }
  }
}
}  // namespace altiplan::host
