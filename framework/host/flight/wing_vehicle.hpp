// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/flight/flown_vehicle.hpp"
#include "host/flight/wing_guidance.hpp"

namespace altiplan::host {

/// An aeroplane, flown by WingGuidance along the route and in the direction of a pilot's steps.
class WingVehicle final : public FlownVehicle {
 public:
  State take_off(const Request& request, const RouteAhead& route, const State& first) override;
  FlownTo follow(RouteAhead& route, const State& from, double duration,
                 const Report& report) override;
  FlownTo go(RouteAhead& route, const State& from, const State& command,
             const Report& report) override;

 private:
  /// What the guidance flies toward: a point, and the horizontal distance to it along the route.
  struct Reference {
    Vec3 point{0, 0, 0};
    double ahead = 0;
  };
  using ReferenceFor = std::function<Reference(const State&)>;

  /// Reports points where the track bends, and where the wind changes.
  FlownTo fly(RouteAhead& route, const State& from, double duration, bool on_route,
              const ReferenceFor& reference_for, const Report& report);
  Reference reference_on(RouteAhead& route, const State& now) const;
  /// Where the last leg goes on in its direction, or along the goal's loiter circle.
  Vec3 beyond_the_end(const FlightPath& path, double distance) const;

  const Request* request_ = nullptr;
  std::optional<WingGuidance> wing_;
};
}  // namespace altiplan::host
