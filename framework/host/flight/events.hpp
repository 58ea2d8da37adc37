// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/flight/flight.hpp"
#include "host/mission/mission.hpp"

namespace altiplan::host {

/// Builds the scenario's events and their layers. Throws ConfigError naming the event.
std::vector<FlightEvent> build_events(const Config& config, const Mission& mission);
}  // namespace altiplan::host
