// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/kit/smoothing/trimming.hpp"

namespace altiplan::improved_ant_colony {

enum class LegTest { remembered, guard_zone, always };
enum class Heuristic { euclidean, geodesic };
enum class Deposit { resampled, cells, nodes };

struct Settings {
  int reach = 8;    ///< l_c
  int spacing = 2;  ///< l_s
  LegTest leg_test = LegTest::remembered;
  double tilt = 0.5;  ///< C
  int region_radius = 2;
  double region_decay = 0.5;
  Heuristic heuristic = Heuristic::euclidean;
  bool trims = true;
  kit::TrimParams trim;
  Deposit deposit = Deposit::resampled;
};
}  // namespace altiplan::improved_ant_colony
