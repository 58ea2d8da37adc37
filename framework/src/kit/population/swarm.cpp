// SPDX-License-Identifier: Apache-2.0
// Symbols: x position, v velocity, p a particle's best position, g the global best, w inertia, c1
// and c2 the attraction to p and g, r1 and r2 uniform from 0 to 1.
#include "altiplan/kit/population/swarm.hpp"

#include <algorithm>

namespace altiplan::kit {

void SwarmParams::describe(Fields& f) {
  PopulationParams::describe(f);
  f("particles", particles).range(1, 1'000'000).doc("number of particles, N");
  f("inertia", inertia).range(0, 1).doc("fraction of its velocity that a particle keeps, w");
  f("damping", damping)
      .greater_than(0)
      .at_most(1)
      .doc("factor of the inertia after each iteration");
  f("own_pull", own_pull).range(0, 4).doc("attraction to the particle's own best position, c1");
  f("common_pull", common_pull).range(0, 4).doc("attraction to the global best position, c2");
  f("max_velocity", max_velocity)
      .greater_than(0)
      .at_most(1)
      .doc("maximum step on each dimension, as a fraction of its range");
}

namespace {
struct Particle : Member {
  Position v;
  Member p;
};
}  // namespace

void search_by_swarm(Population& population, const SwarmParams& params) {
  RandomStream random = population.random("swarm");
  std::vector<Particle> swarm;
  for (Member& drawn : population.draw(std::size_t(params.particles))) {
    swarm.push_back({std::move(drawn), Position(population.dimensions(), 0), {}});
  }
  double w = params.inertia;
  while (population.evaluate(swarm)) {
    for (Particle& particle : swarm) {
      if (particle.p.x.empty() || better(particle.score, particle.p.score)) {
        particle.p = particle;
      }
    }
    const Position& g = population.best().x;
    for (Particle& particle : swarm) {
      for (std::size_t i = 0; i < particle.x.size() && !g.empty(); ++i) {
        double& x = particle.x[i];
        double& v = particle.v[i];
        const double r1 = random.uniform();
        const double r2 = random.uniform();
        v = w * v + params.own_pull * r1 * (particle.p.x[i] - x) +
            params.common_pull * r2 * (g[i] - x);
        v = std::clamp(v, -params.max_velocity, params.max_velocity);
        x += v;
        if (x < 0 || x > 1) {
          x = std::clamp(x, 0.0, 1.0);
          v = -v;
        }
      }
    }
    w *= params.damping;
  }
}
}  // namespace altiplan::kit
