// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// A disc that a 2-D planner avoids.
struct Threat {
  Vec3 centre{0, 0, 0};
  double radius = 0;
  std::string kind;  ///< "radar", "zone", …
  std::string id;
};
}  // namespace altiplan
