// SPDX-License-Identifier: Apache-2.0
#include <altiplan/kit/tuning_space.hpp>
#include <altiplan/plugin.hpp>
#include <altiplan/tuner.hpp>

namespace {
using namespace altiplan;

struct Params {
  int points = 5;

  void describe(Fields& f) {  // the only place that lists them
    f("points", points).range(2, 1000).doc("number of grid points along each parameter");
  }
};

/// One search: each row of the grid is a batch.
class Grid final : public Search {
 public:
  Grid(const Params& params, const std::vector<Dimension>& space)
      : params_(params), space_(space), at_(space.size()) {}

 private:
  std::vector<std::vector<double>> do_ask() override {
    std::vector<std::vector<double>> row;
    for (int i = 0; i < params_.points && !done_; ++i) {
      std::vector<double> position;  // each parameter from 0 to 1
      for (const int n : at_) {
        position.push_back(double(n) / (params_.points - 1));
      }
      row.push_back(space_.point(position));  // in its own units; weights of a group sum to 1
      advance();
    }
    return row;
  }

  void do_tell(std::span<const double>) override {}  // a grid does not use the scores

  /// Advances to the next point, the first parameter fastest.
  void advance() {
    for (int& n : at_) {
      if (++n < params_.points) {
        return;
      }
      n = 0;
    }
    done_ = true;
  }

  Params params_;
  kit::TuningSpace space_;
  std::vector<int> at_;  ///< the next point, by its index along each parameter
  bool done_ = false;
};

class GridSearch final : public Tuner {
 public:
  explicit GridSearch(const Params& params) : params_(params) {}

 private:
  std::unique_ptr<Search> do_begin(std::vector<Dimension> space, RandomStream) const override {
    return std::make_unique<Grid>(params_, space);
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Tuner, "@name@", GridSearch, Params, "Evaluates every point of a grid")
