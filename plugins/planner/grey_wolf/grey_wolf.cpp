// SPDX-License-Identifier: Apache-2.0
// Grey wolf optimiser over whole routes.
//
// Citation: S. Mirjalili, S. M. Mirjalili, A. Lewis: Grey wolf optimizer. Advances in Engineering
//   Software 69, 2014, doi:10.1016/j.advengsoft.2013.12.007.
// Guarantees: a larger budget never gives a costlier route; the result does not depend on the
// number
//   of threads. Neither complete nor optimal.
// Complexity: an evaluation of a route for each wolf and iteration.
// Deviations: a falls with the evaluations of the parameters, whatever the budget; routes are
//   compared by the rules of feasibility (kit/population). The method is drawn to the origin of its
//   coordinates: that is a corner of the cube here, which is no good route.
// Symbols: alpha, beta, delta the three best so far; a falls from 2 to 0; A and C the coefficients
// of
//   a leader; D its distance.
#include <algorithm>
#include <array>
#include <cmath>

#include "altiplan/kit/population/population.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct Params : kit::PopulationParams {
  int wolves = 30;

  void describe(Fields& f) {
    PopulationParams::describe(f);
    f("wolves", wolves).range(3, 1'000'000).doc("size of the pack");
  }
};

class GreyWolf final : public kit::PopulationPlanner {
 public:
  explicit GreyWolf(const Params& params) : PopulationPlanner(params_), params_(params) {}

 private:
  void search(kit::Population& population) const override {
    RandomStream random = population.random("pack");
    std::vector<kit::Member> wolves = population.draw(std::size_t(params_.wolves));
    std::array<kit::Member, 3> leaders;  // alpha, beta, delta
    while (population.evaluate(wolves)) {
      for (const kit::Member& wolf : wolves) {
        follow_best(leaders, wolf);
      }
      const double a = 2.0 * population.evaluations_left() / params_.evaluations;
      for (kit::Member& wolf : wolves) {
        for (std::size_t i = 0; i < wolf.x.size(); ++i) {
          wolf.x[i] = towards(leaders, i, wolf.x[i], a, random);
        }
      }
    }
  }

  static void follow_best(std::array<kit::Member, 3>& leaders, const kit::Member& wolf) {
    const auto worse = std::find_if(leaders.begin(), leaders.end(), [&](const auto& leader) {
      return leader.x.empty() || kit::better(wolf.score, leader.score);
    });
    if (worse != leaders.end()) {
      std::move_backward(worse, leaders.end() - 1, leaders.end());
      *worse = wolf;
    }
  }

  /// The mean of the three places X - A D to which the leaders call.
  static double towards(const std::array<kit::Member, 3>& leaders, std::size_t i, double x,
                        double a, RandomStream& random) {
    double sum = 0;
    for (const kit::Member& leader : leaders) {
      const double A = 2 * a * random.uniform() - a;
      const double C = 2 * random.uniform();
      const double D = std::abs(C * leader.x[i] - x);
      sum += leader.x[i] - A * D;
    }
    return std::clamp(sum / 3, 0.0, 1.0);
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "grey_wolf", GreyWolf, Params,
                "grey wolf optimiser over whole routes, for any objective")
