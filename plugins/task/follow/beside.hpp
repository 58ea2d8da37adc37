// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/route.hpp"

namespace altiplan::follow {

/// How much farther than the offset a route beside a line may be, outside of a bend: metres.
constexpr double kBeyond = 0.5;

/// The route beside a line, `offset` to its left (negative: to its right), seen from above; heights
/// are 0. Legs are parallel to the line's and meet where they do; outside of a bend they go around
/// it, at most kBeyond farther. What would be nearer than the offset to any leg of the line is left
/// out: short legs inside a bend, and at the ends. Throws Error, with the place, where no route
/// beside the line is left, or where it would have to come nearer.
Polyline beside(const Polyline& line, double offset);
}  // namespace altiplan::follow
