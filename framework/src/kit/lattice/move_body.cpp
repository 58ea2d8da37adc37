// SPDX-License-Identifier: Apache-2.0
// The vehicle's body in MoveRules.
#include "altiplan/check.hpp"
#include "altiplan/kit/lattice/move_rules.hpp"

namespace altiplan::kit {

/// leg_free for a vehicle with a body.
bool MoveRules::body_free(const std::optional<Approach>& before, const Cell& c, int d,
                          const Vec3& a, const Vec3& b, KnownClearance& near_a,
                          KnownClearance& near_b) {
  if (is_wide(d, a, b, near_a, near_b)) {
    ++moves_checked_;
    return (!has_ground_rules_ || keeps_ground(c, d, a, b)) && constraints_admit(before, a, b);
  }
  if (!place_free(c, d, a, b, near_a, near_b) || !constraints_admit(before, a, b)) {
    return false;
  }
  // The approach determines how the body turns, and its heading on vertical legs.
  const bool turns_freely =
      near_a.least > reach_ && bare_ground_.layers().empty() && has_heading(b - a);
  const bool fits =
      body_meets(turns_freely ? std::nullopt : before, Leg::straight(a, b), request_) == nullptr;
  if (!fits) {
    refuse_body(before, a, b);
  }
  return fits;
}

/// True if the step is so far from all obstacles that the body's attitude does not matter.
bool MoveRules::is_wide(int d, const Vec3& a, const Vec3& b, KnownClearance& near_a,
                        KnownClearance& near_b) const {
  if (!wants_clearance_ || !bare_ground_.layers().empty()) {
    return false;
  }
  const double length = lattice_.step_length(d);
  if (near_a.least > reach_ + length) {
    return true;
  }
  // Two balls of half the step around its ends contain all of it.
  const double enough = reach_ + length / 2;
  if (near_a.least <= enough) {
    ask(near_a, a);
  }
  near_b.learn(near_a.least - length);
  if (near_a.least > enough && near_b.least <= enough) {
    ask(near_b, b);
  }
  return std::min(near_a.least, near_b.least) > enough ||
         obstacles_.blocked_by(a, b, reach_) == nullptr;
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
