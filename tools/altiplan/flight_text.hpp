// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>

#include "host/flight/flight.hpp"

namespace altiplan::cli {

/// Lines on a flight: its end, separation and hand-overs. `is_cut_short`: by a budget.
/// "  exposure of the route: 12.3", a line for each; nothing without any.
void print_metrics(std::FILE* to, const char* of, const host::MetricValues& metrics);
void print_flight(std::FILE* to, const host::FlightResult& flight, bool is_cut_short);
}  // namespace altiplan::cli
