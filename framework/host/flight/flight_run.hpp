// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host/flight/flight.hpp"
#include "host/flight/flight_path.hpp"
#include "host/flight/flight_world.hpp"

namespace altiplan::host {

/// One flight: fly() made into a loop of events, sensing, replanning and steps.
class Flight {
 public:
  explicit Flight(const FlightSetup& setup);
  FlightResult run();

 private:
  void fly_to_the_end();
  double max_time() const;
  /// "timed out after 300 s (max_time_s)"
  std::string time_out() const;
  std::string away() const;
  void end_flight(RunStatus status, Reason reason, std::string message);
  void hand_over(bool to_pilot, std::string why);

  // Events, sensing, and what the route ahead meets: flight_sensing.cpp.
  /// What is due happens; something that then lies over the vehicle has met it.
  void meet_events();
  void sense();
  /// A layer that the route was not planned around and that comes nearer than `room` to the leg.
  const std::string* unplanned_near(const Vec3& a, const Vec3& b, double room) const;
  bool rest_is_blocked() const;
  /// The same with moving obstacles, for a leg begun at time t0.
  const std::string* danger_on(const Vec3& a, double t0, const Vec3& b, double t1,
                               double room) const;
  /// What endangers the stretch of path from `from` on, as far as the pilot reaches.
  const std::string* danger_ahead(double from, double t, double speed, double room) const;
  bool is_free(const Vec3& p, double room) const;

  // Who commands, and what is commanded: flight_command.cpp.
  double speed() const;
  void fly_route();
  void fly_pilot();
  void stuck(const std::string& why);
  /// A point of the path half the pilot's reach ahead, farther where that is covered.
  Vec3 local_target() const;
  /// Takes the nearest way back to the path that stays clear; false where there is none.
  bool hand_back();

  // Routes from where the vehicle is: flight_replanning.cpp.
  void ask_replan();
  /// The new route begins where the vehicle is when it comes.
  void replan_when_due();
  /// The route that the session finds; empty where it finds none.
  Route replan(const Request& request);
  void take_route(Route route, const Request& request);

  // What was flown, judged in the true world: flight_judging.cpp.
  void fly_leg(const State& next);
  /// The leg counts for the separation; the first contact ends the flight.
  void end_on_contact(const Vec3& a, double t0, const Vec3& b, double t1);
  void finish();
  /// The first rule that was broken, with time and place.
  std::string attribute_to() const;
  /// What check() asks of a route as a whole; the legs were judged in the world of their time.
  void judge_whole(const Route& track);

  const FlightSetup& setup_;
  FlightWorld world_;
  Request request_;        ///< of the track, in the known world as it is now
  Request truth_request_;  ///< the same in the true world
  FlightPath path_;
  std::vector<FlightEvent> events_;  ///< still to come
  State state_;
  std::optional<Approach> before_;
  double required_;
  std::unique_ptr<Pilot> pilot_;
  double reach_ = 0;
  bool pilot_commands_ = false;
  bool ended_ = false;
  bool end_moved_ = false;  ///< the last leg was never judged
  double progress_ = 0;     ///< metres along the path
  int steps_ = 0;
  int stuck_ = 0;
  std::optional<double> replan_due_;
  double next_replan_ = -kInfinity;
  std::vector<Change> changes_;         ///< not yet told to the pilot
  std::vector<Change> replan_changes_;  ///< not yet told to the session
  std::vector<Vec3> rest_;
  FlightResult result_;
};
}  // namespace altiplan::host
