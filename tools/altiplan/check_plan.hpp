// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/config/config.hpp"

namespace altiplan::cli {

/// What `check` takes in place of a scenario.
struct PlanCheck {
  std::string plan;
  std::optional<std::string> terrain;
  std::vector<std::string> airspace;
  double radius_m = 0;
  std::optional<double> min_above_ground_m;
  std::optional<double> max_above_ground_m;
  std::optional<std::string> start_time;
};

/// Judges a ground station's mission in a world of an elevation model and zones; prints each
/// violation with its items and, where one item's height cures it, by how much. Returns the exit
/// code.
int check_plan(const PlanCheck& plan, const host::Overrides& overrides, bool as_json);
}  // namespace altiplan::cli
