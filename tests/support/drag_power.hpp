// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "altiplan/energy.hpp"

namespace altiplan::testing {

/// Grows with the cube of the airspeed.
struct DragPower final : Power {
  double watts(const SteadyFlight& flight) const override {
    return 100 + std::pow(flight.airspeed_mps, 3) / 10;
  }
};
}  // namespace altiplan::testing
