// SPDX-License-Identifier: Apache-2.0
#include "host/energy/flight_time.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan::host {

std::optional<double> leg_time(double length, double begin_mps, double end_mps, double most_mps,
                               double acceleration) {
  const double a = begin_mps * begin_mps;
  const double b = end_mps * end_mps;
  if (std::abs(b - a) > 2 * acceleration * length) {
    return std::nullopt;
  }
  const double peak = std::sqrt((2 * acceleration * length + a + b) / 2);
  const double top = std::min(peak, most_mps);
  const double ramps_m = (2 * top * top - a - b) / (2 * acceleration);
  const double level_s = top > 0 ? (length - ramps_m) / top : 0;
  return (2 * top - begin_mps - end_mps) / acceleration + level_s;
}

std::optional<double> ground_speed(double airspeed, double along, double across) {
  if (std::abs(across) >= airspeed) {
    return std::nullopt;
  }
  const double speed = std::sqrt(airspeed * airspeed - across * across) + along;
  return speed > 0 ? std::optional(speed) : std::nullopt;
}

double px4_corner_speed(double turn, double radius, double acceleration, double gain) {
  return std::sqrt(acceleration * gain * radius * std::tan((kPi - turn) / 2));
}

double px4_speed_before(double distance, double end_mps, double acceleration, double jerk) {
  const double b = 4 * acceleration * acceleration / jerk;
  const double c = 2 * acceleration * distance + end_mps * end_mps;
  return std::max(end_mps, (-b + std::sqrt(b * b + 4 * c)) / 2);
}

double px4_return_time(const Eigen::Vector2d& way, double down, const Eigen::Vector2d& wind,
                       double airspeed, double descent_mps) {
  const double sinks_s = std::abs(down) / descent_mps;
  const double length = way.norm();
  if (length == 0) {
    return sinks_s;
  }
  const Eigen::Vector2d ahead = way / length;
  const double along = wind.dot(ahead);
  const double across = (wind - along * ahead).norm();
  const std::optional<double> speed = ground_speed(airspeed, std::min(along, 0.0), across);
  return speed ? length / *speed + sinks_s : kInfinity;
}
}  // namespace altiplan::host
