// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "support/support.hpp"

namespace altiplan::testing {

/// A drawn city of paper 003, 80 x 80 x 100 cells of 10 m, with the paper's start and goal: in the
/// simple one from a corner to the top of the one across, in the complex one low between buildings.
inline Request in_city(bool complex, std::uint64_t seed) {
  const Vec3 start = complex ? Vec3(15, 25, 45) : Vec3(15, 15, 15);
  const Vec3 goal = complex ? Vec3(675, 645, 45) : Vec3(675, 645, 995);
  Site site;
  World before;
  site.before = &before;
  site.start = start;
  site.goal = goal;
  const std::string yaml = std::string("{generate: ") + (complex ? "complex" : "simple") +
                           ", seed: " + std::to_string(seed) + "}";
  return request_in(world_of(make_environment("city", yaml, site)), start, goal,
                    {{0, 0, 0}, {800, 800, 1000}});
}

/// The limits that paper 003 sets on angles.
inline Request with_paper_limits(Request request) {
  request.limits.max_turn_horizontal = kPi / 3;
  request.limits.max_climb = kPi / 3;
  return request;
}
}  // namespace altiplan::testing
