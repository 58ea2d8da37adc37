// SPDX-License-Identifier: Apache-2.0
// Particle swarm optimisation.
//
// Citation: J. Kennedy, R. Eberhart: Particle swarm optimization. ICNN 1995,
//   doi:10.1109/ICNN.1995.488968; with the inertia of Y. Shi, R. Eberhart: A modified particle
//   swarm optimizer. ICEC 1998, doi:10.1109/ICEC.1998.699146; defaults by paper 002.
// Guarantees: none of an optimum. No value ever leaves its range.
// Complexity: `particles` evaluations per iteration, which may all run concurrently.
// Deviations: positions and velocities are normalised by the ranges; the global best is updated
//   once per iteration, so that its evaluations are independent (papers also do it after each
//   particle); a particle that hits a bound stops there. While every evaluation fails, nothing
//   attracts the particles.
// Symbols: x position, v velocity, p a particle's best position, g the global best, w inertia, c1
//   and c2 the attraction to p and g, r1 and r2 uniform from 0 to 1.
#include <algorithm>

#include "altiplan/kit/tuning_space.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/tuner.hpp"

namespace {
using namespace altiplan;

struct Params {
  int particles = 20;
  int iterations = 100;
  double inertia = 0.96;
  double own_pull = 0.5;
  double common_pull = 0.7;
  double max_velocity = 0.1;

  void describe(Fields& f) {
    f("particles", particles).range(1, 100000).doc("particles: evaluations per iteration, N");
    f("iterations", iterations).range(1, 1000000).doc("iterations, T");
    f("inertia", inertia).range(0, 1).doc("fraction of its velocity that a particle keeps, w");
    f("own_pull", own_pull).range(0, 4).doc("attraction to the particle's own best position, c1");
    f("common_pull", common_pull).range(0, 4).doc("attraction to the global best position, c2");
    f("max_velocity", max_velocity)
        .greater_than(0)
        .at_most(1)
        .doc("maximum step on each dimension, as a fraction of its range");
  }
};

using Position = std::vector<double>;

struct Best {
  Position at;
  double score = kInfinity;
};

struct Particle {
  Position x;
  Position v;
  Best p;
  RandomStream random;
};

class Swarm final : public Search {
 public:
  Swarm(const Params& params, const std::vector<Dimension>& space, const RandomStream& random)
      : params_(params), space_(space), particles_(std::size_t(params.particles)) {
    for (std::size_t n = 0; n < particles_.size(); ++n) {
      Particle& particle = particles_[n];
      particle.random = random.sub("particle", n);
      for (std::size_t i = 0; i < space_.dimensions(); ++i) {
        particle.x.push_back(particle.random.uniform());
        particle.v.push_back(particle.random.uniform(-params.max_velocity, params.max_velocity));
      }
    }
  }

 private:
  std::vector<std::vector<double>> do_ask() override {
    if (iteration_ == params_.iterations) {
      return {};
    }
    if (iteration_++ > 0) {
      for (Particle& particle : particles_) {
        move(particle);
      }
    }
    std::vector<std::vector<double>> points;
    for (const Particle& particle : particles_) {
      points.push_back(space_.point(particle.x));
    }
    return points;
  }

  void do_tell(std::span<const double> scores) override {
    for (std::size_t n = 0; n < particles_.size(); ++n) {
      Particle& particle = particles_[n];
      if (scores[n] < particle.p.score) {
        particle.p = {particle.x, scores[n]};
      }
      if (scores[n] < g_.score) {
        g_ = particle.p;
      }
    }
  }

  void move(Particle& particle) const {
    const double maximum = params_.max_velocity;
    for (std::size_t i = 0; i < particle.x.size(); ++i) {
      const double r1 = particle.random.uniform();
      const double r2 = particle.random.uniform();
      double& x = particle.x[i];
      double& v = particle.v[i];
      const double to_p = particle.p.at.empty() ? 0 : particle.p.at[i] - x;
      const double to_g = g_.at.empty() ? 0 : g_.at[i] - x;
      v = params_.inertia * v + params_.own_pull * r1 * to_p + params_.common_pull * r2 * to_g;
      v = std::clamp(v, -maximum, maximum);
      x = std::clamp(x + v, 0.0, 1.0);
    }
  }

  Params params_;
  kit::TuningSpace space_;
  std::vector<Particle> particles_;
  Best g_;
  int iteration_ = 0;
};

class Pso final : public Tuner {
 public:
  explicit Pso(const Params& params) : params_(params) {}

 private:
  std::unique_ptr<Search> do_begin(std::vector<Dimension> space,
                                   RandomStream random) const override {
    return std::make_unique<Swarm>(params_, space, random);
  }
  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Tuner, "pso", Pso, Params,
                "particle swarm: particles attracted to their own best and the global best "
                "positions")
