// SPDX-License-Identifier: Apache-2.0
#include "link/linked_vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

#include "link/vehicle_words.hpp"

namespace altiplan::link {
namespace {

using host::FlownTo;
using host::RouteAhead;
using host::VehicleLost;

constexpr Time kLostAfter{5000};
/// Longer than a heartbeat takes to report a mode that has just been changed.
constexpr Time kStrange{1500};
/// Of the guardian, between set-points.
constexpr Time kPatience{3000};
constexpr double kWindow = 20;  ///< metres that progress may exceed twice the distance flown

/// Without looking for an answer: in another process, which reads nothing.
void hold(Link& link, const Vehicle& vehicle) {
  constexpr int kTimes = 5;  // packets get lost
  constexpr Time kBetween{200};
  for (int n = 0; n < kTimes; ++n) {
    link.send(Message(mode_command(vehicle, FlightMode::hold)));
    std::this_thread::sleep_for(kBetween);
  }
}
}  // namespace

LinkedVehicle::LinkedVehicle(Link& link, const Vehicle& vehicle, const World& world,
                             LinkedFlight flight, std::stop_token stop)
    : link_(link),
      feed_(link, vehicle, world),
      world_(world),
      flight_(std::move(flight)),
      stop_(std::move(stop)) {
  if (flight_.command) {
    guardian_.emplace([&link, vehicle] { hold(link, vehicle); }, kPatience);
  }
}

State LinkedVehicle::take_off(const Request& request, const RouteAhead& /*route*/,
                              const State& first) {
  request_ = &request;
  began_ = time_now();
  await_position();
  if (flight_.arm) {
    start_mission();
  } else if (!flies_route()) {
    flight_.say("waiting for the vehicle to fly its mission (--arm starts it)");
  }
  told_at_ = time_now();
  while (!flies_route() && next_position()) {
    watch_start();
  }
  is_flying_ = true;
  await_nearest(first.position);
  return feed_.begin_track(first.time_s);
}

void LinkedVehicle::await_nearest(const Vec3& start) {
  double nearest = kInfinity;
  while (const std::optional<State> now = next_position()) {
    const double distance = (now->position - start).norm();
    if (distance >= nearest) {
      return;
    }
    nearest = distance;
  }
}

void LinkedVehicle::await_position() {
  constexpr Time kNoItem{4500};  // not every vehicle reports its item
  feed_.expect_reports(flight_.command);
  while (!stop_.stop_requested() &&
         (!feed_.has_position() || (!feed_.current_item() && time_now() < began_ + kNoItem))) {
    expect_in_reach();
    feed_.next(kReceiveSlice);
  }
}

bool LinkedVehicle::flies_route() const {
  const int first = number_of(0);
  return feed_.mode() == FlightMode::mission && feed_.is_armed() &&
         (feed_.current_item().value_or(first) > first || feed_.reached_item() == first);
}

int LinkedVehicle::number_of(std::size_t item) const {
  return int(item) + first_item(feed_.vehicle());
}

void LinkedVehicle::start_mission() {
  begin_at_first_item();
  const bool was_armed = feed_.is_armed();
  try {
    arm_and_start();
  } catch (const VehicleLost&) {
    if (!was_armed) {
      undo_start();
    }
    throw;
  }
  if (stop_.stop_requested()) {
    return;
  }
  constexpr float kAir = 0;
  constexpr float kGround = 1;
  const auto& wing = request_->vehicle.wing;
  feed_.send(command_to(feed_.vehicle(), VehicleCommand::kChangeSpeed, wing ? kAir : kGround,
                        float(wing ? wing->airspeed_mps : request_->vehicle.speed_mps), -1));
}

void LinkedVehicle::undo_start() {
  constexpr int kTimes = 3;
  constexpr Time kBetween{200};
  const FlightMode mode = feed_.mode();
  const bool is_ours = mode == FlightMode::mission || mode == FlightMode::commanded;
  for (int n = 0; n < kTimes; ++n) {
    if (is_ours) {  // it may have taken off
      feed_.send(mode_command(feed_.vehicle(), FlightMode::hold));
    }
    feed_.send(command_to(feed_.vehicle(), VehicleCommand::kArm, 0));
    std::this_thread::sleep_for(kBetween);
  }
}

void LinkedVehicle::begin_at_first_item() {
  constexpr int kTries = 12;
  constexpr Time kTimeout{500};
  const int first = number_of(0);
  for (int n = 0; n < kTries && !stop_.stop_requested(); ++n) {
    feed_.set_item(first);
    for (const Time end = time_now() + kTimeout; time_now() < end && !stop_.stop_requested();) {
      expect_in_reach();
      feed_.next(kReceiveSlice);
      if (feed_.current_item() == first) {
        return;
      }
    }
  }
  if (!stop_.stop_requested()) {
    give_up("the vehicle does not confirm that its mission begins with item " +
            std::to_string(first) +
            (feed_.current_item() ? ": it says " + std::to_string(*feed_.current_item()) : "") +
            feed_.quoted_text());
  }
}

void LinkedVehicle::arm_and_start() {
  const Vehicle& vehicle = feed_.vehicle();
  const bool is_copter = vehicle.is_ardupilot() && !is_fixed_wing(vehicle.heartbeat);
  const char* to_fly = "to fly its mission";
  if (is_copter && !feed_.is_armed()) {
    change_mode(FlightMode::commanded, "the mode that it arms in");  // not armed in AUTO
  } else {
    change_mode(FlightMode::mission, to_fly);
  }
  if (!feed_.is_armed()) {
    expect(command_to(vehicle, VehicleCommand::kArm, 1), "to arm",
           [&] { return feed_.is_armed(); });
  }
  if (is_copter) {
    change_mode(FlightMode::mission, to_fly);
    expect(command_to(vehicle, VehicleCommand::kStartMission), "to start its mission",
           [&] { return feed_.acknowledged(VehicleCommand::kStartMission) == 0 || flies_route(); });
  }
}

void LinkedVehicle::change_mode(FlightMode mode, const std::string& what) {
  expect(mode_command(feed_.vehicle(), mode), what, [&] { return feed_.mode() == mode; });
}

void LinkedVehicle::expect(const CommandLong& command, const std::string& what,
                           const std::function<bool()>& is_done) {
  // For some heartbeats, which come each second; a copter that was armed disarms after 10 s.
  constexpr int kTries = 15;
  constexpr Time kTimeout{500};
  for (int n = 0; n < kTries && !stop_.stop_requested(); ++n) {
    feed_.send(command);
    for (const Time end = time_now() + kTimeout; time_now() < end && !stop_.stop_requested();) {
      expect_in_reach();
      feed_.next(kReceiveSlice);
      if (is_done()) {
        return;
      }
      if (feed_.acknowledged(command.command).value_or(0) != 0) {
        await_words();
        give_up("the vehicle refuses " + what + feed_.quoted_text());
      }
    }
  }
  if (!stop_.stop_requested()) {
    give_up("the vehicle does not answer the command " + what + feed_.quoted_text());
  }
}

void LinkedVehicle::watch_start() {
  constexpr Time kTellAgain{30'000};
  if (flight_.arm && feed_.mode() == FlightMode::mission && feed_.is_armed()) {
    not_started_since_.reset();
  } else if (flight_.arm) {
    not_started_since_ = not_started_since_.value_or(time_now());
    if (time_now() > *not_started_since_ + kStrange) {
      give_up("the vehicle has left its mission before the first item: " +
              (feed_.is_armed() ? "it is in the mode " + feed_.mode_name() : "it has disarmed") +
              feed_.quoted_text());
    }
  }
  if (time_now() > told_at_ + kTellAgain) {
    told_at_ = time_now();
    flight_.say("waiting: the vehicle is " + std::string(feed_.is_armed() ? "" : "not ") +
                "armed, in the mode " + feed_.mode_name() + feed_.quoted_text());
  }
}

void LinkedVehicle::await_words() {
  constexpr Time kWordsFollow{300};
  for (const Time end = time_now() + kWordsFollow; time_now() < end && !stop_.stop_requested();) {
    feed_.next(kReceiveSlice);
  }
}

FlownTo LinkedVehicle::follow(RouteAhead& route, const State& from, double duration,
                              const Report& report) {
  height_.reset();
  State last = from;
  while (last.time_s < from.time_s + duration - kLengthTolerance) {
    steer(route, last);
    const std::optional<State> now = next_position();
    if (!now) {
      break;
    }
    route.reference = route.progress + kWindow + 2 * (now->position - last.position).norm();
    route.advance(*now, now->time_s - last.time_s);
    last = *now;
    if (!report(last)) {
      break;
    }
    if (host::passes_goal(route, *request_, last, true)) {
      return FlownTo::past_goal;
    }
  }
  return FlownTo::on_the_way;
}

FlownTo LinkedVehicle::go(RouteAhead& route, const State& from, const State& command,
                          const Report& report) {
  const Vec3 velocity = commanded_velocity(route, from, command);
  const SetPoint wanted = toward(from.position, velocity, *height_);
  take_command();
  stream(wanted, from);
  const auto latency = VehicleFeed::Clock::now() - feed_.last_position();
  latencies_us_.push_back(std::chrono::duration_cast<std::chrono::microseconds>(latency).count());
  ++count_;
  State last = from;
  while (last.time_s < command.time_s - kLengthTolerance) {
    const std::optional<State> now = next_position();
    if (!now || !report(*now)) {
      return FlownTo::on_the_way;
    }
    last = *now;
    if (host::passes_goal(route, *request_, last, false)) {
      return FlownTo::past_goal;
    }
    take_command();
    stream(wanted, last);
  }
  expect_turn(from, command, last);
  return FlownTo::on_the_way;
}

std::optional<State> LinkedVehicle::next_position() {
  while (!stop_.stop_requested()) {
    expect_in_reach();
    std::optional<State> state = feed_.next(kReceiveSlice);
    if (is_flying_ && feed_.mode() == FlightMode::mission && !hands_back_) {
      flown_item_ = std::max(flown_item_, feed_.current_item().value_or(0) - number_of(0));
    }
    if (state) {
      return state;
    }
  }
  return std::nullopt;
}

void LinkedVehicle::expect_in_reach() {
  const bool is_silent = feed_.has_position()
                             ? VehicleFeed::Clock::now() > feed_.last_position() + kLostAfter
                             : time_now() > began_ + kLostAfter;
  if (is_silent) {
    give_up("the link is lost: no position of the vehicle has arrived for 5 s");
  }
  if (feed_.has_restarted()) {
    give_up("the vehicle has restarted");
  }
  if (is_flying_ && !feed_.is_armed()) {
    give_up(kDisarmed + feed_.quoted_text());
  }
  if (!feed_.has_other_mission() && (!is_flying_ || is_in_own_mode())) {
    strange_since_.reset();
  } else if (time_now() <= strange_since_.value_or(time_now()) + kStrange) {
    strange_since_ = strange_since_.value_or(time_now());
  } else if (!feed_.has_other_mission()) {
    give_up("the vehicle is in the mode " + feed_.mode_name() +
            ", which this flight has not asked for: it is left alone" + feed_.quoted_text());
  } else if (commands_ && is_in_own_mode()) {
    give_up_in_hold("another program has replaced the vehicle's mission: it is told to hold");
  } else {
    give_up("another program has replaced the vehicle's mission: it is left alone");
  }
}

void LinkedVehicle::give_up(const std::string& why) {
  commands_ = false;
  if (guardian_) {
    guardian_->stand_down();
  }
  throw VehicleLost(why);
}

void LinkedVehicle::give_up_in_hold(const std::string& why) {
  hold(link_, feed_.vehicle());
  give_up(why);
}

Counters LinkedVehicle::counters() const {
  if (latencies_us_.empty()) {
    return {};
  }
  constexpr double kShare = 0.99;
  std::vector<std::int64_t> sorted = latencies_us_;
  std::sort(sorted.begin(), sorted.end());
  const auto at = std::size_t(std::lround(kShare * double(sorted.size() - 1)));
  return {{"commands", count_}, {"command_latency_p99_us", sorted[at]}};
}
}  // namespace altiplan::link
