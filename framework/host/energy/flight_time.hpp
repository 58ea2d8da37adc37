// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "altiplan/geometry.hpp"

/// \file The time (s) of ways, in metres and metres a second.
namespace altiplan::host {

/// Of a leg between two speeds, with one acceleration for speeding up and slowing down; none where
/// it is too short for them.
std::optional<double> leg_time(double length, double begin_mps, double end_mps, double most_mps,
                               double acceleration);

/// Over the ground along a track, in a wind of these components along it and across; none where the
/// wind is too strong.
std::optional<double> ground_speed(double airspeed, double along, double across);

/// How fast PX4's multirotor passes a corner, which it turns by `turn` (radians) within a radius.
double px4_corner_speed(double turn, double radius, double acceleration, double gain);
/// How fast it may be that far before a place at which it has that speed.
double px4_speed_before(double distance, double end_mps, double acceleration, double jerk);
/// Of PX4's way home, by the rule that counts no wind from behind; infinite against too strong a
/// wind. The way is to home, in the axes of the wind.
double px4_return_time(const Eigen::Vector2d& way, double down, const Eigen::Vector2d& wind,
                       double airspeed, double descent_mps);
}  // namespace altiplan::host
