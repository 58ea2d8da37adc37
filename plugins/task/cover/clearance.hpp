// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/formats/polygon.hpp"

namespace altiplan::cover {

/// The parts of an area that keep a distance from its islands; their outlines have the islands that
/// reach them cut out.
std::vector<formats::Polygon> clear_of_islands(const formats::Polygon& area, double distance_m);

/// The share of the smaller that two simple rings have in common.
double shared(const formats::Ring& one, const formats::Ring& other);
}  // namespace altiplan::cover
