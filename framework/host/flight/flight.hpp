// SPDX-License-Identifier: Apache-2.0
#pragma once

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

namespace altiplan::host {

/// A change of the true world, or of the goal, at a time or when the vehicle is near a place
/// (whichever is given; each event happens once).
struct FlightEvent {
  enum class Kind { add, remove, move, set_cells, move_goal };
  struct Near {
    Vec3 at{0, 0, 0};
    double within_m = 0;
  };
  Kind kind = Kind::add;
  std::optional<double> at_s;
  std::optional<Near> when_near;
  std::string id;                           ///< of the layer or moving obstacle
  std::optional<Layer> layer;               ///< add: the layer; set_cells: what takes its place
  std::function<Layer(const Layer&)> edit;  ///< set_cells: or what makes that of the layer then
  std::optional<MovingObstacle> moving;     ///< add, where it is a moving obstacle
  Vec3 vector{0, 0, 0};                     ///< move: by how much; move_goal: the new goal
  Box box;             ///< set_cells: where cells change; left out: all of the layer
  bool known = false;  ///< told to the vehicle at once, else it is met like all that is new

  /// Whether it happens to a vehicle that is there then, if it has not happened yet. Times and
  /// places of a track are sums of steps, so that 56 s can read 55.99999999999998 s.
  bool is_due(double time_s, const Vec3& p) const {
    constexpr double kRounding = 1e-9;  // s, m
    return (at_s && time_s >= *at_s - kRounding) ||
           (when_near && (p - when_near->at).norm() <= when_near->within_m + kRounding);
  }
};

enum class ReplanWhen { unsafe, any_change };

struct FlightSetup {
  Request request;        ///< the known world at take-off; limits that apply to tracks
  Request route_request;  ///< the same with those for routes: replanned routes are held to it
  Route route;
  World truth;  ///< all layers and moving obstacles, also those that are not known
  std::vector<FlightEvent> events;
  const LocalPlanner* pilot = nullptr;  ///< null: the route is followed alone
  std::string pilot_name = "route";
  bool always = false;  ///< the pilot flies all the way
  double step_s = 1;
  Session* replanner = nullptr;
  std::string replan_step;  ///< id of the step whose session that is
  ReplanWhen when = ReplanWhen::unsafe;
  std::vector<const Smoother*> smoothers;  ///< for replanned routes
  double replan_latency_s = 1;             ///< of simulated time
  std::optional<double> replan_within_s;   ///< wall time that one replan may take
  std::optional<double> max_time_s;        ///< default: ten times the route's duration
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
  std::vector<std::pair<double, Vec3>> track;  ///< seconds, place; the first is the start
  std::vector<Handover> handovers;
  std::vector<Replan> replans;
  int collisions = 0;                      ///< the first contact ends the flight
  std::optional<double> min_separation_m;  ///< from anything in the true world, negative inside
  bool reached = false;
  Counters counters;  ///< the pilot's, and "steps" of the simulation
  Measures measures;  ///< of the track, in the world as it was in the end
  CheckResult check;  ///< each leg against the true world when it was flown
};

/// Flies the route in simulated time, deterministically (wall time stands in replans[].time_s
/// alone).
///
/// The vehicle follows the route at its speed law. What the planner did not know becomes known when
/// it comes within `vehicle.sensing_m`. The pilot takes over where the stretch of route ahead, as
/// far as the pilot's reach, comes within a twentieth of that reach of something that the route was
/// not planned around: a layer that is new or changed, or a moving obstacle as both fly. It hands
/// back once a straight leg to the route ahead and the stretch after it keep half as far off again,
/// without a sharp turn.
/// Contacts are judged against the true world, exactly along every leg flown.
FlightResult fly(const FlightSetup& setup);
}  // namespace altiplan::host
