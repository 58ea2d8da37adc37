// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/energy.hpp"

/// \file The power (W) of steady flight. Masses in kg, speeds in m/s, through the air.
namespace altiplan::host {

inline constexpr double kSeaLevelDensity = 1.225;  ///< kg/m³

/// Of the standard atmosphere, so many metres above sea level.
double air_density(double height_m);

/// A multirotor's power by Liu, Sengupta and Kurek 2017 (ICUAS, "A power consumption model for
/// multi-rotor small unmanned aircraft systems"); the coefficients are their IRIS+'s, of about
/// 1.5 kg, and hold below 15 m/s. What a climb takes is added to level flight.
struct LiuPower : Power {
  double mass_kg = 1.5;
  double k1 = 0.8554;
  double k2 = 0.3051;  ///< (kg/m)^0.5
  double c1 = 2.8037;  ///< (m/kg)^0.5; k1 / k2
  double c2 = 0.3177;  ///< (m/kg)^0.5
  double c4 = 0.0296;  ///< kg/m
  double c5 = 0.0279;  ///< kg/m
  double tilt_deg = 10;

  double vertical(double up_mps) const;
  double level(double mps) const;
  double watts(const SteadyFlight& flight) const override;
};

/// A multirotor's power by momentum theory (Glauert): induced by all discs together, by drag, by
/// the climb, and of the profile.
struct MomentumPower : Power {
  double mass_kg = 0;
  double disc_m2 = 0;     ///< of all rotors
  double drag_m2 = 0;     ///< coefficient times area
  double induced = 1;     ///< kappa: how much more than ideal, 1.1 to 1.2
  double efficiency = 1;  ///< of motor, controller and propeller, 0.5 to 0.7
  double profile_w = 0;

  /// In a descent that is nearly as fast as the wake, where the theory fails, at least that of
  /// hover.
  double at(double mps, double up_mps = 0, double density = kSeaLevelDensity) const;
  double watts(const SteadyFlight& flight) const override;
};

/// An aeroplane's, of a parabolic drag polar: CD = CD0 + k (CL - CLm)².
struct PolarPower : Power {
  double mass_kg = 0;
  double wing_m2 = 0;
  double cd0 = 0;
  double k = 0;
  double cl_of_min_drag = 0;
  double efficiency = 1;  ///< of propeller and motor
  double cl_max = kInfinity;

  /// Climbing at an angle, in a turn of that bank (radians): none in a glide that would give power
  /// back, infinite where the wing stalls.
  double at(double mps, double climb = 0, double bank = 0, double density = kSeaLevelDensity) const;
  double watts(const SteadyFlight& flight) const override;
};

/// The same in all flight.
struct MeanPower final : Power {
  double mean_w = 0;
  double watts(const SteadyFlight&) const override { return mean_w; }
};

/// Measured power, linear between airspeeds; infinite beyond the highest and below the lowest. A
/// climb takes the vehicle's weight times its rate over the efficiency more, a descent no less.
struct MeasuredPower final : Power {
  struct At {
    double mps = 0;
    double watts = 0;
  };
  std::vector<At> level;  ///< not empty, by ascending airspeed
  double mass_kg = 0;
  double efficiency = 1;

  double watts(const SteadyFlight& flight) const override;
};
}  // namespace altiplan::host
