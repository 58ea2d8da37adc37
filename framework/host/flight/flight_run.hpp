// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/flight/flight.hpp"
#include "host/flight/flight_world.hpp"
#include "host/flight/flown_vehicle.hpp"

namespace altiplan::host {

/// One flight: the loop of events, sensing, replanning and steps behind fly().
class Flight {
 public:
  explicit Flight(const FlightSetup& setup);
  FlightResult run();

 private:
  void fly_to_the_end();
  /// Ends the flight in wind that is not below the airspeed.
  void take_off();
  void release();
  double max_time() const;
  /// "timed out after 300 s (max_time_s)"
  std::string time_out() const;
  std::string away() const;
  void end_flight(RunStatus status, Reason reason, std::string message);

  // Events and sensing: flight_events.cpp.
  /// Applies due events; anything that then covers the vehicle is a contact.
  void meet_events();
  void sense();

  // Who has the command, and why: handover.cpp.
  /// Of an obstacle from the route ahead: the pilot takes over below it.
  double takeover_distance() const;
  /// Hands over to the pilot if the route ahead is unsafe and the vehicle takes commands.
  bool pilot_takes_over();
  /// Hands over to the pilot for a target, or notes that it cannot.
  void meet_target(const FlightEvent::Near& target);
  /// Without the permission to command.
  void note(const std::string& why);
  void hand_over(bool to_pilot, std::string why);
  /// Takes the nearest clear leg back to the path; false if there is none.
  bool hand_back();

  // Obstacles on the route ahead: dangers_ahead.cpp.
  /// A layer that the route was not planned around, nearer than `room` to the leg; null if none.
  const std::string* unplanned_near(const Vec3& a, const Vec3& b, double room) const;
  bool rest_is_blocked() const;
  /// The same including moving obstacles, for a leg flown from t0 to t1.
  const std::string* danger_on(const Vec3& a, double t0, const Vec3& b, double t1,
                               double room) const;
  /// The obstacle that endangers the path from `from` onward, within the pilot's reach.
  const std::string* danger_ahead(double from, double t, double speed, double room) const;
  bool is_free(const Vec3& p, double room) const;

  // The vehicle follows the route: route_follower.cpp.
  double speed() const;
  void fly_route();
  FlownVehicle::Report track_report();
  void take(FlownTo flown);

  // The pilot flies: pilot_steps.cpp.
  void fly_pilot();
  void stuck(const std::string& why);
  /// The target; else the goal, or the point at which the path joins its loiter circle.
  Goal goal_of_pilot() const;
  /// A point of the path half the pilot's reach ahead, or farther if that point is blocked.
  Vec3 local_target() const;

  // Replanning from the vehicle's position: flight_replanning.cpp.
  void ask_replan();
  /// The new route begins at the vehicle's position at that time.
  void replan_when_due();
  /// The route that the session finds; empty if none.
  Route replan(const Request& request);
  void take_route(Route route, const Request& request);

  // The track, recorded and judged in the true world by track_judge.hpp: track_record.cpp.
  void fly_leg(const State& next);
  /// Updates the separation; the first contact ends the flight.
  void end_on_contact(const Vec3& a, double t0, const Vec3& b, double t1);
  void finish();
  /// The first violated constraint, with time and position.
  std::string attribute_to() const;
  /// The checks of a whole route, as in check(); legs were judged in the world of their time.
  void judge_whole();

  const FlightSetup& setup_;
  FlightWorld world_;
  Request request_;        ///< of the track, in the known world as it is now
  Request truth_request_;  ///< the same in the true world
  RouteAhead route_;
  std::vector<FlightEvent> events_;  ///< still to come
  State state_;
  std::optional<Approach> before_;
  double required_;
  std::unique_ptr<FlownVehicle> simulated_;  ///< if the setup has no vehicle
  FlownVehicle* vehicle_;
  std::unique_ptr<Pilot> pilot_;
  double reach_ = 0;
  bool pilot_commands_ = false;
  bool ended_ = false;
  bool end_moved_ = false;                  ///< the last leg was never judged
  std::vector<FlightEvent::Near> targets_;  ///< still to be visited, in order
  bool passes_goal_ = false;                ///< an aeroplane's flight ends
  int steps_ = 0;
  int stuck_ = 0;
  std::optional<double> replan_due_;
  double next_replan_ = -kInfinity;
  std::vector<Change> changes_;         ///< not yet passed to the pilot
  std::vector<Change> replan_changes_;  ///< not yet passed to the session
  std::vector<Vec3> rest_;
  FlightResult result_;
};
}  // namespace altiplan::host
