// SPDX-License-Identifier: Apache-2.0
#include "host/gate/flight_time.hpp"

#include <cmath>

#include "altiplan/geometry.hpp"

namespace altiplan::host {

using formats::MissionItem;

std::vector<double> item_times(const formats::MissionFile& plan, double speed_mps) {
  constexpr double kVertical = 1;  // m/s
  constexpr double kMetresPerDegree = 111195;
  const double home = plan.home ? plan.home->altitude_m : 0;
  const auto height = [&](const MissionItem& item) {
    return item.kind == MissionItem::Kind::land           ? 0
           : item.at.frame == formats::AltitudeFrame::sea ? item.at.altitude_m - home
                                                          : item.at.altitude_m;
  };
  std::vector<double> times;
  double seconds = 0;
  if (!plan.items.empty() && plan.items.front().kind == MissionItem::Kind::takeoff) {
    seconds += std::abs(height(plan.items.front())) / kVertical;
  }
  for (std::size_t n = 0; n < plan.items.size(); ++n) {
    const MissionItem& item = plan.items[n];
    const MissionItem& before = plan.items[n == 0 ? 0 : n - 1];
    const double own = item.speed_mps > 0 ? item.speed_mps : plan.speed_mps;
    const double speed = own > 0 ? own : speed_mps;
    const double north = (item.at.lat - before.at.lat) * kMetresPerDegree;
    const double east = std::remainder(item.at.lon - before.at.lon, 360) * kMetresPerDegree *
                        std::cos(radians((item.at.lat + before.at.lat) / 2));
    seconds += std::hypot(north, east) / speed +
               std::abs(height(item) - height(before)) / kVertical + item.hold_s;
    seconds += 2 * kPi * item.loiter_m * (item.turns + 1) / speed;
    times.push_back(seconds);
  }
  return times;
}

double flight_time(const formats::MissionFile& plan, double speed_mps) {
  const std::vector<double> times = item_times(plan, speed_mps);
  return times.empty() ? 0 : times.back();
}
}  // namespace altiplan::host
