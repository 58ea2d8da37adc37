// SPDX-License-Identifier: Apache-2.0
#include "host/gate/return_cure.hpp"

#include <cmath>

#include "host/gate/returns.hpp"

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

std::optional<ReturnCure> cure_of_returns(const std::string& file, const formats::MissionFile& plan,
                                          const Mission& world, const GateOptions& options) {
  constexpr int kStep = 20;  // metres
  constexpr int kMost = 600;
  const auto autopilots =
      possible_autopilots(plan, options.firmware, options.airframe, options.flight.parameters);
  if (plan.commands.empty() || autopilots.size() != 1) {
    return std::nullopt;
  }
  const ReturnHeight height = return_height_of(autopilots.front());
  GateOptions with = options;
  const auto passes = [&](int metres) {
    with.flight.parameters.erase(height.old_name);
    with.flight.parameters[height.name] = metres;
    return judge_returns(plan, world, with).verdict == Verdict::pass &&
           judge_plan(file, plan, world, with).passed();
  };
  const int present = int(std::floor(
      std::max(0.0, Parameters(autopilots.front(), options.flight.parameters)(height.name))));
  int above = present + kStep;
  while (!passes(above)) {
    above += kStep;
    if (above > present + kMost) {
      return std::nullopt;
    }
  }
  int below = above - kStep;  // does not pass
  while (above - below > 1) {
    const int middle = (below + above) / 2;
    (passes(middle) ? above : below) = middle;
  }
  const bool is_old = options.flight.parameters.contains(height.old_name) &&
                      !options.flight.parameters.contains(height.name);
  return is_old ? ReturnCure{height.old_name, above * height.old_units}
                : ReturnCure{height.name, double(above)};
}
}  // namespace altiplan::host
