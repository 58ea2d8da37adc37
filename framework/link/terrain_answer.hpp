// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/world.hpp"
#include "link/mission_transfer.hpp"

namespace altiplan::link {

/// The blocks of 4 x 4 heights that a request asks for (mavlink.io/en/services/terrain.html), from
/// the ground of the world, in whole metres; without those of which the world does not have all.
Messages terrain_answer(const TerrainRequest& request, const World& world);
}  // namespace altiplan::link
