// SPDX-License-Identifier: Apache-2.0
#include "support/walks.hpp"

#include <map>

#include "support/support.hpp"

namespace altiplan::testing {

Walk random_walk(RandomStream random, std::size_t points, bool sound,
                 const std::function<void(Limits&)>& set) {
  const bool level = random.uniform() < 0.5;
  const auto anywhere = [&] {
    Vec3 p = random.in({{0, 0, 0}, {100, 100, 100}});
    p.z() = level ? 50 : p.z();
    return p;
  };
  std::vector<Shape> shapes;
  for (int i = 0; i < 10; ++i) {
    shapes.push_back(Sphere{anywhere(), 8});
  }
  Walk walk;
  walk.request = request_in(world_of(std::move(shapes)), {0, 0, 0}, {0, 0, 0},
                            {{-100, -100, -100}, {200, 200, 200}});
  set(walk.request.limits);
  for (int tries = 0; tries < 400 && walk.route.size() < points; ++tries) {
    const Vec3 p = anywhere();
    const auto before =
        walk.route.size() > 1 ? std::optional(walk.route[walk.route.size() - 2]) : std::nullopt;
    if (!sound || (walk.route.empty() ? point_problem(p, walk.request).empty()
                                      : leg_ok(before, walk.route.back(), p, walk.request))) {
      walk.route.push_back(p);
    }
  }
  if (!walk.route.empty()) {
    walk.request.start.position = walk.route.front();
    walk.request.goal.position = walk.route.back();
  }
  return walk;
}

Request open_request(const Route& route) {
  return request_in(World(), route.front(), route.back(), {{-1e5, -1e5, -1e5}, {1e5, 1e5, 1e5}});
}

std::string grown_excess(const Route& before, const Route& after, const Request& request) {
  const auto worst_of = [&](const Route& route) {
    std::map<std::string, double> worst;
    for (const Violation& found : check(route, request).violations) {
      double& most = worst[found.constraint + (found.value < found.limit ? " below " : " above ") +
                           std::to_string(found.limit)];
      most = std::max(most, std::abs(found.value - found.limit));
    }
    return worst;
  };
  const auto was = worst_of(before);
  for (const auto& [rule, excess] : worst_of(after)) {
    const auto old = was.find(rule);
    if (old == was.end() || excess > old->second + 1e-6) {
      return rule + ": " + std::to_string(old == was.end() ? 0 : old->second) + " became " +
             std::to_string(excess);
    }
  }
  return "";
}
}  // namespace altiplan::testing
