// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/flight/flight.hpp"
#include "host/plugins/registry.hpp"

namespace altiplan::bench {

/// A seeded flight of 16 km straight through 20 obstacles that the route does not know, all of them
/// within the sensor's range from the start: ten posts, and ten spheres that cross the path no
/// faster than the vehicle; with or without 16 hills.
host::FlightSetup crowded_flight(std::uint64_t seed, bool over_hills, host::Registry& registry);

inline constexpr std::size_t kMovers = 10;
}  // namespace altiplan::bench
