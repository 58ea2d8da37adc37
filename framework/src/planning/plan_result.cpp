// SPDX-License-Identifier: Apache-2.0
#include "altiplan/plan_result.hpp"

namespace altiplan {

const char* name(PlanStatus status) {
  switch (status) {
    case PlanStatus::solved:
      return "solved";
    case PlanStatus::no_route:
      return "no_route";
    case PlanStatus::timed_out:
      return "timed_out";
    case PlanStatus::cancelled:
      return "cancelled";
    case PlanStatus::invalid_problem:
      return "invalid_problem";
  }
  return "no_route";
}

const char* name(Reason reason) {
  switch (reason) {
    case Reason::none:
      return "";
    case Reason::start:
      return "start";
    case Reason::goal:
      return "goal";
    case Reason::deadline:
      return "deadline";
    case Reason::iterations:
      return "iterations";
    case Reason::memory:
      return "memory";
    case Reason::threw:
      return "threw";
    case Reason::out_of_memory:
      return "out_of_memory";
    case Reason::contract_of_ends:
      return "contract_of_ends";
    case Reason::contract_of_results:
      return "contract_of_results";
    case Reason::contract:
      return "contract";
    case Reason::process_changed:
      return "process_changed";
    case Reason::never_stopped:
      return "never_stopped";
    case Reason::process_ended:
      return "process_ended";
    case Reason::constraint:
      return "constraint";
    case Reason::stuck:
      return "stuck";
    case Reason::route_ended:
      return "route_ended";
  }
  return "";
}
}  // namespace altiplan
