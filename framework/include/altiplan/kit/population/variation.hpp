// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/kit/population/population.hpp"

/// \file Operators of real-coded genetic algorithms on the unit cube.
namespace altiplan::kit {

struct ALTIPLAN_API VariationParams {
  double crossover = 0.9;
  double crossover_eta = 15;
  double mutation_eta = 20;

  void describe(Fields& f);
};

/// Two children of two parents by simulated binary crossover, each then by polynomial mutation of a
/// number with the probability of 1 / dimensions. K. Deb, R. B. Agrawal: Simulated binary crossover
/// for continuous search space. Complex Systems 9, 1995. Numbers that leave the cube are put on its
/// side.
ALTIPLAN_API std::pair<Member, Member> children_of(const Member& a, const Member& b,
                                                   const VariationParams& params,
                                                   RandomStream& random);
}  // namespace altiplan::kit
