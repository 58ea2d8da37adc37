// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "altiplan/request.hpp"

namespace altiplan {

/// The layer that the vehicle's body meets on a leg, or null; null without a body.
///
/// On a straight leg the attitude is constant. At its beginning the body turns from that of the
/// approach by the shortest rotation (both ways if it reverses); along a turn it yaws with it,
/// banked by atan(speed² / (g radius)), and rolls at its ends. A body whose heading nothing gives
/// (a first leg straight up) must fit at any. On a leg of no length nothing gives an attitude.
const Layer* body_meets(const std::optional<Approach>& before, const Leg& leg,
                        const Request& request);
}  // namespace altiplan
