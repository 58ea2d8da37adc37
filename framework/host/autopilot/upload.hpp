// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/autopilot/flight.hpp"
#include "host/autopilot/sequence.hpp"

namespace altiplan::host {

/// The commands as the autopilot stores them: 1e-7 degrees, and of ArduPilot's centimetres, whole
/// metres, tens of metres, seconds and turns, without what is left over.
std::vector<formats::MissionCommand> stored(std::vector<formats::MissionCommand> commands,
                                            formats::Autopilot autopilot);

/// Reports what the autopilot refuses, skips or leaves to others; false if the mission is not flown
/// because of it.
bool check_upload(const Sequence& commands, Flight& flight);
}  // namespace altiplan::host
