// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "altiplan/request.hpp"

/// \file The straight way home, as an autopilot estimates it.
namespace altiplan::host {

/// Seconds of a way home in plan, and of the height that is lost or gained, by PX4's rule
/// (RtlTimeEstimator, RangeRTLTest.cpp): a wind from behind does not count. Infinite against too
/// strong a wind.
double time_home(const Eigen::Vector2d& way, double down_m, const Eigen::Vector2d& wind,
                 double airspeed_mps, double vertical_mps);

/// The last second of a route at which what it has taken, and the way home from there, leave the
/// reserve in the battery, and where that is.
struct NoReturn {
  double time_s = 0;
  Vec3 place{0, 0, 0};
};
/// The last of its flight if they always do; none where no battery is known, or already the first
/// does not. `home_wh`: what the way home from a place takes.
std::optional<NoReturn> point_of_no_return(const Route& route, const Request& request,
                                           const std::function<double(const Vec3&)>& home_wh);
/// The same of the straight way back to the route's start by that rule. Nothing tells whether it is
/// free.
std::optional<double> point_of_no_return(const Route& route, const Request& request);
}  // namespace altiplan::host
