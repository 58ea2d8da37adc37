// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/mission/mission.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::host {

/// From where home, the beginning of the route, can be reached on what the vehicle's battery may
/// give: the scene's `basemap` becomes the energy of the best way home (kit/lattice/home_field.hpp)
/// from the best height above each place, and `numbered` gets the point of no return. Home is the
/// mission's start where the route is empty. Throws Error where no battery is known.
void add_reach(Json& scene, const Mission& mission, const Route& route);
}  // namespace altiplan::host
