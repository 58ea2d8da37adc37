// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "link/linked_vehicle.hpp"

namespace altiplan::link {
namespace {

using host::RouteAhead;

constexpr Time kAskAgain{500};
constexpr int kMaxAsks = 10;
constexpr double kSamePlace = 1e-3;   ///< metres
constexpr double kLookahead = 2;      ///< seconds, of a multirotor along the route
constexpr double kCircleAhead = 4;    ///< seconds to the circle that ends an aeroplane's set-point
constexpr double kLevelling = 1;      ///< m/s, at most, back to a height that is to be kept
constexpr double kBetween = 0.5;      ///< seconds between set-points that are commands of their own
constexpr double kTurnsWithin = 120;  ///< seconds of commands that are compared with the flight
constexpr double kLeastShare = 0.1;   ///< of a circle asked for; slow autopilots fly a third

/// Radians to the left, seen from above.
double turn(const Vec3& from, const Vec3& to) {
  return std::atan2(from.x() * to.y() - from.y() * to.x(), from.x() * to.x() + from.y() * to.y());
}
}  // namespace

std::optional<int> LinkedVehicle::item_at(const Vec3& waypoint) const {
  // A route may pass a point twice; and autopilots turn to an item before they are at the last one.
  const std::size_t count = flight_.items.size();
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t item = (std::size_t(flown_item_) + n) % count;
    if ((flight_.items[item] - waypoint).norm() <= kSamePlace) {
      return number_of(item);
    }
  }
  return std::nullopt;
}

void LinkedVehicle::steer(const RouteAhead& route, const State& now) {
  if (!flight_.command) {
    return;
  }
  const std::optional<int> item = item_at(route.path.next_waypoint(route.progress));
  if (!item) {
    take_command();
    stream(along(route, now), now);
  } else if (commands_) {
    hand_back(*item);
    if (commands_) {  // until the mode has changed
      stream(along(route, now), now);
    }
  }
}

SetPoint LinkedVehicle::along(const RouteAhead& route, const State& now) const {
  const double speed = request_->vehicle.speed_at(world_.clearance(now.position));
  const double ahead = kLookahead * speed;
  const Vec3 target = route.path.at(route.path.first_beyond(ahead, now.position, route.progress));
  const Vec3 way = target - now.position;
  return toward(now.position, way / std::max(way.norm() / speed, 1.0), target.z());
}

Vec3 LinkedVehicle::commanded_velocity(const RouteAhead& route, const State& from,
                                       const State& command) {
  const double dt = command.time_s - from.time_s;
  Vec3 velocity = (command.position - from.position) / dt;
  if (velocity.z() != 0) {
    height_ = command.position.z();
  } else {
    height_ = height_.value_or(route.path.at(route.progress).z());
    velocity.z() = std::clamp((*height_ - from.position.z()) / dt, -kLevelling, kLevelling);
  }
  return velocity;
}

SetPoint LinkedVehicle::toward(const Vec3& from, const Vec3& velocity, double height) const {
  SetPoint wanted;
  wanted.velocity = velocity;
  if (const auto& wing = request_->vehicle.wing) {
    wanted.radius_m = wing->turn_radius();
    const double ahead = 2 * wanted.radius_m + kCircleAhead * wing->airspeed_mps;
    const double speed = std::max(velocity.head<2>().norm(), kLengthTolerance);
    wanted.position = from + ahead / speed * velocity;
    wanted.position.z() = height;
  }
  return wanted;
}

void LinkedVehicle::expect_turn(const State& from, const State& command, const State& flown) {
  const auto& wing = request_->vehicle.wing;
  if (!wing || !is_confirmed_) {
    return;
  }
  const Vec3 way = command.position - from.position;
  const double most = way.norm() / wing->turn_radius();
  turns_.push_back({from.time_s, std::clamp(turn(from.velocity, way), -most, most),
                    turn(from.velocity, flown.velocity)});
  while (turns_.front().at_s < from.time_s - kTurnsWithin) {
    turns_.pop_front();
  }
  double asked = 0;
  double flown_so = 0;
  for (const Turn& each : turns_) {
    asked += each.asked;
    flown_so += each.flown;
  }
  if (std::abs(asked) >= 2 * kPi && flown_so / asked < kLeastShare) {
    give_up_in_hold("the vehicle does not turn as it is commanded: it is told to hold" +
                    feed_.quoted_text());
  }
}

void LinkedVehicle::take_command() {
  if (!flight_.command) {
    return;
  }
  if (!commands_ || hands_back_) {
    commands_ = true;
    hands_back_ = is_confirmed_ = false;
    asks_ = 0;
    ask_at_ = Time(0);
    turns_.clear();
  }
  is_confirmed_ = is_confirmed_ || feed_.mode() == FlightMode::commanded;
}

void LinkedVehicle::hand_back(int item) {
  if (!hands_back_) {
    hands_back_ = true;
    asks_ = 0;
    ask_at_ = Time(0);
  }
  if (asks_ > 0 && feed_.mode() == FlightMode::mission &&
      feed_.current_item().value_or(-1) >= item) {
    commands_ = hands_back_ = false;
    guardian_->stand_down();
  } else if (time_now() >= ask_at_) {
    feed_.set_item(item);
    ask(FlightMode::mission);
  }
}

void LinkedVehicle::ask(FlightMode mode) {
  if (!is_in_own_mode()) {
    return;  // its pilot's, or a failsafe's
  }
  if (asks_ > 0 && feed_.heartbeats() == heartbeats_at_ask_) {
    return;  // until a heartbeat shows that its pilot has not switched since
  }
  if (++asks_ > kMaxAsks) {
    give_up_in_hold("the vehicle does not change its mode, " + feed_.mode_name() +
                    feed_.quoted_text());
  }
  feed_.send(mode_command(feed_.vehicle(), mode));
  ask_at_ = time_now() + kAskAgain;
  heartbeats_at_ask_ = feed_.heartbeats();
}

void LinkedVehicle::stream(const SetPoint& wanted, const State& now) {
  if (!commands_) {
    return;
  }
  const bool is_command = feed_.vehicle().is_ardupilot() && request_->vehicle.wing;
  const bool is_due = !is_command || !is_confirmed_ || now.time_s >= streamed_s_ + kBetween;
  if (is_due) {
    link_.send(set_point(feed_.vehicle(), wanted, world_.frame()));
    streamed_s_ = now.time_s;
  }
  guardian_->commanding();
  if (!hands_back_ && !is_confirmed_ && time_now() >= ask_at_) {
    ask(FlightMode::commanded);  // after the first set-point: PX4 refuses OFFBOARD without
  }
}

bool LinkedVehicle::is_in_own_mode() const {
  const FlightMode mode = feed_.mode();
  if (!commands_) {
    return mode == FlightMode::mission;
  }
  const bool changes = !is_confirmed_ || hands_back_;
  return mode == FlightMode::commanded || (changes && mode == FlightMode::mission);
}

void LinkedVehicle::release() {
  constexpr Time kTimeout{1200};  // for a heartbeat; then the guardian does it
  constexpr Time kAgain{200};
  Time ask_at{0};
  commands_ = commands_ && is_in_own_mode();  // else somebody has taken it
  const bool has_commanded = commands_;
  for (const Time end = time_now() + kTimeout;
       commands_ && feed_.mode() != FlightMode::hold && time_now() < end;) {
    if (time_now() >= ask_at) {
      feed_.send(mode_command(feed_.vehicle(), FlightMode::hold));
      ask_at = time_now() + kAgain;
    }
    feed_.next(kAgain / 10);
  }
  if (guardian_ && (!commands_ || feed_.mode() == FlightMode::hold)) {
    guardian_->stand_down();
  }
  commands_ = false;
  if (has_commanded && !feed_.is_armed()) {  // why the pilot could not go on
    give_up(kDisarmed + feed_.quoted_text());
  }
}
}  // namespace altiplan::link
