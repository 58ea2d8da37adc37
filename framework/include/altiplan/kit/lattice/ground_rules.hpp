// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/request.hpp"

namespace altiplan::kit {

/// What the ground, and limits on the height above it, ask of a leg; a leg that keeps them below
/// every ceiling keeps all but ceilings when it is moved up.
class ALTIPLAN_API GroundRules {
 public:
  /// `needed` is the clearance in metres; `asks_world`: the leg has to be kept off the ground by
  /// it. The request must outlive this object.
  GroundRules(const Request& request, double needed, bool asks_world);

  enum class Refusal { none, no_ground, ground_clearance, altitude, clearance };

  /// True if there is ground, or a limit counts from it.
  bool exist() const { return exist_; }
  /// The lowest limit above the ground; infinite: none.
  double ceiling() const { return ceiling_; }
  /// A gap that proves a leg free of all floors, and one below which it is not.
  double certain_gap() const { return certain_gap_; }
  double needed_gap() const { return needed_gap_; }
  /// What a leg with less than the needed gap violates.
  Refusal too_low() const { return too_low_; }

  /// The first of the limits on heights that the leg violates.
  Refusal heights(const Vec3& a, const Vec3& b) const;
  /// The same without ceilings, and with the clearance from layers that are ground alone.
  Refusal floors(const Vec3& a, const Vec3& b) const;
  bool below_ceilings(const Vec3& a, const Vec3& b) const;

  const World& world() const { return *request_.world; }
  /// The layers that are ground alone, and the others.
  const World& bare_ground() const { return bare_ground_; }
  const World& obstacles() const { return obstacles_; }

 private:
  void sort_layers();
  void find_gaps();
  Refusal floor_limits(const Vec3& a, const Vec3& b) const;

  const Request& request_;
  double needed_;
  bool asks_world_;
  bool exist_ = false;
  double ceiling_ = kInfinity;
  double certain_gap_ = 0;
  double needed_gap_ = -kInfinity;
  Refusal too_low_ = Refusal::ground_clearance;
  World bare_ground_;
  World obstacles_;
};
}  // namespace altiplan::kit
