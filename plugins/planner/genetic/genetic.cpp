// SPDX-License-Identifier: Apache-2.0
// A real-coded genetic algorithm over whole routes.
//
// Citation: K. Deb, R. B. Agrawal: Simulated binary crossover for continuous search space. Complex
//   Systems 9, 1995; K. Deb: An efficient constraint handling method for genetic algorithms.
//   Computer Methods in Applied Mechanics and Engineering 186, 2000,
//   doi:10.1016/S0045-7825(99)00389-8.
// Guarantees: a larger budget never gives a costlier route; the result does not depend on the
// number
//   of threads. Neither complete nor optimal.
// Complexity: an evaluation of a route for each child.
// Deviations: a number that leaves the cube is put on its side.
#include <algorithm>

#include "altiplan/kit/population/variation.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct Params : kit::PopulationParams {
  int members = 100;
  int elite = 2;
  kit::VariationParams variation;

  void describe(Fields& f) {
    PopulationParams::describe(f);
    f("members", members).range(2, 1'000'000).doc("size of the population");
    f("elite", elite).range(0, 1'000'000).doc("number of the best that live on unchanged");
    variation.describe(f);
    f.check(elite < members, "elite: expected fewer than members");
  }
};

class Genetic final : public kit::PopulationPlanner {
 public:
  explicit Genetic(const Params& params) : PopulationPlanner(params_), params_(params) {}

 private:
  void search(kit::Population& population) const override {
    RandomStream random = population.random("children");
    std::vector<kit::Member> parents = population.draw(std::size_t(params_.members));
    bool goes_on = population.evaluate(parents);
    while (goes_on) {
      std::stable_sort(parents.begin(), parents.end(),
                       [](const auto& a, const auto& b) { return kit::better(a.score, b.score); });
      std::vector<kit::Member> children;
      const std::size_t count = parents.size() - std::size_t(params_.elite);
      while (children.size() < count) {
        const kit::Member& a = tournament(parents, random);
        const kit::Member& b = tournament(parents, random);
        auto [first, second] = kit::children_of(a, b, params_.variation, random);
        children.push_back(std::move(first));
        if (children.size() < count) {
          children.push_back(std::move(second));
        }
      }
      goes_on = population.evaluate(children);
      std::move(children.begin(), children.end(), parents.begin() + params_.elite);
    }
  }

  /// The better of two.
  static const kit::Member& tournament(const std::vector<kit::Member>& parents,
                                       RandomStream& random) {
    const auto drawn = [&]() -> const kit::Member& {
      return parents[std::size_t(random.integer(0, std::int64_t(parents.size()) - 1))];
    };
    const kit::Member& a = drawn();
    const kit::Member& b = drawn();
    return kit::better(b.score, a.score) ? b : a;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "genetic", Genetic, Params,
                "real-coded genetic algorithm over whole routes, for any objective")
