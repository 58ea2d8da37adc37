// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gate/changed_plan.hpp"
#include "host/gate/plan_report.hpp"
#include "host/gate/return_height.hpp"

namespace altiplan::host {

/// The least height at which the autopilot returns, in whole metres above the present one and up to
/// 600 m more, with which the mission passes, none of its failsafe returns is refused, and all are
/// judged that were before; none where no height cures them, or several kinds of autopilot may fly
/// the mission.
std::optional<ReturnCure> cure_of_returns(const std::string& file, const formats::MissionFile& plan,
                                          const Mission& world, const GateOptions& options);

/// The fewest markers, one or two, of a return path (188) or a landing start (189) before items of
/// the mission's own that cure it in the same way: where ArduPilot's parameters have it return
/// along the mission, and of a mission without jumps.
std::optional<std::vector<AddedMarker>> markers_that_cure(const std::string& file,
                                                          const formats::MissionFile& plan,
                                                          const Mission& world,
                                                          const GateOptions& options);

/// The mission with rally points beside its own that cure it in the same way: none of them is
/// needless. They lie on the flight, a copter's on ground beside it that is flat by the model, for
/// there it lands. None where no points cure them, up to the number that the autopilot stores.
std::optional<formats::MissionFile> with_rally_cure(const std::string& file,
                                                    const formats::MissionFile& plan,
                                                    const Mission& world,
                                                    const GateOptions& options);
}  // namespace altiplan::host
