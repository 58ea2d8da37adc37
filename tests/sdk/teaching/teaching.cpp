// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <altiplan/kit/population/population.hpp>
#include <altiplan/plugin.hpp>

namespace {
using namespace altiplan;

struct Params : kit::PopulationParams {
  int learners = 50;

  void describe(Fields& f) {
    PopulationParams::describe(f);
    f("learners", learners).range(2, 1'000'000).doc("size of the class");
  }
};

class Teaching final : public kit::PopulationPlanner {
 public:
  explicit Teaching(const Params& params) : PopulationPlanner(params_), params_(params) {}

 private:
  void search(kit::Population& population) const override {
    RandomStream random = population.random("lessons");
    std::vector<kit::Member> learners = population.draw(std::size_t(params_.learners));
    bool goes_on = population.evaluate(learners);  // false: that was the last batch
    while (goes_on) {
      const kit::Position mean = mean_of(learners);
      std::vector<kit::Member> taught = learners;
      for (kit::Member& learner : taught) {
        const double factor = random.uniform() < 0.5 ? 1 : 2;
        for (std::size_t i = 0; i < learner.x.size(); ++i) {
          const double away = population.best().x[i] - factor * mean[i];
          learner.x[i] = std::clamp(learner.x[i] + random.uniform() * away, 0.0, 1.0);
        }
      }
      goes_on = population.evaluate(taught);
      for (std::size_t n = 0; n < learners.size(); ++n) {
        if (kit::better(taught[n].score, learners[n].score)) {
          learners[n] = taught[n];
        }
      }
    }
  }

  static kit::Position mean_of(const std::vector<kit::Member>& learners) {
    kit::Position mean(learners.front().x.size(), 0);
    for (const kit::Member& learner : learners) {
      for (std::size_t i = 0; i < mean.size(); ++i) {
        mean[i] += learner.x[i] / double(learners.size());
      }
    }
    return mean;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "teaching", Teaching, Params, "teaching-learning-based optimisation")
