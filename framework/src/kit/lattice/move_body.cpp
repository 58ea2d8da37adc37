// SPDX-License-Identifier: Apache-2.0
// The vehicle's body in MoveRules.
#include "altiplan/check.hpp"
#include "altiplan/kit/lattice/move_rules.hpp"

namespace altiplan::kit {

/// One step of legs_free for a vehicle with a body.
bool MoveRules::body_free(const std::optional<Approach>& before, const Cell& c, int d,
                          const Vec3& a, const Vec3& b) {
  const DirectionMask step = DirectionMask{1} << d;
  if (wide_steps_ && wide_steps_->permitted(c, step) != 0) {
    ++moves_checked_;
    return (!ground_steps_ || ground_steps_->permitted(c, step) != 0) &&
           constraints_admit(before, a, b);
  }
  if (!place_free(c, d) || !constraints_admit(before, a, b)) {
    return false;
  }
  // The approach determines how the body turns, and its heading on vertical legs.
  const bool turns_freely = wide_steps_ && wide_steps_->clearance(c) > reach_ && has_heading(b - a);
  const bool fits =
      body_meets(turns_freely ? std::nullopt : before, Leg::straight(a, b), request_) == nullptr;
  if (!fits) {
    refuse_body(before, a, b);
  }
  return fits;
}

bool MoveRules::body_fits(const std::optional<Approach>& before, const Vec3& a, const Vec3& b) {
  const bool fits = body_ok(before, Leg::straight(a, b), request_);
  if (!fits) {
    refuse_body(before, a, b);
  }
  return fits;
}

void MoveRules::refuse_body(const std::optional<Approach>& before, const Vec3& a, const Vec3& b) {
  ++refused_[by_body];
  admit_needed_parent_ =
      admit_needed_parent_ || (before && body_ok(std::nullopt, Leg::straight(a, b), request_));
}
}  // namespace altiplan::kit
