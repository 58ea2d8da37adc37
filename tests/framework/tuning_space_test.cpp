// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/tuning_space.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "altiplan/error.hpp"

namespace altiplan::kit::tuning_space_test {
namespace {
using Numbers = std::vector<double>;

double sum(const Numbers& numbers) { return std::accumulate(numbers.begin(), numbers.end(), 0.0); }

Numbers random_position(SplitMix64& random, std::size_t size) {
  Numbers position;
  for (std::size_t i = 0; i < size; ++i) {
    position.push_back(random.integer(0, 4) == 0 ? random.integer(0, 1) : random.uniform());
  }
  return position;
}

TEST(TuningSpace, NumbersByTheirShareOfTheRange) {
  const TuningSpace space({{"a", -3, 7, -1}, {"b", 1e-9, 2e-9, -1}, {"c", 2, 2, -1}});
  EXPECT_EQ(space.point(Numbers{0, 1, 0.5}), (Numbers{-3, 2e-9, 2}));
  EXPECT_EQ(space.point(Numbers{0.25, 0, 0}), (Numbers{-0.5, 1e-9, 2}));
}

TEST(TuningSpace, FreeWeightsAreDividedByTheirSum) {
  SplitMix64 random(4);
  const TuningSpace space({{"a", 0, 1, 0}, {"x", 5, 6, -1}, {"b", 0, 1, 0}, {"c", 0, 1, 0}});
  for (int n = 0; n < 1000; ++n) {
    const Numbers u = random_position(random, 4);
    const double all = u[0] + u[2] + u[3];
    if (all == 0) {
      continue;
    }
    const Numbers point = space.point(u);
    for (const std::size_t i : {0U, 2U, 3U}) {
      EXPECT_NEAR(point[i], u[i] / all, 1e-15);
    }
    EXPECT_EQ(point[1], 5 + u[1]);
  }
}

TEST(TuningSpace, NothingInAGroupMeansEqualWeights) {
  const TuningSpace space({{"a", 0, 1, 3}, {"b", 0, 1, 3}, {"alone", 0, 1, 1}});
  const Numbers point = space.point(Numbers{0, 0, 0});
  EXPECT_NEAR(point[0], 0.5, 1e-15);
  EXPECT_NEAR(point[1], 0.5, 1e-15);
  EXPECT_NEAR(point[2], 1, 1e-15);
}

/// Weights keep their bounds, sum to 1, and those at no bound keep the ratios that they came with.
TEST(TuningSpace, BoundedWeightsShareWhatIsLeft) {
  SplitMix64 random(5);
  int at_bounds = 0;
  for (int n = 0; n < 2000; ++n) {
    std::vector<Dimension> dimensions;
    double least = 0;
    double most = 0;
    for (int i = 0; i < 4; ++i) {
      const double min = random.integer(0, 1) * random.uniform() / 4;
      const double max = min + random.uniform() * (1 - min);
      dimensions.push_back({"w", min, max, 0});
      least += min;
      most += max;
    }
    if (least > 0.999 || most < 1.001) {
      continue;
    }
    const Numbers u = random_position(random, 4);
    const Numbers point = TuningSpace(dimensions).point(u);
    EXPECT_NEAR(sum(point), 1, 1e-12);
    double ratio = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Dimension& d = dimensions[i];
      EXPECT_GE(point[i], d.min);
      EXPECT_LE(point[i], d.max);
      const double raw = d.min + u[i] * (d.max - d.min);
      const bool at_bound = point[i] == d.min || point[i] == d.max;
      at_bounds += at_bound;
      if (!at_bound && raw > 1e-6) {
        ratio = ratio == 0 ? point[i] / raw : ratio;
        EXPECT_NEAR(point[i] / raw, ratio, 1e-6 * ratio);
      }
    }
  }
  EXPECT_GT(at_bounds, 500);
}

class Told final : public Search {
 public:
  explicit Told(std::vector<std::vector<double>> batch) : batch_(std::move(batch)) {}

 private:
  std::vector<std::vector<double>> do_ask() override { return batch_; }
  void do_tell(std::span<const double>) override {}
  std::vector<std::vector<double>> batch_;
};

class ToldTuner final : public Tuner {
 public:
  explicit ToldTuner(std::vector<std::vector<double>> batch) : batch_(std::move(batch)) {}

 private:
  std::unique_ptr<Search> do_begin(std::vector<Dimension>, RandomStream) const override {
    return std::make_unique<Told>(batch_);
  }
  std::vector<std::vector<double>> batch_;
};

TEST(Tuner, SpacesWithoutAPointAreRefused) {
  const ToldTuner tuner({});
  EXPECT_THROW(tuner.begin({{"a", 2, 1, -1}}, {}), Error);
  EXPECT_THROW(tuner.begin({{"a", 0, kInfinity, -1}}, {}), Error);
  EXPECT_THROW(tuner.begin({{"a", 0, 0.4, 0}, {"b", 0, 0.5, 0}}, {}), Error);
  EXPECT_THROW(tuner.begin({{"a", 0.6, 1, 0}, {"b", 0.6, 1, 0}}, {}), Error);
  EXPECT_NE(tuner.begin({{"a", 0.4, 1, 0}, {"b", 0.6, 1, 0}}, {}), nullptr);
}

TEST(Tuner, BatchesOutsideTheSpaceAreRefused) {
  const std::vector<Dimension> space{{"a", 0, 1, 0}, {"b", 0, 1, 0}, {"c", 3, 4, -1}};
  for (const Numbers& wrong :
       {Numbers{0.5, 0.5}, Numbers{0.5, 0.5, 5}, Numbers{0.5, 0.6, 3}, Numbers{1.5, -0.5, 3},
        Numbers{0.5, 0.5, std::nan("")}, Numbers{std::nan(""), 0.5, 3}}) {
    EXPECT_THROW(ToldTuner({{0.5, 0.5, 3}, wrong}).begin(space, {})->ask(), PluginError);
  }
  EXPECT_EQ(ToldTuner({{0.25, 0.75, 4}}).begin(space, {})->ask().size(), 1U);
}

TEST(Tuner, ScoresThatAreNoneAreRefused) {
  const ToldTuner tuner({{1.0}, {2.0}});
  const auto search = tuner.begin({{"a", 0, 2, -1}}, {});
  EXPECT_THROW(search->tell(Numbers{1, 2}), Error);  // nothing was asked for
  search->ask();
  EXPECT_THROW(search->tell(Numbers{1}), Error);
  EXPECT_THROW(search->tell(Numbers{1, std::nan("")}), Error);
  search->tell(Numbers{1, kInfinity});
  EXPECT_THROW(search->tell(Numbers{1, 2}), Error);  // told twice
}
}  // namespace
}  // namespace altiplan::kit::tuning_space_test
