// SPDX-License-Identifier: Apache-2.0
#include "altiplan/local_planner.hpp"

#include <cmath>
#include <string>

#include "altiplan/error.hpp"

namespace altiplan {

Pilot::~Pilot() = default;
LocalPlanner::~LocalPlanner() = default;

std::unique_ptr<Pilot> LocalPlanner::begin(const Request& request) const {
  std::unique_ptr<Pilot> pilot = do_begin(request);
  if (pilot == nullptr) {
    throw PluginError(
        "the local planner violated the contract of its interface: begin returned no pilot",
        Reason::contract);
  }
  return pilot;
}

Traits LocalPlanner::do_traits() const { return {}; }

double Pilot::reach_m() const {
  const double reach = do_reach_m();
  if (!(reach >= 0 && std::isfinite(reach))) {
    throw PluginError("the pilot violated the contract of its interface: its reach is " +
                          std::to_string(reach) + " m",
                      Reason::contract);
  }
  return reach;
}

PilotStep Pilot::step(const Observation& seen) {
  PilotStep step = do_step(seen);
  if (step.outcome != PilotStep::Outcome::stuck) {
    const double dt = step.next.time_s - seen.state.time_s;
    if (!is_finite(step.next.position) || !(dt > 0) || dt > seen.max_dt_s * (1 + 1e-9)) {
      throw PluginError(
          "the pilot violated the contract of its interface: a step must end at a finite place "
          "after more than 0 and at most max_dt seconds",
          Reason::contract);
    }
  }
  return step;
}

Counters Pilot::do_counters() const { return {}; }
}  // namespace altiplan
