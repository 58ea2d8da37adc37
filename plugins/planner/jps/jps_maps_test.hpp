// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "reference/level_maps.hpp"

namespace altiplan::testing {

inline std::unique_ptr<Planner> jps(bool free_box) {
  return make_planner("jps", free_box ? "{corner: free_box}" : "{corner: any}");
}
}  // namespace altiplan::testing
