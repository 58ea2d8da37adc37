// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/environment.hpp"

namespace altiplan {

struct DeepestPlace {
  double clearance;  ///< signed
  double share;      ///< of the leg
};

/// The minimum signed clearance along a leg that enters the layer, by branch and bound on the
/// 1-Lipschitz clearance, within a ten-thousandth of the leg's length.
DeepestPlace deepest_place(const Environment& solid, const Vec3& a, const Vec3& b);
}  // namespace altiplan
