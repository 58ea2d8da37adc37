// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "altiplan/attributed.hpp"
#include "altiplan/request.hpp"

namespace altiplan {

/// Result of a constraint's function; exceptions are attributed to the constraint.
template <class Ask>
auto answer_of(const NamedConstraint& named, const Ask& ask) {
  return attributed([&] { return "the constraint '" + named.name + "'"; },
                    [&] { return ask(*named.constraint); });
}

/// The violations of a route, under the constraint's name. Throws PluginError where one is of no
/// waypoint.
inline std::vector<Violation> violations_of(const NamedConstraint& named, const Polyline& route,
                                            const Request& request) {
  std::vector<Violation> all =
      answer_of(named, [&](const Constraint& asked) { return asked.violations(route, request); });
  for (Violation& violation : all) {
    if (violation.at >= route.size()) {
      throw PluginError("the constraint '" + named.name +
                        "' violated the contract of its interface: it names waypoint " +
                        std::to_string(violation.at) + " of " + std::to_string(route.size()));
    }
    violation.constraint = named.name;
  }
  return all;
}

}  // namespace altiplan
