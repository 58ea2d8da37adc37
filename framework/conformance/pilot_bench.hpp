// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "worlds.hpp"

namespace altiplan::conformance::pilots {

// The contract of Pilot, and the requirements related to it.
inline constexpr const char* kContinues = "Pilot contract 1: continues from the observed state";
inline constexpr const char* kTimeAndSpeed =
    "Pilot contract 2: 0 < next.time - state.time <= max_dt, and the speed is at most the "
    "vehicle's";
inline constexpr const char* kNoAllocation = "Pilot contract 3: no allocation in a step";
inline constexpr const char* kEqualSteps =
    "Pilot contract 4: equal observations in equal order give equal steps";
inline constexpr const char* kReach = "Pilot::reach_m: obstacles farther away do not influence it";
inline constexpr const char* kArrived = "PilotStep: arrived means within the goal's tolerance";
inline constexpr const char* kOpen = "Pilot: arrives in an open world";
inline constexpr const char* kNotThrough =
    "Pilot: a step with outcome flying does not lead through an obstacle of the observed world";
inline constexpr const char* kLevel = "Planner trait `planar`: level flight stays on its level";
inline constexpr const char* kNoThrow = "Pilot: being stuck is an outcome, never an exception";

/// The same flight at the start's height.
Request in_level_flight(Request request);

struct Bench {
  Factory<LocalPlanner> make;
  Options options;

  double reach() const {
    const double reach = make()->begin(flight(nullptr))->reach_m();
    return std::isfinite(reach) && reach > 0 ? reach : 10 * options.unit_m;
  }
  /// Eastward, 8 reaches far, a hundredth of the reach per second; scaled by `reach` itself until
  /// that is known.
  Request flight(std::shared_ptr<const World> world, double reach = 3000) const {
    Request request;
    request.world = world != nullptr ? std::move(world) : std::make_shared<const World>();
    request.start.position = {0, 0, reach};
    request.goal.position = {8 * reach, 0.5 * reach, 1.1 * reach};
    request.goal.tolerance_m = 0.01 * reach;
    request.volume = {{-4 * reach, -6 * reach, 0}, {12 * reach, 6 * reach, 3 * reach}};
    request.vehicle.speed_mps = 0.01 * reach;
    request.vehicle.radius_m = request.limits.min_clearance = 0.001 * reach;
    request.random = RandomStream(options.seed);
    return make()->traits().spatial ? request : in_level_flight(request);
  }
};

std::shared_ptr<const World> balls(std::vector<Sphere> all);
/// Balls beside and across the straight path, none within half a reach of its ends.
std::vector<Sphere> drawn(std::uint64_t seed, const Request& request, double reach);
Observation first_observation(const Request& request);
using conformance::text;
std::string text(const Observation& seen);

/// A step; a refusal by Pilot::step becomes a finding, and ends the flight.
PilotStep step_of(Pilot& pilot, const Observation& seen, Report& report);

struct Flown {
  PilotStep last;
  int steps = 0;
};
/// Flies until the pilot arrives or is stuck, with each step judged; `between` may change its
/// observation before a step.
Flown fly(const Bench& bench, const Request& request, Report& report, int max_steps,
          const std::function<void(Observation&, int)>& between = {});
}  // namespace altiplan::conformance::pilots
