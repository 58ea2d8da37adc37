// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "host/flight/flown_vehicle.hpp"
#include "link/guardian.hpp"
#include "link/set_point.hpp"
#include "link/vehicle_feed.hpp"

namespace altiplan::link {

inline const std::string kDisarmed = "the vehicle has disarmed in flight";

struct LinkedFlight {
  std::vector<Vec3> items;  ///< of the route in the vehicle's mission, from its first item on
  bool arm = false;         ///< arm, take off and start the mission
  bool command = false;     ///< change modes and send set-points in flight
  std::function<void(const std::string&)> say;  ///< for the user
};

/// A vehicle at the other end of a link. Legs that lead to an item of its mission it flies by
/// itself; where it may be commanded, other legs, and a pilot's steps, by set-points, each for a
/// short time. Times are the vehicle's.
///
/// Throws VehicleLost when no position arrives for 5 s, when the vehicle refuses, disarms or
/// restarts, and when somebody else changes its mode: from then on nothing is sent.
class LinkedVehicle final : public host::FlownVehicle {
 public:
  /// The link and the world, for its frame and ground, outlive it.
  LinkedVehicle(Link& link, const Vehicle& vehicle, const World& world, LinkedFlight flight,
                std::stop_token stop);

  State take_off(const Request& request, const host::RouteAhead& route,
                 const State& first) override;
  bool takes_commands() const override { return flight_.command; }
  host::FlownTo follow(host::RouteAhead& route, const State& from, double duration,
                       const Report& report) override;
  host::FlownTo go(host::RouteAhead& route, const State& from, const State& command,
                   const Report& report) override;
  /// Leaves a vehicle that is being commanded in hold. Throws VehicleLost if it has disarmed.
  void release() override;
  Counters counters() const override;

 private:
  /// The next position; none after a stop.
  std::optional<State> next_position();
  void expect_in_reach();
  /// False where the mode is nobody's that this flight has asked for.
  bool is_in_own_mode() const;
  [[noreturn]] void give_up(const std::string& why);
  /// The same after a change that was asked for and may come yet: the vehicle is told to hold.
  [[noreturn]] void give_up_in_hold(const std::string& why);

  // The begin of the mission.
  void await_position();
  void start_mission();
  /// Of a start that failed: holds in the air, or disarms on the ground.
  void undo_start();
  /// Autopilots turn to the second item before they are at the first.
  void await_nearest(const Vec3& start);
  /// Asks again until the vehicle reports that its mission begins with the first item.
  void begin_at_first_item();
  /// Sends until `is_done`; gives up where it is refused, or not done in time.
  void expect(const CommandLong& command, const std::string& what,
              const std::function<bool()>& is_done);
  void change_mode(FlightMode mode, const std::string& what);
  void arm_and_start();
  /// Before the first item: gives up where a mission that was started does not go on; tells now and
  /// then what is waited for.
  void watch_start();
  /// After a refusal: its reason comes as a text of its own, if it comes.
  void await_words();
  /// True once the vehicle flies from the first item to the second.
  bool flies_route() const;
  int number_of(std::size_t item) const;

  // Commands.
  /// The mission's item at a waypoint.
  std::optional<int> item_at(const Vec3& waypoint) const;
  /// Commands along the route where it is not the mission's, and hands back where it is.
  void steer(const host::RouteAhead& route, const State& now);
  SetPoint along(const host::RouteAhead& route, const State& now) const;
  /// Of a pilot that commands no change of height, to the last one commanded, at first the route's:
  /// the vehicle would drift from where it is reported.
  Vec3 commanded_velocity(const host::RouteAhead& route, const State& from, const State& command);
  SetPoint toward(const Vec3& from, const Vec3& velocity, double height) const;
  /// Of an aeroplane: gives up, in hold, where it flies on and does not turn as it is told to.
  void expect_turn(const State& from, const State& command, const State& flown);
  void take_command();
  void hand_back(int item);
  void ask(FlightMode mode);
  void stream(const SetPoint& wanted, const State& now);

  Link& link_;
  VehicleFeed feed_;
  const World& world_;
  LinkedFlight flight_;
  std::stop_token stop_;
  const Request* request_ = nullptr;
  Time began_ = time_now();
  bool is_flying_ = false;                 ///< its mission
  int flown_item_ = 0;                     ///< the last that the autopilot flew to by itself
  std::optional<Time> not_started_since_;  ///< before the first item: off the mission
  std::optional<Time> strange_since_;
  Time told_at_{0};

  std::optional<Guardian> guardian_;
  bool commands_ = false;  ///< the vehicle is in its commanded mode, or is asked to be
  bool is_confirmed_ = false;
  bool hands_back_ = false;
  Time ask_at_{0};
  int heartbeats_at_ask_ = 0;
  int asks_ = 0;
  std::optional<double> height_;  ///< metres, of the last command of the pilot
  struct Turn {
    double at_s;
    double asked;  ///< radians, positive to the left
    double flown;
  };
  std::deque<Turn> turns_;                  ///< of the last commands
  double streamed_s_ = 0;                   ///< time of the last set-point
  std::int64_t count_ = 0;                  ///< commands of the pilot
  std::vector<std::int64_t> latencies_us_;  ///< from the arrival of a position to its command
};
}  // namespace altiplan::link
