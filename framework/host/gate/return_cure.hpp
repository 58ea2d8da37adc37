// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gate/plan_report.hpp"

namespace altiplan::host {

/// A parameter of the autopilot, by the name and in the unit of the parameter file that is given.
struct ReturnCure {
  std::string parameter;
  double value = 0;
};

/// The least height at which the autopilot returns, in whole metres above the present one and up to
/// 600 m more, with which the mission and its failsafe returns pass, judged again with it; none
/// where no height cures them, or several kinds of autopilot may fly the mission.
std::optional<ReturnCure> cure_of_returns(const std::string& file, const formats::MissionFile& plan,
                                          const Mission& world, const GateOptions& options);
}  // namespace altiplan::host
