// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "altiplan/request.hpp"
#include "altiplan/swept_volume.hpp"

namespace altiplan {

/// A motion of the body over t in [0, 1]. At equal t, no point of the body is farther than
/// bend * dt² from the straight line between its places at the ends of a piece dt.
struct Sweep {
  /// Adds the placements of a moment: one, or those at many headings if any is possible.
  std::function<void(double t, std::vector<Placement>& all)> place;
  double bend;
  double between;  ///< what lies between the headings is no farther than that from their hull
};

/// The layer that the vehicle's body meets on a leg, or null; null without a body.
///
/// On a straight leg the attitude is constant. At its beginning the body turns from that of the
/// approach by the shortest rotation (both ways if it reverses); along a turn it yaws with it,
/// banked by atan(speed² / (g radius)), and rolls at its ends. A body whose heading nothing gives
/// (a first leg straight up) must fit at any. On a leg of no length nothing gives an attitude.
const Layer* body_meets(const std::optional<Approach>& before, const Leg& leg,
                        const Request& request);

/// The motions of the vehicle's body on a leg, in order.
std::vector<Sweep> body_sweeps(const std::optional<Approach>& before, const Leg& leg,
                               const Request& request);
}  // namespace altiplan
