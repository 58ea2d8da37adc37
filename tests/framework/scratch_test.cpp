// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/scratch.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "altiplan/random.hpp"

namespace altiplan::kit::scratch_test {
namespace {

struct Small {
  int value;
  std::uint8_t stamp;
};

TEST(NodeStore, EveryGenerationStartsUnseenAlsoAfterTheStampWraps) {
  NodeStore<Small> store;
  for (int round = 0; round < 1000; ++round) {
    const std::size_t count = round == 700 ? 200 : 100;
    store.reset(count);
    for (std::size_t i = 0; i < count; i += 7) {
      ASSERT_FALSE(store.seen(i)) << round;
      Small& node = store.at(i, {-1, 0});
      ASSERT_EQ(node.value, -1);
      node.value = round;
      ASSERT_TRUE(store.seen(i));
      ASSERT_EQ(store.at(i, {-1, 0}).value, round);
    }
  }
}

TEST(ScratchArray, IsZeroAfterEveryReset) {
  SplitMix64 random(1);
  ScratchArray<std::uint32_t> array;
  std::size_t largest = 0;
  for (int round = 0; round < 300; ++round) {
    const std::size_t count = std::size_t(random.integer(1, 5000));
    largest = std::max(largest, count);
    array.reset(count);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(array[i], 0u) << round;
    }
    for (int n = 0; n < 40; ++n) {
      const auto i = std::size_t(random.integer(0, int(count) - 1));
      array.at(i) = std::uint32_t(round + 1);
      ASSERT_EQ(array[i], unsigned(round + 1));
    }
  }
  EXPECT_GE(array.bytes(), largest * sizeof(std::uint32_t));
}

TEST(ScratchPool, LendsToOneAtATimeAndKeepsWhatComesBack) {
  ScratchPool<int> pool;
  int* first = nullptr;
  {
    const auto a = pool.take();
    const auto b = pool.take();
    EXPECT_NE(a.get(), b.get());
    first = a.get();
  }
  const auto c = pool.take();
  const auto d = pool.take();
  EXPECT_TRUE(c.get() == first || d.get() == first);
}

TEST(ScratchPool, ServesManyThreads) {
  ScratchPool<std::atomic<int>> pool;
  std::atomic<int> shared{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int n = 0; n < 2000; ++n) {
        const auto work = pool.take();
        shared += work->fetch_add(1) % 2;  // odd: somebody else holds it too
        work->fetch_add(1);
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(shared, 0);
}
}  // namespace
}  // namespace altiplan::kit::scratch_test
