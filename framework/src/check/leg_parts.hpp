// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/request.hpp"

namespace altiplan {

/// Distance that a vehicle must keep from obstacles, metres.
inline double required_clearance(const Request& request) {
  return std::max(request.limits.min_clearance, request.vehicle.radius_m);
}

/// Why the figures of a turn describe none, or not the one to its end; "" if they do.
std::string turn_problem(const Leg& turn);
/// Why the vehicle cannot wait as the leg says; "" if it can.
std::string wait_problem(const Leg& wait, const Request& request);

/// The violation of a leg that `layer` blocks: of all blocking layers, by the one nearest to it.
Violation too_near(const Layer* layer, const Leg& leg, const Request& request, std::size_t at);
/// The violation of a leg on which the body meets the layer.
Violation body_violation(const Layer& layer, const Leg& leg, const Request& request,
                         std::size_t at);

/// Start of the first part of a leg that has no ground below it.
Vec3 ground_ends(const World& world, const Vec3& a, const Vec3& b);

/// How high above the ground a turn is known to lie, and the slope within its clearance.
struct AboveGround {
  double height = -kInfinity;
  double slope = kInfinity;
};

/// The layer that blocks a turn, whose box is known, for a sphere of radius r, or null. By
/// bisection: a piece is free if its chord is free for r + e, and blocked if its chord is blocked
/// for r - e. Layers that block nothing but their ground are left out if the turn is high enough.
const Layer* blocked_by(const World& world, const Leg& turn, const Box& box, double r,
                        const AboveGround& above);
}  // namespace altiplan
