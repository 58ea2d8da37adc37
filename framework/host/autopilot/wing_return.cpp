// SPDX-License-Identifier: Apache-2.0
// Returns of aeroplanes from anywhere in a place, on any heading: to a circle, to a mission that
// they join, or without their engine.
#include <algorithm>
#include <cmath>
#include <utility>

#include "host/autopilot/flight.hpp"

namespace altiplan::host {

void Wing::be_anywhere(const Whereabouts& place) {
  start(place.at, place.low_m, place.at + Eigen::Vector2d(1, 0));
  for (Member& member : members_) {
    member.high = place.high_m;
  }
}

// While it turns toward a place under the law of guidance, the bearing of the place falls from at
// most half a turn. Above a right angle the turn has a constant radius r, and takes it aside by r;
// below, its rate is v / r sin(bearing), which takes it aside by r times the angle. Before that, it
// rolls.
double Wing::room_to_turn(double v) const {
  constexpr double kRolls = 1.5;  // seconds
  const double weak = flight_.autopilot().is_px4() ? 1 : kWeakTurn;
  const double radius = std::max(l1_s_ * v / (2.25 * weak), v / (kWeakest * max_turn_rate(v)));
  return radius * (1 + kPi / 2) + kRolls * v;
}

double Wing::late_m(const Whereabouts& place, double beside, double fast) {
  return 1.3 * beside + place.radius_m + fast;
}

std::vector<Flight::Level> Wing::levels_of_return(double low, double high, const Destination& to,
                                                  double turned_m, double late_m,
                                                  double ramp_m) const {
  const double fast = true_speed(1, std::max(high, to.high));
  const double slow = true_speed(0, std::min(low, to.low));
  std::vector<Flight::Level> levels;
  const double top = std::max(high, to.high);
  if (low < to.low) {  // It climbs at a constant rate, then ever slower.
    const double along_ramp = ramp_m > 0 ? (to.low - low) / ramp_m * fast : kInfinity;
    const double rate = std::min(kSlowClimb * climb_mps_, along_ramp);
    const double tau = lag_s_ / (kSlowClimb * kSlowClimb);
    const double last = std::min(rate * tau, to.low - low);
    const double level_off = turned_m + (to.low - last - low) / rate * fast;
    levels = {{turned_m, low, top}, {level_off, to.low - last, top}};
    for (const double taus : {1.0, 2.0, 4.0, 8.0}) {
      levels.push_back({level_off + taus * tau * fast, to.low - last * std::exp(-taus), top});
    }
    return levels;
  }
  if (ramp_m > 0 && low - to.low >= slope_min_m_) {
    return {{-turned_m, low, top}, {ramp_m, to.low, top}};
  }
  // It may sink at once.
  const double rate = kQuick * sink_mps_;
  const double begin = -turned_m;
  const double begun = std::max(to.low, low - rate * (begin + late_m) / slow);
  return {{begin, begun, top}, {begin + (begun - to.low) / rate * slow, to.low, top}};
}

// Mode::update_target_altitude: the target is on a line from where it was to the middle of its
// circle, by how far it has come along that way, until it takes up the circle. In a place of radius
// r it may have begun r nearer to its end, and in other directions.
std::vector<Flight::Level> Wing::levels_on_line(double low, double top, const Destination& to,
                                                const Whereabouts& place, double beside,
                                                double circle_m) const {
  const double length = (to.at - place.at).norm();
  const double lag_m = sink_mps_ * lag_s_ / (kSlow * kSlow);
  const double begin =
      -place.radius_m - (beside + place.radius_m) * place.radius_m / std::max(length, 1.0);
  const double end = length - circle_m - 1.5 * l1_s_ * true_speed(1, top);
  const double there = low - (low - to.low) * (end - begin) / (length - begin);
  return {{begin, low - lag_m, top}, {end, there - lag_m, top}, {end, to.low, top}};
}

Whereabouts Wing::whereabouts() const {
  Whereabouts all{mean_place(), 0, low(), high()};
  for (const Member& member : members_) {
    all.radius_m = std::max(all.radius_m, (member.at - all.at).norm());
  }
  return all;
}

std::pair<Whereabouts, TimeSpan> Wing::add_ways(const Whereabouts& place, const Destination& to,
                                                double circle_m, double circle_there_m) {
  constexpr double kLevelled = 10;  // metres: PX4 leaves its circle so far from its height
  const double bottom = place.low_m;
  const double top = place.high_m;
  const double fast = true_speed(1, std::max(top, to.high));
  const double slow = true_speed(0, std::min(bottom, to.low));
  const double length = (to.at - place.at).norm();
  double beside = room_to_turn(fast);
  const bool circles = circle_m > 0 && bottom < to.low;
  if (circles) {
    beside += widest_radius(circle_m, to.high);
  }
  const double turned_m = beside + place.radius_m;
  const double late_m = Wing::late_m(place, beside, fast);
  std::vector<Flight::Level> levels;
  if (circles) {
    const double level_m = (kLevelled / (kSlow * climb_mps_) + 3 * lag_s_) * fast;
    levels = {{turned_m, bottom, std::max(top, to.high)},
              {turned_m, to.low - kLevelled, std::max(top, to.high)},
              {turned_m + level_m, to.low, std::max(top, to.high)}};
  } else {
    levels = levels_of_return(bottom, top, to, turned_m, late_m, circle_there_m > 0 ? 0 : length);
  }
  if (circle_there_m > 0 && slope_min_m_ > 0 && bottom - to.high >= slope_min_m_ &&
      length > 3 * turned_m + circle_there_m) {
    levels = levels_on_line(bottom, top, to, place, beside, circle_there_m);
  }
  flight_.add_fan(place, beside, to.at, levels, kBesideTrack);
  const double climb_s =
      circles ? (to.high - bottom) / (kSlow * climb_mps_) + 2 * kPi * beside / slow : 0;
  const TimeSpan time{std::max(length - place.radius_m, 0.0) / fast,
                      (length + late_m) / slow + climb_s};
  // As it arrives: lower while it has climbed too little, higher while it has sunk too little.
  double last_low = to.low;
  for (const Flight::Level& level : levels) {
    if (level.at_m >= length - place.radius_m) {
      last_low = std::min(last_low, level.low);
    }
  }
  const bool is_near = length < 3 * turned_m;
  const double sunk = is_near ? 0 : std::max(0.0, kSlow * sink_mps_ / fast * (length - late_m));
  const double lag_m = sink_mps_ * lag_s_ / (kSlow * kSlow);
  double last_high = std::min(std::max(top, to.high), std::max(to.high, top - sunk) + lag_m);
  if (slope_min_m_ > 0 && top - to.high >= slope_min_m_) {
    // On a line to the middle of its circle, that it takes up before.
    const double begun_m = std::max(length - place.radius_m, 1.0);
    const double left_m = circle_there_m + 1.5 * l1_s_ * fast + place.radius_m;
    const double share = std::min(left_m / begun_m, 1.0);
    last_high = std::max(last_high, to.high + share * (top - to.high) + lag_m);
  }
  return {{to.at, 0, is_near ? std::min(bottom, last_low) : last_low, last_high}, time};
}

Whereabouts Wing::return_from(std::size_t command, const Whereabouts& place, const Destination& to,
                              double circle_m, double circle_at_home_m, double least_there) {
  flight_.begin(command, "the way home");
  const double circles_m = widest_radius(circle_at_home_m, to.high);
  auto [home, time] = add_ways(place, to, circle_m, circles_m);
  flight_.take(time);
  home.radius_m = circles_m;
  flight_.begin(command, "the circle at home");
  flight_.add_tower(home, std::min(home.low_m, least_there), home.high_m, kBesideTrack);
  return home;
}

double Wing::to_reach_s(const Whereabouts& from, const Destination& to, double circle_m) const {
  const double slow = true_speed(0, std::min(from.low_m, to.low));
  const double climb_s = std::max(to.high - from.low_m, 0.0) / (kSlowClimb * climb_mps_);
  const double sink_s = std::max(from.high_m - to.low, 0.0) / (kSlow * sink_mps_);
  return 2 * kPi * widest_radius(circle_m, to.high) / slow + std::max(climb_s, sink_s);
}

Whereabouts Wing::join(std::size_t command, const Whereabouts& place, const Leg& leg) {
  flight_.begin(command, "the way back to the mission").speed_mps = speed_mps[1];
  auto [item, time] = add_ways(place, leg.to, 0, 0);
  flight_.take(time);
  item.radius_m = std::max(turn_distance(true_speed(1, leg.to.low), leg), leg.pass_by_m);
  return item;
}

void Wing::pass(const Destination& item, const Whereabouts& somewhere) {
  be_anywhere(somewhere);
  from_ = item;
  has_track_ = true;
  joined_ = somewhere;
}

double Wing::to_settle(const Whereabouts& joined) const {
  const double v = true_speed(1, joined.high_m);
  return joined.radius_m + 2 * room_to_turn(v) + 3 * l1_s_ * v;
}

std::optional<Whereabouts> Wing::leave_joined(const Destination& to) {
  if (!joined_ || (to.at - joined_->at).norm() < 1) {
    return std::nullopt;
  }
  for (Member& member : members_) {
    member.heading = bearing_of(to.at - member.at);
  }
  return std::exchange(joined_, std::nullopt);
}

// In a turn it sinks n² times as fast at most (n its load: the drag of its lift grows with n², the
// rest not at all), n² - 1 being the square of its bank's tangent. Over a turn by a given angle
// that adds at most the tangent times v²/g times the angle to its path.
Glide Wing::glide_in(const Whereabouts& place, double ratio, double lowest_m) const {
  constexpr double kTurn = 1.5 * kPi;  // radians: half a turn, and what it swings back
  const double fast = true_speed(1, place.high_m);
  const double slow = true_airspeed(0, std::min(lowest_m, place.low_m));
  const double against = std::max(1 - flight_.wind_mps / slow, 0.0);
  Glide glide;
  glide.ratio = ratio * against;
  glide.room_m = room_to_turn(fast);
  glide.turned_m = glide.room_m + place.radius_m;
  glide.circle_m = widest_radius(0, place.high_m);
  const double tangent = max_turn_rate(fast) * fast / kGravity;
  const double path_m =
      glide.turned_m + late_m(place, glide.room_m, fast) + kTurn * tangent * fast * fast / kGravity;
  const double fast_air = true_airspeed(1, place.high_m);
  glide.zoom_m = (fast_air * fast_air - slow * slow) / (2 * kGravity);
  glide.turn_loss_m = glide.ratio > 0 ? glide.zoom_m + path_m / glide.ratio : kInfinity;
  return glide;
}
}  // namespace altiplan::host
