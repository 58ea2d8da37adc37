// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include <string>

#include "measuring.hpp"

namespace altiplan::bench {

/// Random pairs of poses in a square.
struct PosePairs {
  std::string name;
  double edge;  ///< of the square, turn radii
};

// Each adds its rows; a row's items are pairs.
void add_length_rows(const PosePairs& pairs);
void add_path_rows(const PosePairs& pairs);
/// RRT* beside OMPL's.
void add_dubins_star_rows(host::Registry& registry);
}  // namespace altiplan::bench
