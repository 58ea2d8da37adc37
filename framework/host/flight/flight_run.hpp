// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/flight/flight.hpp"
#include "host/flight/flight_path.hpp"
#include "host/flight/flight_world.hpp"
#include "host/flight/follow_error.hpp"
#include "host/flight/wing_guidance.hpp"

namespace altiplan::host {

/// One flight: the loop of events, sensing, replanning and steps behind fly().
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

  // Events, sensing, and obstacles on the route ahead: flight_sensing.cpp.
  /// Applies due events; anything that then covers the vehicle is a contact.
  void meet_events();
  void sense();
  /// A layer that the route was not planned around, nearer than `room` to the leg; null if none.
  const std::string* unplanned_near(const Vec3& a, const Vec3& b, double room) const;
  bool rest_is_blocked() const;
  /// The same including moving obstacles, for a leg flown from t0 to t1.
  const std::string* danger_on(const Vec3& a, double t0, const Vec3& b, double t1,
                               double room) const;
  /// The obstacle that endangers the path from `from` onward, within the pilot's reach.
  const std::string* danger_ahead(double from, double t, double speed, double room) const;
  bool is_free(const Vec3& p, double room) const;

  // Route following, pilot and hand-over: flight_command.cpp.
  double speed() const;
  /// The path has changed, and begins anew.
  void restart_path();
  void fly_route();
  void fly_pilot();
  void stuck(const std::string& why);
  /// The goal, or the point at which the path joins its loiter circle.
  Goal goal_of_pilot() const;
  /// A point of the path half the pilot's reach ahead, or farther if that point is blocked.
  Vec3 local_target() const;
  /// Takes the nearest clear leg back to the path; false if there is none.
  bool hand_back();

  // An aeroplane: flight_wing.cpp.
  /// What the guidance flies toward: a point, and the horizontal distance to it along the route.
  struct Reference {
    Vec3 point{0, 0, 0};
    double ahead = 0;
  };
  using ReferenceFor = std::function<Reference(const State&)>;
  /// Ends the flight in wind that is not below the airspeed.
  void take_off_wing();
  void fly_wing_on_route();
  /// In the direction in which a pilot's step leads.
  void fly_wing_toward(const State& command);
  /// Adds points to the track where it bends, and where the wind changes.
  void fly_wing(double duration, bool on_route, const ReferenceFor& reference_for);
  Reference reference_on_route(const State& now);
  /// Where the last leg goes on in its direction, or along the goal's loiter circle.
  Vec3 beyond_the_end(double distance) const;
  void note_errors(const State& now, double dt);
  /// At the goal, or abeam of the route's end: an aeroplane cannot stop there.
  bool passes_goal(const State& now, bool on_route) const;

  // Replanning from the vehicle's position: flight_replanning.cpp.
  void ask_replan();
  /// The new route begins at the vehicle's position at that time.
  void replan_when_due();
  /// The route that the session finds; empty if none.
  Route replan(const Request& request);
  void take_route(Route route, const Request& request);

  // The track, judged in the true world: flight_judging.cpp.
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
  double reference_ = 0;    ///< the same of the guidance's reference point
  std::optional<WingGuidance> wing_;
  bool passes_goal_ = false;  ///< an aeroplane's flight ends
  FollowError follow_error_;
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
