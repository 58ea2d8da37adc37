// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "altiplan/objective.hpp"
#include "altiplan/request.hpp"
#include "altiplan/total_limit.hpp"

/// \file Limits on what adds up along a path, for searches that keep them.
namespace altiplan::kit {

/// What adds up along a path and has a limit: a cost by an objective, or the length (null).
struct Resource {
  const TotalLimit* limit = nullptr;
  double maximum = kInfinity;
  std::string name;  ///< of the constraint

  double of(const Vec3& a, const Vec3& b, const Request& request) const {
    return limit == nullptr ? (b - a).norm()
           : a == b         ? 0
                            : limit->of().cost(Leg::straight(a, b), 0, request);
  }
  /// True if some route over p may keep the limit that has taken so much until there.
  bool allows(double taken, const Vec3& p, const Request& request) const {
    const Goal& goal = request.goal;
    const double to_goal =
        limit == nullptr ? std::max(0.0, (goal.position - p).norm() - goal.tolerance_m)
        : goal.tolerance_m > 0 || goal.loiter ? 0
                                              : limit->of().bound(p, goal.position, request);
    return !costs_more(taken + to_goal, maximum) &&
           (limit == nullptr ||
            !costs_more(taken + limit->left_at(p, request, maximum - taken), maximum));
  }
};

/// Those of the request that a search can keep: limits on totals that do not depend on the
/// time or on waypoints, and on the length of a route that is planned for another objective.
inline std::vector<Resource> resources_of(const Request& request) {
  std::vector<Resource> all;
  for (const NamedConstraint& named : request.constraints) {
    const auto* total = dynamic_cast<const TotalLimit*>(named.constraint.get());
    const bool adds_up = total != nullptr && !total->of().traits().time &&
                         !total->of().traits().waypoints;  // over legs
    if (adds_up) {
      all.push_back({total, total->maximum(), named.name});
    }
  }
  if (request.limits.max_route_length < kInfinity && (request.objective || !all.empty())) {
    all.push_back({nullptr, request.limits.max_route_length + kLengthTolerance, "route_length"});
  }
  return all;
}

/// The first whose limit no route keeps that begins along the path; null if there is none. Asked at
/// its end alone.
inline const Resource* used_up(const std::vector<Resource>& resources, const Polyline& path,
                               const Request& request) {
  const auto found =
      std::find_if(resources.begin(), resources.end(), [&](const Resource& resource) {
        double taken = 0;
        for (std::size_t i = 1; i < path.size(); ++i) {
          taken += resource.of(path[i - 1], path[i], request);
        }
        return !resource.allows(taken, path.back(), request);
      });
  return found == resources.end() ? nullptr : &*found;
}

/// True if the judge finds the whole route within all limits.
inline bool keeps(const std::vector<Resource>& resources, const Route& route,
                  const Request& request) {
  return std::all_of(resources.begin(), resources.end(), [&](const Resource& resource) {
    return resource.limit == nullptr ? length(route) <= resource.maximum
                                     : resource.limit->violations_of(route, request).empty();
  });
}
}  // namespace altiplan::kit
