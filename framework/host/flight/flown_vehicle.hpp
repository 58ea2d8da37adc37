// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "altiplan/error.hpp"
#include "altiplan/plan_result.hpp"
#include "altiplan/request.hpp"
#include "host/flight/flight_path.hpp"
#include "host/flight/follow_error.hpp"

namespace altiplan::host {

/// The route still to be flown, and the vehicle's progress along it.
struct RouteAhead {
  FlightPath path;
  double progress = 0;   ///< metres along the path
  double reference = 0;  ///< the same of the point that the guidance flies toward
  FollowError error;     ///< of a vehicle that does not follow exactly

  /// The path has changed, and begins anew.
  void restart() { progress = reference = 0; }
  /// Advances to the point nearest to a vehicle that has flown for dt seconds, at most up to the
  /// reference, and notes the distance from it.
  void advance(const State& now, double dt) {
    progress = path.nearest_level(now.position, progress, reference);
    const Vec3 off = now.position - path.at(progress);
    error.add(off.head<2>().norm(), off.z(), dt);
  }
};

/// How a part of a flight ends.
enum class FlownTo { on_the_way, end_of_route, past_goal };

/// The vehicle cannot be flown any further.
class VehicleLost : public Error {
 public:
  using Error::Error;
};

/// What a flight is flown with. Each function flies until its time is over, or until a report is
/// answered by false.
class FlownVehicle {
 public:
  /// Called with each point of the track. The call may change the route; false: the flight ends.
  using Report = std::function<bool(const State&)>;

  virtual ~FlownVehicle() = default;
  /// The state in which the flight along the route begins; `first` is where the route does. The
  /// request outlives the flight, and has the known world and the goal as they are at any time.
  virtual State take_off(const Request& request, const RouteAhead& route, const State& first) = 0;
  /// False: it is not to be commanded off its route.
  virtual bool takes_commands() const { return true; }
  /// Follows the route for `duration` seconds.
  virtual FlownTo follow(RouteAhead& route, const State& from, double duration,
                         const Report& report) = 0;
  /// Flies as a pilot commands, until the command's time.
  virtual FlownTo go(RouteAhead& route, const State& from, const State& command,
                     const Report& report) = 0;
  /// The flight is over: nothing is commanded any more.
  virtual void release() {}
  virtual Counters counters() const { return {}; }
};

/// Flies in simulated time: exactly along the route, or an aeroplane by WingGuidance.
std::unique_ptr<FlownVehicle> simulated_vehicle(const Vehicle& vehicle);

/// True if an aeroplane is at the goal, or abeam of the route's end: it cannot stop there.
bool passes_goal(const RouteAhead& route, const Request& request, const State& now, bool on_route);
}  // namespace altiplan::host
