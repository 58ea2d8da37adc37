// SPDX-License-Identifier: Apache-2.0
#include "host/energy/flight_power.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan::host {
namespace {

constexpr double kEarthGravity = 9.80665;
}  // namespace

double air_density(double height_m) {
  const double kelvin = 288.15 - 0.0065 * height_m;
  const double pascal = 101'325 * std::pow(kelvin / 288.15, 5.25588);
  return pascal / (287.053 * kelvin);
}

double LiuPower::vertical(double up_mps) const {
  const double g = mass_kg * kEarthGravity;
  const double half = up_mps / 2;
  return k1 * g * (half + std::sqrt(half * half + g / (k2 * k2))) + c2 * std::pow(g, 1.5);
}

double LiuPower::level(double mps) const {
  const double lift = mps * std::cos(radians(tilt_deg));
  const double down = mass_kg * kEarthGravity - c5 * lift * lift;
  const double back = c4 * mps * mps;
  return (c1 + c2) * std::pow(down * down + back * back, 0.75) + c4 * mps * mps * mps;
}

double LiuPower::watts(const SteadyFlight& flight) const {
  const double climb = vertical(flight.climb_mps);
  return flight.airspeed_mps == 0 ? climb : level(flight.airspeed_mps) + climb - vertical(0);
}

double MomentumPower::at(double mps, double up_mps, double density) const {
  const double weight = mass_kg * kEarthGravity;
  const double drag = density * drag_m2 * mps * mps / 2;
  const double thrust = std::hypot(weight, drag);
  const double tilt = std::atan2(drag, weight);
  const double hover = std::sqrt(weight / (2 * density * disc_m2));
  if (up_mps < 0 && up_mps > -2 * hover) {
    return std::max(at(0, 0, density), at(mps, 0, density));
  }
  // The induced velocity is where inflow times speed through the disc give the thrust; the product
  // rises with it.
  const double through = mps * std::sin(tilt) + up_mps;
  const double product = thrust / (2 * density * disc_m2);
  double low = 0;
  double high = std::sqrt(product) + std::abs(through) + 1;
  for (int n = 0; n < 200 && high - low > 0; ++n) {
    const double middle = (low + high) / 2;
    if (middle == low || middle == high) {
      break;
    }
    const bool is_less = middle * std::hypot(mps * std::cos(tilt), through + middle) < product;
    (is_less ? low : high) = middle;
  }
  const double shaft = induced * thrust * high + drag * mps + weight * up_mps + profile_w;
  return std::max(0.0, shaft) / efficiency;
}

double MomentumPower::watts(const SteadyFlight& flight) const {
  return at(flight.airspeed_mps, flight.climb_mps, air_density(flight.height_m));
}

double PolarPower::at(double mps, double climb, double bank, double density) const {
  const double weight = mass_kg * kEarthGravity;
  const double pressure_area = density * mps * mps / 2 * wing_m2;
  const double cl = weight * std::cos(climb) / (pressure_area * std::cos(bank));
  if (!(cl <= cl_max)) {
    return kInfinity;
  }
  const double off = cl - cl_of_min_drag;
  const double drag = pressure_area * (cd0 + k * off * off);
  return std::max(0.0, drag * mps + weight * mps * std::sin(climb)) / efficiency;
}

double PolarPower::watts(const SteadyFlight& flight) const {
  return at(std::hypot(flight.airspeed_mps, flight.climb_mps),
            std::atan2(flight.climb_mps, flight.airspeed_mps), flight.bank,
            air_density(flight.height_m));
}

double MeasuredPower::watts(const SteadyFlight& flight) const {
  constexpr double kRounding = 1e-9;
  const double mps = flight.airspeed_mps;
  if (mps < level.front().mps - kRounding || mps > level.back().mps + kRounding) {
    return kInfinity;
  }
  const double climb = mass_kg * kEarthGravity * std::max(0.0, flight.climb_mps) / efficiency;
  const auto above = std::lower_bound(level.begin(), level.end(), mps,
                                      [](const At& at, double speed) { return at.mps < speed; });
  if (above == level.begin() || above == level.end()) {
    return (above == level.end() ? level.back() : level.front()).watts + climb;
  }
  const At& below = *std::prev(above);
  const double share = (mps - below.mps) / (above->mps - below.mps);
  return below.watts + share * (above->watts - below.watts) + climb;
}
}  // namespace altiplan::host
