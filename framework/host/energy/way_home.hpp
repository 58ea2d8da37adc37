// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "altiplan/request.hpp"

/// \file The straight way home, as an autopilot estimates it.
namespace altiplan::host {

/// Seconds of a way home in plan, and of the height that is lost or gained, by PX4's rule
/// (RtlTimeEstimator, RangeRTLTest.cpp): a wind from behind does not count. Infinite against too
/// strong a wind.
double time_home(const Eigen::Vector2d& way, double down_m, const Eigen::Vector2d& wind,
                 double airspeed_mps, double vertical_mps);

/// The last second of a route at which what it has taken, and the straight way back to its start by
/// that rule, leave the reserve in the battery: the last of its flight if they always do. None
/// where no battery is known, or already the first does not. Nothing tells whether that way is
/// free.
std::optional<double> point_of_no_return(const Route& route, const Request& request);
}  // namespace altiplan::host
