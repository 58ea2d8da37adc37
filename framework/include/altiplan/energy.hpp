// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// Steady flight through the air.
struct SteadyFlight {
  double airspeed_mps = 0;  ///< horizontal component
  double climb_mps = 0;     ///< negative: it sinks
  double bank = 0;          ///< radians
  double height_m = 0;      ///< above sea level
};

/// The power that a vehicle takes. Pure and const: callable from any number of threads.
class ALTIPLAN_API Power {
 public:
  virtual ~Power();
  /// Watts, at least 0; infinite where nothing is known of such a flight.
  virtual double watts(const SteadyFlight& flight) const = 0;
};

/// What a vehicle has to fly on.
struct ALTIPLAN_API Energy {
  std::shared_ptr<const Power> power;  ///< never null
  double capacity_wh = kInfinity;      ///< of the battery; infinite: not known
  double usable = 1;                   ///< share of it that can be drawn: age, cold
  double reserve = 0;                  ///< share of that which is kept for the end

  /// What a route may take.
  double available_wh() const { return capacity_wh * usable * (1 - reserve); }
};
}  // namespace altiplan
