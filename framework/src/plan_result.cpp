// SPDX-License-Identifier: Apache-2.0
#include "altiplan/plan_result.hpp"

namespace altiplan {

const char* name(Status status) {
  switch (status) {
    case Status::solved:
      return "solved";
    case Status::no_route:
      return "no_route";
    case Status::timed_out:
      return "timed_out";
    case Status::cancelled:
      return "cancelled";
    case Status::invalid_problem:
      return "invalid_problem";
    case Status::rejected:
      return "rejected";
    case Status::failed:
      return "failed";
    case Status::collided:
      return "collided";
    case Status::not_reached:
      return "not_reached";
  }
  return "failed";
}
}  // namespace altiplan
