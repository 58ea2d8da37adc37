// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/mission/mission.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::host {

/// From where home, the beginning of the route, can be reached on what the vehicle's battery may
/// give: the scene's `basemap` becomes the energy of the best way home (kit/lattice/home_field.hpp)
/// from the best height above each place, and `numbered` gets the point of no return. Home is the
/// mission's start where the route is empty. Throws Error where no battery is known.
void add_reach(Json& scene, const Mission& mission, const Route& route);
/// The same of another home, or of the lowest place above it where the vehicle may be; with the
/// point of no return where it is known.
void add_reach(Json& scene, const Mission& mission, Vec3 home,
               const std::optional<Vec3>& point_of_no_return);
}  // namespace altiplan::host
