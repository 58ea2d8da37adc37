// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/height_field.hpp"
#include "altiplan/kit/layers/ground_within.hpp"

namespace altiplan::kit {

/// Searches the cells of an elevation model, those near the leg first; voids have no ground.
ALTIPLAN_API void search_field(GroundWithin& ground, const HeightField& field);
}  // namespace altiplan::kit
