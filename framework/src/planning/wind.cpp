// SPDX-License-Identifier: Apache-2.0
#include "altiplan/wind.hpp"

#include <algorithm>

namespace altiplan {

Vec3 Wind::at(double z) const {
  Vec3 velocity(0, 0, 0);
  for (const Layer& layer : layers) {
    if (z >= layer.above_m) {
      velocity = layer.velocity;
    }
  }
  return velocity;
}

std::vector<double> Wind::crossings(double from_z, double to_z) const {
  std::vector<double> shares;
  for (const Layer& layer : layers) {
    const double share = (layer.above_m - from_z) / (to_z - from_z);
    if (share > 0 && share < 1) {
      shares.push_back(share);
    }
  }
  std::sort(shares.begin(), shares.end());
  return shares;
}

std::optional<double> ground_speed(const Vec3& course, double airspeed, const Vec3& wind) {
  const double run = course.head<2>().norm();
  const double along = (wind.x() * course.x() + wind.y() * course.y()) / run;
  const double across = (wind.y() * course.x() - wind.x() * course.y()) / run;
  if (!(std::abs(across) <= airspeed)) {
    return std::nullopt;
  }
  const double speed = along + std::sqrt(airspeed * airspeed - across * across);
  return speed > 0 ? std::optional(speed) : std::nullopt;
}

std::optional<double> heading_on(const Vec3& course, double airspeed, const Vec3& wind) {
  const Vec3 along = Vec3(course.x(), course.y(), 0).normalized();
  const std::optional<double> speed = ground_speed(along, airspeed, wind);
  if (!speed) {
    return std::nullopt;
  }
  const Vec3 through_air = *speed * along - wind;
  return std::atan2(through_air.y(), through_air.x());
}

double flight_time(const Vec3& from, const Vec3& to, double airspeed, const Wind& wind) {
  const Vec3 leg = to - from;
  if (!has_heading(leg)) {
    return leg.norm() / airspeed;
  }
  double time = 0;
  double begin = 0;
  std::vector<double> ends = wind.crossings(from.z(), to.z());
  ends.push_back(1);
  for (const double end : ends) {
    const double z = from.z() + (begin + end) / 2 * leg.z();
    const std::optional<double> speed = ground_speed(leg, airspeed, wind.at(z));
    time += speed ? (end - begin) * leg.head<2>().norm() / *speed : kInfinity;
    begin = end;
  }
  return time;
}
}  // namespace altiplan
