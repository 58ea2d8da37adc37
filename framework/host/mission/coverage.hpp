// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/world.hpp"

namespace altiplan::host {

/// Bounds of all layers with ground; empty if there is none.
Box ground_area(const World& world);

/// Of a point given by longitude and latitude that lies beside the data or the volume: where it is,
/// what they cover, and whether it would lie within if its numbers were exchanged. "" for other
/// points, and where the world has no position on the Earth.
std::string beside(const Point& point, const Frame& frame, const std::string& what,
                   const Box& area);
}  // namespace altiplan::host
