// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "altiplan/energy.hpp"
#include "altiplan/error.hpp"
#include "altiplan/params.hpp"
#include "altiplan/vehicle.hpp"

namespace altiplan::kit {

/// The power of a vehicle, which a plugin may be told in place of the scenario's.
struct StatedPower {
  std::optional<double> power_w;

  void describe(Fields& f) {
    f("power_w", power_w)
        .unit("W")
        .greater_than(0)
        .doc("power in all flight; default: by the vehicle's energy");
  }

  /// Throws Error if neither says it.
  std::shared_ptr<const Power> of(const Vehicle& vehicle) const {
    struct Constant final : Power {
      explicit Constant(double w) : power_w(w) {}
      double watts(const SteadyFlight&) const override { return power_w; }
      double power_w;
    };
    if (power_w) {
      return std::make_shared<Constant>(*power_w);
    }
    if (vehicle.energy == nullptr) {
      throw Error("the power is not known: expected vehicle.energy in the scenario, or power_w");
    }
    return vehicle.energy->power;
  }
};
}  // namespace altiplan::kit
