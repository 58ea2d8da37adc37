// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/flight/flight.hpp"
#include "host/mission/mission.hpp"

namespace altiplan::host {

/// The scenario's events, their layers built. Throws ConfigError naming the event.
std::vector<FlightEvent> build_events(const Config& config, const Mission& mission);
}  // namespace altiplan::host
