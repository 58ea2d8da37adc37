// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "altiplan/kit/penalty/penalty_terms.hpp"

/// \file Lower bounds of penalty costs; the proof is in docs/explanation/certified-bounds.md.
namespace altiplan::kit {

/// At most the length of the shortest path in the plane that comes no nearer to the centre of each
/// disc than its radius, and that where discs do not overlap. Complexity: O(n^3) for n discs.
struct Detour {
  double length = 0;
  std::vector<double> distances;  ///< of the path to the centre of each disc
};
ALTIPLAN_API Detour shortest_detour(const Vec3& from, const Vec3& to,
                                    std::span<const Threat> discs);

/// Lower bound of price(length in the plane) + weight * (fee of each disc, at the least distance to
/// it), over all paths in the plane; `price` never falls. By branch and bound over the least
/// distances to the discs, until no box of them can raise the bound by more than `precision`, or
/// for `max_boxes`.
ALTIPLAN_API double least_with_fees(const Vec3& from, const Vec3& to, const DiscFees& fees,
                                    double weight, const std::function<double(double)>& price,
                                    double precision, int max_boxes);
}  // namespace altiplan::kit
