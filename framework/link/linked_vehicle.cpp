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
/// So long a stop may wait.
constexpr Time kFeedSlice{100};
/// Longer than a heartbeat takes to report a mode that has just been changed.
constexpr Time kStrange{1500};
/// Without a position, or the item that it flies to, the vehicle is asked to send them.
constexpr Time kAskForReports{1500};
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
  while (!flies_route() && next_position()) {
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
  if (flight_.command) {
    ask_for_reports();  // as often as commands are
  }
  constexpr int kTries = 3;  // not every vehicle reports its item
  Time ask_at = began_ + kAskForReports;
  for (int n = 0; !feed_.has_position() || (!feed_.current_item() && n < kTries);) {
    if (stop_.stop_requested()) {
      return;
    }
    expect_in_reach();
    feed_.next(kFeedSlice);
    if (time_now() >= ask_at) {
      ask_for_reports();
      ask_at += kAskForReports;
      ++n;
    }
  }
}

void LinkedVehicle::ask_for_reports() {
  const auto ask = [&](std::uint32_t message, float period_us) {
    feed_.send(command_to(feed_.vehicle(), VehicleCommand::kSetMessageInterval, float(message),
                          period_us));
  };
  ask(GlobalPositionInt::kDeclared.id, 1e5F);
  ask(MissionCurrent::kDeclared.id, 5e5F);
}

bool LinkedVehicle::flies_route() const {
  const int first = number_of(0);
  return feed_.mode() == FlightMode::mission && feed_.is_armed() &&
         (feed_.current_item().value_or(first) > first || feed_.reached_item() == first);
}

int LinkedVehicle::number_of(std::size_t item) const {
  return int(item) + (feed_.vehicle().is_ardupilot() ? 1 : 0);  // to which item 0 is home
}

void LinkedVehicle::start_mission() {
  const Vehicle& vehicle = feed_.vehicle();
  const bool is_copter = vehicle.is_ardupilot() && !is_fixed_wing(vehicle.heartbeat);
  const auto change_mode = [&](FlightMode mode) {
    expect_done(feed_.request(mode),
                mode == FlightMode::mission ? "to fly its mission" : "the mode that it arms in");
  };
  feed_.set_item(number_of(0));
  if (is_copter && !feed_.is_armed()) {
    change_mode(FlightMode::commanded);  // ArduCopter does not arm in AUTO
  } else {
    change_mode(FlightMode::mission);
  }
  if (!feed_.is_armed()) {
    expect_done(command_to(vehicle, VehicleCommand::kArm, 1), "to arm");
  }
  if (is_copter) {
    change_mode(FlightMode::mission);
    expect_done(command_to(vehicle, VehicleCommand::kStartMission), "to start its mission");
  }
  if (stop_.stop_requested()) {
    return;
  }
  constexpr float kAir = 0;
  constexpr float kGround = 1;
  const auto& wing = request_->vehicle.wing;
  feed_.send(command_to(vehicle, VehicleCommand::kChangeSpeed, wing ? kAir : kGround,
                        float(wing ? wing->airspeed_mps : request_->vehicle.speed_mps), -1));
}

void LinkedVehicle::expect_done(const CommandLong& command, const std::string& what) {
  constexpr int kTries = 3;
  constexpr Time kTimeout{1500};
  for (int n = 0; n < kTries && !stop_.stop_requested(); ++n) {
    feed_.send(command);
    for (const Time end = time_now() + kTimeout; time_now() < end && !stop_.stop_requested();) {
      expect_in_reach();
      feed_.next(kFeedSlice);
      if (const std::optional<int> result = feed_.acknowledged(command.command)) {
        if (*result == 0) {
          return;
        }
        await_words();
        give_up("the vehicle refuses " + what + feed_.quoted_text());
      }
    }
  }
  if (!stop_.stop_requested()) {
    give_up("the vehicle does not answer the command " + what);
  }
}

void LinkedVehicle::await_words() {
  constexpr Time kWordsFollow{300};
  for (const Time end = time_now() + kWordsFollow; time_now() < end && !stop_.stop_requested();) {
    feed_.next(kFeedSlice);
  }
}

FlownTo LinkedVehicle::follow(RouteAhead& route, const State& from, double duration,
                              const Report& report) {
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
  const Vec3 velocity = (command.position - from.position) / (command.time_s - from.time_s);
  const SetPoint wanted = toward(from.position, velocity, command.position.z());
  take_command();
  stream(wanted, from);
  const auto latency = VehicleFeed::Clock::now() - feed_.last_position();
  latencies_us_.push_back(std::chrono::duration_cast<std::chrono::microseconds>(latency).count());
  ++count_;
  for (State last = from; last.time_s < command.time_s - kLengthTolerance;) {
    const std::optional<State> now = next_position();
    if (!now || !report(*now)) {
      break;
    }
    last = *now;
    if (host::passes_goal(route, *request_, last, false)) {
      return FlownTo::past_goal;
    }
    take_command();
    stream(wanted, last);
  }
  return FlownTo::on_the_way;
}

std::optional<State> LinkedVehicle::next_position() {
  while (!stop_.stop_requested()) {
    expect_in_reach();
    std::optional<State> state = feed_.next(kFeedSlice);
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
  if (!is_flying_ || (feed_.is_armed() && is_in_own_mode())) {
    strange_since_.reset();
  } else if (time_now() > strange_since_.value_or(time_now()) + kStrange) {
    give_up(feed_.is_armed() ? "the vehicle is in the mode " + feed_.mode_name() +
                                   ", which this flight has not asked for: it is left alone" +
                                   feed_.quoted_text()
                             : "the vehicle has disarmed" + feed_.quoted_text());
  } else {
    strange_since_ = strange_since_.value_or(time_now());
  }
}

void LinkedVehicle::give_up(const std::string& why) {
  commands_ = false;
  if (guardian_) {
    guardian_->stand_down();
  }
  throw VehicleLost(why);
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
