// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>

#include <string>

#include "host/flight/flight.hpp"
#include "host/run/run_result.hpp"

namespace altiplan::cli {

/// How the accepted route is flown: "24.1 min, 41.3 Wh of 64.8 Wh that may be used (battery 90.0
/// Wh, reserve 20 %), up to 3.912 km from the start; up to 43.0 degrees down, at 2.2 m/s"; "" where
/// nothing is known of the vehicle besides its speed.
std::string flown_in_words(const host::RunResult& result);
/// "waits 30 s at (400, 0, 50); lands for 20 s and drops its cargo at (90, 10, 60)", of a task; ""
/// where it does nothing at its places.
std::string stops_in_words(const host::RunResult& result);

/// "  exposure of the route: 12.3", a line for each; nothing without any.
void print_metrics(std::FILE* to, const char* of, const host::MetricValues& metrics);
/// Lines on a flight: its end, separation and hand-overs. `is_cut_short`: by a budget.
void print_flight(std::FILE* to, const host::FlightResult& flight, bool is_cut_short);
}  // namespace altiplan::cli
