// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/kit/population/population.hpp"

/// \file Particle swarm optimisation. J. Kennedy, R. Eberhart: Particle swarm optimization. ICNN
/// 1995, doi:10.1109/ICNN.1995.488968; with the inertia of Y. Shi, R. Eberhart: A modified particle
/// swarm optimizer. ICEC 1998, doi:10.1109/ICEC.1998.699146.
namespace altiplan::kit {

struct ALTIPLAN_API SwarmParams : PopulationParams {
  int particles = 50;
  double inertia = 0.7298;
  double damping = 1;
  double own_pull = 1.49618;
  double common_pull = 1.49618;
  double max_velocity = 0.5;

  void describe(Fields& f);
};

/// Particles attracted to their own best and the global best positions, until the population says
/// that the last batch was. The global best changes between batches, not within one. A particle
/// that leaves the cube stops at its side and turns back.
ALTIPLAN_API void search_by_swarm(Population& population, const SwarmParams& params);
}  // namespace altiplan::kit
