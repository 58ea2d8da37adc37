// SPDX-License-Identifier: Apache-2.0
// The vehicle's body in MoveRules.
#include "altiplan/check.hpp"
#include "altiplan/kit/lattice/move_rules.hpp"

namespace altiplan::kit {

/// True if the step is so far from all obstacles that the body's attitude does not matter.
bool MoveRules::is_clear_of_body(int d, const Vec3& a, const Vec3& b, KnownClearance& near_a,
                                 KnownClearance& near_b) const {
  if (request_.vehicle.body == nullptr) {
    return true;
  }
  if (!wants_clearance_ || !bare_ground_.layers().empty()) {
    return false;
  }
  if (near_a.least > reach_ + lattice_.step_length(d)) {
    return true;
  }
  // Two balls of half the step around its ends contain all of it.
  const double enough = reach_ + lattice_.step_length(d) / 2;
  if (near_a.least <= enough) {
    ask(near_a, a);
  }
  if (near_a.least > enough && near_b.least <= enough) {
    near_b.learn(near_a.least - lattice_.step_length(d));
    if (near_b.least <= enough) {
      ask(near_b, b);
    }
  }
  return near_a.least > enough && near_b.least > enough;
}

bool MoveRules::body_fits(const std::optional<Approach>& before, const Vec3& a, const Vec3& b) {
  if (!body_ok(before, Leg::straight(a, b), request_)) {
    ++refused_[by_body];
    admit_needed_parent_ =
        admit_needed_parent_ || (before && body_ok(std::nullopt, Leg::straight(a, b), request_));
    return false;
  }
  return true;
}
}  // namespace altiplan::kit
