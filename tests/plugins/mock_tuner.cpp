// SPDX-License-Identifier: Apache-2.0
// A tuner written against the public headers alone: compass search (Hooke and Jeeves, 1961,
// doi:10.1145/321062.321069). Around the best point so far it asks for a step up and down each
// dimension; where none is better the steps are halved.
#include <algorithm>
#include <cmath>

#include "altiplan/plugin.hpp"
#include "altiplan/tuner.hpp"

namespace {
using namespace altiplan;

struct Params {
  double first_step = 0.25;
  int halvings = 5;
  int rounds = 60;
  void describe(Fields& f) {
    f("first_step", first_step).greater_than(0).at_most(1).doc("share of a dimension's range");
    f("halvings", halvings).range(0, 40).doc("of the step, before the search ends");
    f("rounds", rounds).range(1, 10000).doc("batches at most");
  }
};

using Point = std::vector<double>;

class Compass final : public Search {
 public:
  Compass(const Params& params, std::vector<Dimension> space, RandomStream random)
      : params_(params), space_(std::move(space)), step_(params.first_step) {
    for (const Dimension& d : space_) {
      best_.push_back(random.uniform(d.min, d.max));
    }
    onto_space(best_);
  }

 private:
  std::vector<Point> do_ask() override {
    asked_.clear();
    if (halved_ > params_.halvings || round_ == params_.rounds) {
      return asked_;
    }
    if (round_++ == 0) {
      asked_.push_back(best_);
    }
    for (std::size_t i = 0; i < space_.size(); ++i) {
      for (const double sign : {1.0, -1.0}) {
        Point next = best_;
        next[i] += sign * step_ * (space_[i].max - space_[i].min);
        onto_space(next);
        if (next != best_) {
          asked_.push_back(std::move(next));
        }
      }
    }
    if (asked_.empty()) {
      halved_ = params_.halvings + 1;
    }
    return asked_;
  }

  void do_tell(std::span<const double> scores) override {
    const auto best = std::min_element(scores.begin(), scores.end());
    if (best != scores.end() && *best < score_) {
      score_ = *best;
      best_ = asked_[std::size_t(best - scores.begin())];
    } else {
      step_ /= 2;
      ++halved_;
    }
  }

  /// Into the bounds; the weights of a group to a sum of 1, what is left of it given where there is
  /// room.
  void onto_space(Point& point) const {
    for (std::size_t i = 0; i < point.size(); ++i) {
      point[i] = std::clamp(point[i], space_[i].min, space_[i].max);
    }
    for (const Dimension& first : space_) {
      if (first.group < 0) {
        continue;
      }
      double left = 1;
      for (std::size_t i = 0; i < point.size(); ++i) {
        left -= space_[i].group == first.group ? point[i] : 0;
      }
      for (std::size_t i = 0; i < point.size() && left != 0; ++i) {
        if (space_[i].group == first.group) {
          const double now = std::clamp(point[i] + left, space_[i].min, space_[i].max);
          left -= now - point[i];
          point[i] = now;
        }
      }
    }
  }

  Params params_;
  std::vector<Dimension> space_;
  double step_;
  Point best_;
  double score_ = kInfinity;
  std::vector<Point> asked_;
  int round_ = 0;
  int halved_ = 0;
};

class CompassTuner final : public Tuner {
 public:
  explicit CompassTuner(const Params& params) : params_(params) {}

 private:
  std::unique_ptr<Search> do_begin(std::vector<Dimension> space,
                                   RandomStream random) const override {
    return std::make_unique<Compass>(params_, std::move(space), random);
  }
  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Tuner, "compass", CompassTuner, Params,
                "compass search: a step up and down each dimension, halved where none is better")
