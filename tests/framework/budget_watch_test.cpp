// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/request.hpp"

namespace altiplan::budget_watch_test {
namespace {

/// Of `calls` quick ones, the first that says spent; `calls` where none does.
int first_spent(BudgetWatch& watch, int calls) {
  int call = 0;
  while (call < calls && !watch.spent(0)) {
    ++call;
  }
  return call;
}

TEST(BudgetWatch, WhatIsSpentStaysSpent) {
  std::stop_source source;
  for (const bool by_stop : {false, true}) {
    Budget budget;
    budget.stop = source.get_token();
    BudgetWatch watch(budget);
    EXPECT_EQ(first_spent(watch, 5000), 5000);  // asked every 512th time by now
    if (by_stop) {
      source.request_stop();
    } else {
      budget.deadline = Budget::Clock::now();
    }
    EXPECT_LE(first_spent(watch, 5000), 512);
    for (int call = 0; call < 2000; ++call) {
      ASSERT_TRUE(watch.spent(0)) << call;
    }
    EXPECT_EQ(watch.cancelled(), by_stop);
  }
}

TEST(BudgetWatch, IterationsAreComparedEveryTime) {
  Budget budget;
  budget.max_iterations = 1000;
  BudgetWatch watch(budget);
  for (std::uint64_t iterations = 0; iterations < 1000; ++iterations) {
    ASSERT_FALSE(watch.spent(iterations));
  }
  EXPECT_TRUE(watch.spent(1000));
  EXPECT_TRUE(watch.spent(1001));
  EXPECT_FALSE(watch.cancelled());
}

TEST(BudgetWatch, ShowsItsCountsToWhoeverWatches) {
  SearchProgress progress;
  Budget budget;
  budget.progress = &progress;
  BudgetWatch watch(budget);
  watch.spent(0, 5);
  EXPECT_EQ(progress.open, 0U) << "a count of 0 is that of a phase without one";
  for (std::uint64_t n = 1; n <= 3000; ++n) {
    watch.spent(n, 2 * n);
    EXPECT_LE(progress.expanded, n);
    EXPECT_GE(progress.expanded + 512, n);
    EXPECT_EQ(progress.open, 2 * progress.expanded);
  }
  const Budget copy = budget;
  copy.show_best(12.5);
  copy.show_iteration(3);
  EXPECT_EQ(progress.best, 12.5);
  EXPECT_EQ(progress.iteration, 3U);
  const Budget unwatched;
  unwatched.show_best(1);
  unwatched.show_iteration(1);
  EXPECT_EQ(progress.best, 12.5);
}
}  // namespace
}  // namespace altiplan::budget_watch_test
