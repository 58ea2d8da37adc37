// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/sampling/star_search.hpp"

#include <cstdio>

#include "star_growth.hpp"

namespace altiplan::kit {

LegTree::Node nearest_of_near(const StarMemory& memory, const Vec3& p) {
  double minimum = kInfinity;
  std::uint32_t best = 0;
  for (const std::uint32_t number : memory.near) {
    const double its = (memory.points.point(number) - p).squaredNorm();
    if (its < minimum || (its <= minimum && number < best)) {
      minimum = its;
      best = number;
    }
  }
  return LegTree::Node(best);
}

std::string reason(const StarMemory& memory, double away, const std::string& refusals) {
  char near[32];
  std::snprintf(near, sizeof near, "%.0f", away);
  return "the tree of " + std::to_string(memory.legs.size()) + " nodes came within " + near +
         " m of the goal" + (refusals.empty() ? "" : "; the last legs were refused by " + refusals);
}

PlanResult star_search(const Request& request, const StarSettings& settings, StarMemory& memory) {
  if (auto refused = unsolvable(request, settings.turn_radius)) {
    return *refused;
  }
  if (request.objective && settings.turn_radius > 0) {
    PlanResult refused;
    refused.status = PlanStatus::invalid_problem;
    refused.message =
        "with turns this planner minimises length alone, not an objective: plan without a wing and "
        "a turn radius, or by astar";
    return refused;
  }
  return settings.turn_radius == 0 ? StarGrowth<StraightMotion>(request, settings, memory).run()
                                   : StarGrowth<PoseMotion>(request, settings, memory).run();
}
}  // namespace altiplan::kit
