// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "altiplan/request.hpp"
#include "host/plugins/registry.hpp"

namespace altiplan::bench {

struct TerrainKind {
  std::string file;  ///< elevation model; empty: generated ridges
  std::uint64_t seed = 1;
  double ceiling = 0.85;  ///< share of the ground that may be flown over at the ceiling
  int cells = 300;        ///< along the longer side
  int fine_cells = 3000;
};

/// A search over ground, from a valley to one near the opposite corner.
struct TerrainProblem {
  std::string name;
  Request request;
  std::string planner;      ///< with its parameters in YAML
  bool is_shut_in = false;  ///< no route: a ring around the goal that no step crosses
  std::string without;  ///< the problem with fewer limits, whose route is no longer; empty: none
};

std::vector<TerrainProblem> terrain_problems(host::Registry& registry, const TerrainKind& kind);
}  // namespace altiplan::bench
