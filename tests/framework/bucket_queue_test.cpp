// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/bucket_queue.hpp"

#include <gtest/gtest.h>

#include <map>

#include "altiplan/random.hpp"

namespace altiplan::kit::bucket_queue_test {
namespace {

/// What the queue is to do, by a stack for each key.
class Stacks {
 public:
  bool empty() const { return stacks_.empty(); }
  void push(std::uint32_t key, std::uint32_t node) {
    stacks_[std::max(key, least_)].push_back(node);
  }
  std::pair<std::uint32_t, std::uint32_t> pop() {
    const auto first = stacks_.begin();
    least_ = first->first;
    const std::uint32_t node = first->second.back();
    first->second.pop_back();
    if (first->second.empty()) {
      stacks_.erase(first);
    }
    return {least_, node};
  }

 private:
  std::map<std::uint32_t, std::vector<std::uint32_t>> stacks_;
  std::uint32_t least_ = 0;
};

TEST(BucketQueue, TakesTheLeastKeyAndOfEqualsTheLast) {
  SplitMix64 random(1);
  BucketQueue queue;  // one for all rounds: clear() leaves nothing behind
  for (const int spread : {1, 3, 300, 70'000, 20'000'000, 1'000'000'000}) {
    for (int round = 0; round < 20; ++round) {
      queue.clear();
      Stacks expected;
      std::uint32_t least = 0;
      std::size_t inside = 0;
      for (std::uint32_t turn = 0; turn < 4000; ++turn) {
        const bool fills = turn < 2500 ? random.uniform() < 0.6 : random.uniform() < 0.3;
        ASSERT_EQ(queue.empty(), expected.empty());
        if (expected.empty() || fills) {
          // Now and then below the last key taken: it counts as that one.
          const std::uint32_t ahead = std::uint32_t(random.integer(0, spread));
          const bool below = random.uniform() < 0.05;
          const std::uint32_t key = below ? least / 2 : least + std::min(ahead, ~least);
          queue.push(key, turn, turn + 1);
          expected.push(key, turn);
          ++inside;
        } else {
          const BucketQueue::Entry entry = queue.pop();
          const auto [key, node] = expected.pop();
          ASSERT_EQ(entry.key, key) << "spread " << spread << " turn " << turn;
          ASSERT_EQ(entry.node, node);
          ASSERT_EQ(entry.from, node + 1);
          least = key;
          --inside;
        }
        ASSERT_EQ(queue.size(), inside);
      }
    }
  }
}

TEST(BucketQueue, HoldsTheGreatestKey) {
  BucketQueue queue;
  queue.push(~std::uint32_t{0}, 1, 0);
  queue.push(0, 2, 0);
  EXPECT_EQ(queue.pop().node, 2u);
  EXPECT_EQ(queue.pop().key, ~std::uint32_t{0});
  queue.push(5, 3, 0);
  EXPECT_EQ(queue.pop().key, ~std::uint32_t{0});
  EXPECT_TRUE(queue.empty());
}

TEST(BucketQueue, GivesChunksBackForUse) {
  BucketQueue queue;
  std::size_t bytes = 0;
  for (std::uint32_t wave = 0; wave < 50; ++wave) {
    for (std::uint32_t n = 0; n < 1000; ++n) {
      queue.push(wave * 5000 + n % 97, n, 0);
    }
    bytes = wave == 0 ? queue.bytes() : bytes;
    while (!queue.empty()) {
      queue.pop();
    }
  }
  EXPECT_LE(queue.bytes(), 2 * bytes);
}

TEST(BucketQueue, CountsTheBytesUsedSinceItWasEmptied) {
  BucketQueue queue;
  const auto push_two = [&] {
    queue.clear();
    queue.push(1, 1, 1);
    queue.push(2, 2, 2);
    return queue.bytes();
  };
  const std::size_t few = push_two();
  for (std::uint32_t node = 0; node < 10'000; ++node) {
    queue.push(node, node, node);
  }
  EXPECT_GT(queue.bytes(), 100 * few);
  EXPECT_EQ(push_two(), few);
}
}  // namespace
}  // namespace altiplan::kit::bucket_queue_test
