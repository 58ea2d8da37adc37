// SPDX-License-Identifier: Apache-2.0
// Random search: random points, regardless of the scores.
//
// Citation: J. Bergstra, Y. Bengio: Random Search for Hyper-Parameter Optimization. JMLR 13 (2012).
// Guarantees: n points hit the best fraction q of the space with probability 1 - (1 - q)^n.
// Complexity: `evaluations` evaluations, one batch at a time.
// Deviations: weights of a group are uniform numbers divided by their sum, as `pso` initialises its
//   particles, so that the two are compared on the same samples; they are not uniform on the
//   simplex.
#include <algorithm>

#include "altiplan/kit/tuning_space.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/tuner.hpp"

namespace {
using namespace altiplan;

struct Params {
  int evaluations = 2000;
  int batch = 20;
  void describe(Fields& f) {
    f("evaluations", evaluations).range(1, 10000000).doc("total number of evaluations");
    f("batch", batch).range(1, 100000).doc("evaluations requested at a time");
  }
};

class Draws final : public Search {
 public:
  Draws(const Params& params, const std::vector<Dimension>& space, const RandomStream& random)
      : params_(params), space_(space), random_(random.sub("point")) {}

 private:
  std::vector<std::vector<double>> do_ask() override {
    const int size = std::min(params_.batch, params_.evaluations - drawn_);
    std::vector<std::vector<double>> points;
    for (int n = 0; n < size; ++n) {
      std::vector<double> position;
      for (std::size_t i = 0; i < space_.dimensions(); ++i) {
        position.push_back(random_.uniform());
      }
      points.push_back(space_.point(position));
    }
    drawn_ += size;
    return points;
  }
  void do_tell(std::span<const double>) override {}

  Params params_;
  kit::TuningSpace space_;
  RandomStream random_;
  int drawn_ = 0;
};

class RandomSearch final : public Tuner {
 public:
  explicit RandomSearch(const Params& params) : params_(params) {}

 private:
  std::unique_ptr<Search> do_begin(std::vector<Dimension> space,
                                   RandomStream random) const override {
    return std::make_unique<Draws>(params_, space, random);
  }
  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Tuner, "random_search", RandomSearch, Params,
                "random points: the baseline for other tuners")
