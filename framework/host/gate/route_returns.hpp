// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gate/fewest_items.hpp"
#include "host/run/pipeline.hpp"

namespace altiplan::host {

/// Has the gate know what of a scenario changes the world in flight, which it does not judge.
void take_changes(const Config& config, const Mission& mission, GateOptions& options);

/// A route as a mission that an autopilot flies.
struct RouteMission {
  Exported written;                   ///< with all points
  std::optional<FewestItems> fewest;  ///< none: these would not be valid
};

/// The mission of a route for the autopilot that the options name, in the mission's wind; an
/// aeroplane circles at its end. Throws Error if the world cannot express what is asked for.
RouteMission mission_of_route(const Mission& mission, const ExportSource& source,
                              ExportOptions options, GateOptions gate);

/// RunOptions::judge_returns: makes the accepted route that mission, with a take-off and a landing
/// of what hovers, and judges its returns.
ReturnsVerdict judge_route_returns(const Config& config, const Mission& mission,
                                   const RunResult& result, const StepEntry& entry);
}  // namespace altiplan::host
