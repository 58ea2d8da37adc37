// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/population/variation.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan::kit {

void VariationParams::describe(Fields& f) {
  f("crossover", crossover).range(0, 1).doc("probability that two parents are crossed over");
  f("crossover_eta", crossover_eta)
      .range(0, 1000)
      .doc("distribution index of the crossover: the larger, the nearer children are to parents");
  f("mutation_eta", mutation_eta)
      .range(0, 1000)
      .doc("distribution index of the mutation, likewise");
}

namespace {

/// The spread factor beta of simulated binary crossover.
double spread(double u, double eta) {
  const double power = 1 / (eta + 1);
  return u <= 0.5 ? std::pow(2 * u, power) : std::pow(1 / (2 * (1 - u)), power);
}

/// The step delta of polynomial mutation, in the range.
double step(double u, double eta) {
  const double power = 1 / (eta + 1);
  return u < 0.5 ? std::pow(2 * u, power) - 1 : 1 - std::pow(2 * (1 - u), power);
}

void mutate(Position& x, double eta, RandomStream& random) {
  for (double& one : x) {
    if (random.uniform() < 1 / double(x.size())) {
      one += step(random.uniform(), eta);
    }
    one = std::clamp(one, 0.0, 1.0);
  }
}
}  // namespace

std::pair<Member, Member> children_of(const Member& a, const Member& b,
                                      const VariationParams& params, RandomStream& random) {
  std::pair<Member, Member> children{{a.x}, {b.x}};
  auto& [first, second] = children;
  if (random.uniform() < params.crossover) {
    for (std::size_t i = 0; i < a.x.size(); ++i) {
      const double beta = spread(random.uniform(), params.crossover_eta);
      first.x[i] = ((1 + beta) * a.x[i] + (1 - beta) * b.x[i]) / 2;
      second.x[i] = ((1 - beta) * a.x[i] + (1 + beta) * b.x[i]) / 2;
    }
  }
  mutate(first.x, params.mutation_eta, random);
  mutate(second.x, params.mutation_eta, random);
  return children;
}
}  // namespace altiplan::kit
