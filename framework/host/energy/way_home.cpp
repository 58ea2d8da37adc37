// SPDX-License-Identifier: Apache-2.0
#include "host/energy/way_home.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "altiplan/energy.hpp"
#include "altiplan/flown_route.hpp"

namespace altiplan::host {

double time_home(const Eigen::Vector2d& way, double down_m, const Eigen::Vector2d& wind,
                 double airspeed_mps, double vertical_mps) {
  const double vertical_s = std::abs(down_m) / vertical_mps;
  if (way.norm() == 0) {
    return vertical_s;
  }
  const Eigen::Vector2d ahead = way.normalized();
  const double along = std::min(0.0, wind.dot(ahead));
  const double across = wind.x() * ahead.y() - wind.y() * ahead.x();
  const double through = airspeed_mps * airspeed_mps - across * across;
  const double speed = through > 0 ? std::sqrt(through) + along : 0;
  return speed > 0 ? way.norm() / speed + vertical_s : kInfinity;
}

namespace {

/// Wh of the straight way home: at the airspeed, and up or down at the vehicle's rates.
double energy_home(const Vec3& from, const Vec3& home, const Request& request) {
  constexpr double kSecondsPerHour = 3600;
  const Vehicle& vehicle = request.vehicle;
  const Power& power = *vehicle.energy->power;
  const double rise = home.z() - from.z();
  const double rate = rise > 0 ? vehicle.climb_mps : vehicle.sink_mps;
  const Eigen::Vector2d way = (home - from).head<2>();
  const Vec3 level_home(home.x(), home.y(), from.z());
  // In wind that varies along the way or with the hour, the strongest of it ahead.
  const bool is_one =
      request.wind.changes.empty() && request.wind.crossings(from, level_home).empty();
  const Eigen::Vector2d wind = is_one
                                   ? Eigen::Vector2d(request.wind.at(from).head<2>())
                                   : Eigen::Vector2d(-request.wind.max_speed() * way.normalized());
  const double level_s = time_home(way, 0, wind, request.air_speed(), kInfinity);
  const double vertical_s = std::abs(rise) / rate;
  const double hover = vehicle.wing ? request.air_speed() : 0;
  const double vertical_w =
      vertical_s > 0 ? power.watts({hover, std::copysign(rate, rise), 0, from.z()}) : 0;
  const double level_w = level_s > 0 ? power.watts({request.air_speed(), 0, 0, from.z()}) : 0;
  return (level_s * level_w + vertical_s * vertical_w) / kSecondsPerHour;
}

/// Where a route is at each second of its flight.
std::vector<std::pair<double, Vec3>> by_the_second(const Route& route, const Request& request) {
  std::vector<std::pair<double, Vec3>> places{{0, route.front()}};
  double begin_s = 0;
  fly(route, request, [&](const FlownPhase& phase) {
    const double steps = std::isfinite(phase.seconds) ? std::ceil(phase.seconds) : 1;
    for (double n = 1; n <= steps; ++n) {
      const double share = n / steps;  // of its time
      const double mps = phase.from_mps + share * (phase.to_mps - phase.from_mps);
      const double sum = phase.from_mps + phase.to_mps;
      const double along = sum > 0 ? share * (phase.from_mps + mps) / sum : 0;
      places.emplace_back(begin_s + share * phase.seconds,
                          phase.from + along * (phase.to - phase.from));
    }
    begin_s += phase.seconds;
  });
  return places;
}
}  // namespace

std::optional<NoReturn> point_of_no_return(const Route& route, const Request& request,
                                           const std::function<double(const Vec3&)>& home_wh) {
  const Energy* energy = request.vehicle.energy.get();
  if (energy == nullptr || !std::isfinite(energy->capacity_wh) || route.empty()) {
    return std::nullopt;
  }
  const auto places = by_the_second(route, request);
  // The track knows nothing of banks, nor of speeds within a second.
  const double whole = track_energy(places, request, *energy->power);
  const double scale =
      whole > 0 ? std::max(1.0, flown_energy(route, request, *energy->power) / whole) : 1;
  std::optional<NoReturn> last;
  double taken_wh = 0;
  for (std::size_t n = 0; n < places.size(); ++n) {
    if (n > 0) {
      taken_wh += scale * track_energy({places[n - 1], places[n]}, request, *energy->power);
    }
    if (!(taken_wh + home_wh(places[n].second) <= energy->available_wh())) {
      break;
    }
    last = {places[n].first, places[n].second};
  }
  return last;
}

std::optional<double> point_of_no_return(const Route& route, const Request& request) {
  const auto last = point_of_no_return(
      route, request, [&](const Vec3& p) { return energy_home(p, route.front(), request); });
  return last ? std::optional(last->time_s) : std::nullopt;
}
}  // namespace altiplan::host
