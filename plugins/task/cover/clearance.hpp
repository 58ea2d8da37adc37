// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/formats/polygon.hpp"

namespace altiplan::cover {

/// The parts of an area that keep a distance from its islands; their outlines have the islands that
/// reach them cut out.
std::vector<formats::Polygon> clear_of_islands(const formats::Polygon& area, double distance_m);
}  // namespace altiplan::cover
