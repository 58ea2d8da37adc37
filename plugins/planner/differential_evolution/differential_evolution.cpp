// SPDX-License-Identifier: Apache-2.0
// Differential evolution (DE/rand/1/bin) of whole routes.
//
// Citation: R. Storn, K. Price: Differential evolution - a simple and efficient heuristic for
// global
//   optimization over continuous spaces. Journal of Global Optimization 11, 1997,
//   doi:10.1023/A:1008202821328.
// Guarantees: a larger budget never gives a costlier route; the result does not depend on the
// number
//   of threads. Neither complete nor optimal.
// Complexity: an evaluation of a route for each member and generation.
// Deviations: a number that leaves the cube is put halfway between its side and the parent's;
// routes
//   are compared by the rules of feasibility (kit/population).
// Symbols: x parents, v mutants, u trials, F the factor of differences, CR the crossover rate.
#include "altiplan/kit/population/population.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct Params : kit::PopulationParams {
  int members = 100;
  double factor = 0.5;
  double crossover = 0.9;

  void describe(Fields& f) {
    PopulationParams::describe(f);
    f("members", members).range(4, 1'000'000).doc("size of the population, NP");
    f("factor", factor).greater_than(0).at_most(2).doc("factor of differences, F");
    f("crossover", crossover)
        .range(0, 1)
        .doc("share of numbers that a trial has of its mutant, CR");
  }
};

class DifferentialEvolution final : public kit::PopulationPlanner {
 public:
  explicit DifferentialEvolution(const Params& params)
      : PopulationPlanner(params_), params_(params) {}

 private:
  void search(kit::Population& population) const override {
    RandomStream random = population.random("trials");
    std::vector<kit::Member> x = population.draw(std::size_t(params_.members));
    bool goes_on = population.evaluate(x);
    while (goes_on) {
      std::vector<kit::Member> u;
      for (std::size_t i = 0; i < x.size(); ++i) {
        u.push_back(trial(x, i, random));
      }
      goes_on = population.evaluate(u);
      for (std::size_t i = 0; i < x.size(); ++i) {
        if (!kit::better(x[i].score, u[i].score)) {
          x[i] = std::move(u[i]);
        }
      }
    }
  }

  /// v = x_a + F (x_b - x_c), crossed with the parent.
  kit::Member trial(const std::vector<kit::Member>& x, std::size_t i, RandomStream& random) const {
    const auto [a, b, c] = three_others(x.size(), i, random);
    kit::Member u{x[i].x};
    const std::size_t sure = std::size_t(random.integer(0, std::int64_t(u.x.size()) - 1));
    for (std::size_t j = 0; j < u.x.size(); ++j) {
      if (random.uniform() < params_.crossover || j == sure) {
        const double v = x[a].x[j] + params_.factor * (x[b].x[j] - x[c].x[j]);
        u.x[j] = v < 0 ? x[i].x[j] / 2 : v > 1 ? (1 + x[i].x[j]) / 2 : v;
      }
    }
    return u;
  }

  /// Three members, different from each other and from i.
  static std::array<std::size_t, 3> three_others(std::size_t count, std::size_t i,
                                                 RandomStream& random) {
    std::array<std::size_t, 3> others{};
    for (std::size_t n = 0; n < 3;) {
      others[n] = std::size_t(random.integer(0, std::int64_t(count) - 1));
      const bool is_new =
          others[n] != i && (n < 1 || others[n] != others[0]) && (n < 2 || others[n] != others[1]);
      n += is_new ? 1 : 0;
    }
    return others;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "differential_evolution", DifferentialEvolution, Params,
                "differential evolution (DE/rand/1/bin) of whole routes, for any objective")
