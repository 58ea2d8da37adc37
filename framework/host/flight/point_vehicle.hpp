// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/flight/flown_vehicle.hpp"

namespace altiplan::host {

/// Flies exactly along the route, at its speed profile.
class PointVehicle final : public FlownVehicle {
 public:
  State take_off(const Request& request, const RouteAhead& /*route*/, const State& first) override {
    request_ = &request;
    return first;
  }
  FlownTo follow(RouteAhead& route, const State& from, double duration,
                 const Report& report) override;
  FlownTo go(RouteAhead& /*route*/, const State& /*from*/, const State& command,
             const Report& report) override {
    report(command);
    return FlownTo::on_the_way;
  }

 private:
  const Request* request_ = nullptr;
};
}  // namespace altiplan::host
