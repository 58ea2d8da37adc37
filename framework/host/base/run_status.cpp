// SPDX-License-Identifier: Apache-2.0
#include "host/base/run_status.hpp"

#include <new>

#include "altiplan/error.hpp"

namespace altiplan::host {

RunStatus run_status(PlanStatus status) {
  switch (status) {
    case PlanStatus::solved:
      return RunStatus::solved;
    case PlanStatus::no_route:
      return RunStatus::no_route;
    case PlanStatus::timed_out:
      return RunStatus::timed_out;
    case PlanStatus::cancelled:
      return RunStatus::cancelled;
    case PlanStatus::invalid_problem:
      return RunStatus::invalid_problem;
  }
  return RunStatus::failed;
}

Reason reason_of(const std::exception& error) {
  if (const auto* of_plugin = dynamic_cast<const PluginError*>(&error)) {
    return of_plugin->reason();
  }
  return dynamic_cast<const std::bad_alloc*>(&error) != nullptr ? Reason::out_of_memory
                                                                : Reason::threw;
}

const char* name(RunStatus status) {
  switch (status) {
    case RunStatus::solved:
      return name(PlanStatus::solved);
    case RunStatus::no_route:
      return name(PlanStatus::no_route);
    case RunStatus::timed_out:
      return name(PlanStatus::timed_out);
    case RunStatus::cancelled:
      return name(PlanStatus::cancelled);
    case RunStatus::invalid_problem:
      return name(PlanStatus::invalid_problem);
    case RunStatus::rejected:
      return "rejected";
    case RunStatus::failed:
      return "failed";
    case RunStatus::collided:
      return "collided";
    case RunStatus::not_reached:
      return "not_reached";
  }
  return "failed";
}
}  // namespace altiplan::host
