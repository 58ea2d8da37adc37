// SPDX-License-Identifier: Apache-2.0
#include "host/gate/return_height.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan::host {
namespace {

/// The parameter of an autopilot's return height: its name and unit, and up to ArduPilot 4.6.
struct ReturnHeight {
  const char* name;
  const char* old_name;
  double old_units;  ///< in a metre
};

ReturnHeight return_height_of(formats::Autopilot autopilot) {
  if (autopilot.is_px4()) {
    return {"RTL_RETURN_ALT", "", 1};
  }
  return autopilot.is_copter() ? ReturnHeight{"RTL_ALT_M", "RTL_ALT", 100}
                               : ReturnHeight{"RTL_ALTITUDE", "ALT_HOLD_RTL", 100};
}
}  // namespace

std::optional<ReturnCure> min_return_height(
    formats::Autopilot autopilot, const ParameterFile& given,
    const std::function<bool(const ParameterFile&)>& passes) {
  constexpr int kStep = 20;  // metres
  constexpr int kMost = 600;
  const ReturnHeight height = return_height_of(autopilot);
  const auto passes_at = [&](int metres) {
    ParameterFile parameters = given;
    parameters.erase(height.old_name);
    parameters[height.name] = metres;
    return passes(parameters);
  };
  const int present = int(std::floor(std::max(0.0, Parameters(autopilot, given)(height.name))));
  int above = present + kStep;
  while (!passes_at(above)) {
    above += kStep;
    if (above > present + kMost) {
      return std::nullopt;
    }
  }
  int below = above - kStep;  // does not pass
  while (above - below > 1) {
    const int middle = (below + above) / 2;
    (passes_at(middle) ? above : below) = middle;
  }
  const bool is_old = given.contains(height.old_name) && !given.contains(height.name);
  return is_old ? ReturnCure{height.old_name, above * height.old_units}
                : ReturnCure{height.name, double(above)};
}
}  // namespace altiplan::host
