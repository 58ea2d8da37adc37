// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gate/plan_report.hpp"

namespace altiplan::host {

/// Judges the failsafe returns from every place of the flight's band, by each autopilot that may
/// fly it, as parts of the mission are judged. A return from the ground, from a take-off or a
/// landing of an aeroplane, and from the mission's own return is none that a failsafe changes:
/// these are left out.
ReturnsReport judge_returns(const formats::MissionFile& plan, const Mission& world,
                            const GateOptions& options);

/// What failsafes of a flight are judged in: the world until so many seconds after its beginning.
struct FailsafeWorld {
  Request request;
  std::string problem;  ///< why that is not all, "" if it is
};
FailsafeWorld world_of_failsafes(const Mission& world, const GateOptions& options, double until_s);
/// Until when failsafes of a flight are looked for at first.
double failsafes_end_s(const TimeSpan& flight);

/// Sorts parameters by their names.
void keep_each_once(std::vector<Parameters::Used>& parameters);
}  // namespace altiplan::host
