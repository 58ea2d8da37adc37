// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/local_planner.hpp"
#include "altiplan/measures.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/smoother.hpp"
#include "host/base/run_status.hpp"
#include "host/flight/flown_vehicle.hpp"
#include "host/mission/objective.hpp"

namespace altiplan::host {

/// A change of the true world, or of the goal, at a time or when the vehicle is near a position
/// (whichever is given; each event happens once).
struct FlightEvent {
  enum class Kind { add, remove, move, set_cells, move_goal, visit };
  struct Near {
    Vec3 at{0, 0, 0};
    double within_m = 0;

    bool is_near(const Vec3& p) const {
      constexpr double kRounding = 1e-9;  // metres
      return (p - at).norm() <= within_m + kRounding;
    }
  };
  Kind kind = Kind::add;
  std::optional<double> at_s;
  std::optional<Near> when_near;
  std::string id;                           ///< of the layer or moving obstacle
  std::optional<Layer> layer;               ///< add: the layer; set_cells: its replacement
  std::function<Layer(const Layer&)> edit;  ///< set_cells: or makes it from the current layer
  std::optional<MovingObstacle> moving;     ///< add: if it is a moving obstacle
  Vec3 vector{0, 0, 0};                     ///< move: offset; move_goal: the new goal
  Box box;             ///< set_cells: the region that changes; default: the whole layer
  Near target;         ///< visit: where the pilot flies before it goes back to the route
  bool known = false;  ///< known to the vehicle at once, else it has to be sensed

  bool changes_world() const { return kind != Kind::move_goal && kind != Kind::visit; }

  /// True if the event is due for a vehicle at p at that time. Times and positions of a track are
  /// sums of steps, so that 56 s can read 55.99999999999998 s.
  bool is_due(double time_s, const Vec3& p) const {
    constexpr double kRounding = 1e-9;  // s
    return (at_s && time_s >= *at_s - kRounding) || (when_near && when_near->is_near(p));
  }
};

enum class ReplanWhen { unsafe, any_change };

struct FlightSetup {
  Request request;        ///< the known world at take-off; limits that apply to tracks
  Request route_request;  ///< the same with limits for routes, used for replanned routes
  Route route;
  World truth;  ///< all layers and moving obstacles, known or not
  std::vector<FlightEvent> events;
  const LocalPlanner* pilot = nullptr;  ///< null: just follow the route
  std::string pilot_name = "route";
  bool always = false;  ///< the pilot flies the whole way
  double step_s = 1;
  Session* replanner = nullptr;
  std::string replan_step;  ///< id of the step that owns the session
  ReplanWhen when = ReplanWhen::unsafe;
  std::vector<const Smoother*> smoothers;  ///< for replanned routes
  double replan_latency_s = 1;             ///< of simulated time
  std::optional<double> replan_within_s;   ///< wall-time limit of one replan
  std::optional<double> max_time_s;        ///< default: ten times the route's duration
  FlownVehicle* vehicle = nullptr;         ///< null: flown in simulated time
  std::atomic<double>* flown_s = nullptr;  ///< shows the time of the flight; null: to nobody
  bool telemetry = false;  ///< the track is what a vehicle reports: judged by as_telemetry()
};

struct Handover {
  double at_s = 0;
  std::string to;  ///< the pilot's name, or "route"
  std::string why;
};

struct Replan {
  double at_s = 0;
  std::string step;
  double time_s = 0;  ///< wall time
  RunStatus status = RunStatus::failed;
  Reason reason = Reason::none;
  std::string message;
  Counters counters;
};

struct FlightResult {
  RunStatus status = RunStatus::failed;  ///< solved, collided, not_reached, rejected or failed
  Reason reason = Reason::none;
  std::string message;
  std::vector<std::pair<double, Vec3>> track;  ///< time (s), position; the first is the start
  std::vector<Handover> handovers;
  std::vector<Replan> replans;
  int collisions = 0;                      ///< the first contact ends the flight
  std::optional<double> min_separation_m;  ///< from anything in the true world, negative inside
  bool reached = false;
  /// Of a vehicle that does not follow the route exactly: horizontal distance to its nearest point,
  /// the largest and that exceeded for 0.1 % of the time; and the largest difference in height to
  /// that point.
  std::optional<double> cross_track_max_m;
  std::optional<double> cross_track_p999_m;
  std::optional<double> height_error_max_m;
  Counters counters;                ///< the pilot's, and "steps" of the simulation
  Measures measures;                ///< of the track, in the world at the end of the flight
  MetricValues metrics;             ///< of the track, in the true world at its start
  CheckResult check;                ///< each leg against the true world at the time it was flown
  std::optional<std::string> link;  ///< address of the vehicle; none: simulated
};

/// Flies the route: in simulated time deterministically (wall time appears only in
/// replans[].time_s), or with the setup's vehicle.
///
/// The simulated vehicle follows the route at its speed profile. An obstacle unknown to the planner
/// becomes known within `vehicle.sensing_m`. The pilot takes over if the route ahead, within the
/// pilot's reach, comes closer than 1/20 of that reach to something the route was not planned
/// around: a new or changed layer, or a moving obstacle at the time of passing. It hands back once
/// a straight leg to the route ahead, and the route after it, keep 1.5 times that distance, without
/// a sharp turn. An aeroplane flies by WingGuidance, along the route and in the direction of a
/// pilot's steps; its flight ends at the goal, or as it passes abeam of the route's end. Contacts
/// are judged against the true world, exactly along every leg flown.
FlightResult fly(const FlightSetup& setup);
}  // namespace altiplan::host
