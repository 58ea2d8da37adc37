// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/support.hpp"

namespace altiplan::random_search_test {
namespace {

using Point = std::vector<double>;
using testing::make_tuner;

std::vector<Point> draws(const char* yaml, const std::vector<Dimension>& space, double score,
                         std::uint64_t seed = 1) {
  const auto search = make_tuner("random_search", yaml)->begin(space, RandomStream(seed));
  std::vector<Point> all;
  for (auto batch = search->ask(); !batch.empty(); batch = search->ask()) {
    all.insert(all.end(), batch.begin(), batch.end());
    search->tell(std::vector<double>(batch.size(), score));
  }
  return all;
}

const std::vector<Dimension> kSpace{{"a", -3, 7, -1}, {"u", 0, 1, 0}, {"v", 0, 1, 0}};

TEST(RandomSearch, DrawsUniformly) {
  const auto all = draws("{evaluations: 4000}", {{"a", -3, 7, -1}}, 0);
  ASSERT_EQ(all.size(), 4000U);
  std::vector<int> tenths(10);
  for (const Point& point : all) {
    ++tenths[std::size_t(point[0] + 3)];
  }
  for (const int count : tenths) {
    EXPECT_NEAR(count, 400, 100);  // more than five standard deviations
  }
}

TEST(RandomSearch, ScoresAndBatchesChangeNothing) {
  const auto all = draws("{evaluations: 45}", kSpace, 0);
  EXPECT_EQ(all.size(), 45U);
  EXPECT_EQ(all, draws("{evaluations: 45}", kSpace, kInfinity));
  EXPECT_EQ(all, draws("{evaluations: 45, batch: 7}", kSpace, 1));
  EXPECT_NE(all, draws("{evaluations: 45}", kSpace, 0, 2));
}

TEST(RandomSearch, WeightsSumToOne) {
  for (const Point& point : draws("{evaluations: 1000}", kSpace, 0)) {
    EXPECT_NEAR(point[1] + point[2], 1, 1e-12);
  }
}
}  // namespace
}  // namespace altiplan::random_search_test
