// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace altiplan::kit {

/// A monotone integer priority queue for open lists: keys never fall below the last one popped,
/// which a consistent heuristic guarantees. The smallest key comes first, among equals the last one
/// pushed. A key goes to a bucket by its highest byte that differs from the least key; buckets are
/// split when they become current, so an entry moves at most three times, and one that never
/// becomes current never. An improved node is pushed again; the caller skips closed nodes.
///
/// Multi-level buckets: E. V. Denardo, B. L. Fox, Shortest-Route Methods: 1. Reaching, Pruning, and
/// Buckets. Operations Research 27(1), 1979, doi:10.1287/opre.27.1.161.
class BucketQueue {
 public:
  struct Entry {
    std::uint32_t key;
    std::uint32_t node;
    std::uint32_t from;  ///< for the caller: how the node was reached
  };

  /// Empties the queue; keys start at 0 again.
  void clear() {
    for (std::size_t word = 0; word < filled_.size(); ++word) {
      for (; filled_[word] != 0; filled_[word] &= filled_[word] - 1) {
        heads_[64 * word + std::size_t(std::countr_zero(filled_[word]))] = kNone;
      }
    }
    chunks_.clear();
    has_top_ = false;
    free_ = kNone;
    min_key_ = 0;
    size_ = 0;
  }
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  /// In use since the queue was emptied, whatever its capacity.
  std::size_t bytes() const { return chunks_.size() * sizeof(Chunk); }

  /// A key below the last one popped counts as that one.
  void push(std::uint32_t key, std::uint32_t node, std::uint32_t from) {
    ++size_;
    if (key > min_key_) {
      put({key, node, from});
      return;
    }
    if (has_top_) {
      put(top_);
    }
    top_ = {min_key_, node, from};
    has_top_ = true;
  }

  /// Requires a non-empty queue.
  Entry pop() {
    --size_;
    if (has_top_) {
      has_top_ = false;
      return top_;
    }
    std::size_t bucket = min_key_ % kWidth;
    if (heads_[bucket] == kNone) {
      bucket = next_bucket();
    }
    Chunk& chunk = chunks_[heads_[bucket]];
    --chunk.count;
    const Entry entry = chunk.entry(chunk.count);
    if (chunk.count == 0) {
      const std::uint32_t emptied = heads_[bucket];
      heads_[bucket] = chunk.below;
      give_back(emptied);
      if (heads_[bucket] == kNone) {
        mark(bucket, false);
      }
    }
    return entry;
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  static constexpr std::size_t kWidth = 256;  // buckets per byte of the key
  static constexpr std::size_t kLevels = 4;   // bytes per key
  static constexpr std::uint32_t kEntries = 10;
  struct Chunk {
    std::uint32_t below;  // the next older chunk of the bucket
    std::uint32_t count;
    // Written and read as one word: entries are often popped right after the push, and a load that
    // spans two pending stores has to wait for both.
    std::array<std::uint64_t, kEntries> key_and_node;
    std::array<std::uint32_t, kEntries> from;

    Entry entry(std::uint32_t n) const {
      return {std::uint32_t(key_and_node[n] >> 32), std::uint32_t(key_and_node[n]), from[n]};
    }
    void append(const Entry& entry) {
      key_and_node[count] = std::uint64_t{entry.key} << 32 | entry.node;
      from[count] = entry.from;
      ++count;
    }
  };

  /// Bytes above the returned bucket's are those of the least key.
  std::size_t bucket_of(std::uint32_t key) const {
    const std::uint32_t differs = key ^ min_key_;
    if (differs < 1U << 8) {
      return key % kWidth;
    }
    if (differs < 1U << 16) {
      return kWidth + (key >> 8) % kWidth;
    }
    return differs < 1U << 24 ? 2 * kWidth + (key >> 16) % kWidth : 3 * kWidth + (key >> 24);
  }

  void put(const Entry& entry) {
    const std::size_t bucket = bucket_of(entry.key);
    std::uint32_t head = heads_[bucket];
    if (head == kNone || chunks_[head].count == kEntries) {
      if (head == kNone) {
        mark(bucket, true);
      }
      head = take_chunk(head);
      heads_[bucket] = head;
    }
    chunks_[head].append(entry);
  }

  std::uint32_t take_chunk(std::uint32_t below) {
    if (free_ == kNone) {
      add_chunk();
    }
    const std::uint32_t taken = free_;
    free_ = chunks_[taken].below;
    chunks_[taken].below = below;
    chunks_[taken].count = 0;
    return taken;
  }

  [[gnu::noinline]] void add_chunk() {
    if (chunks_.size() == chunks_.capacity()) {
      chunks_.reserve(chunks_.size() + chunks_.size() / 8 + 16);  // not doubled: memory is counted
    }
    chunks_.emplace_back();
    give_back(std::uint32_t(chunks_.size() - 1));
  }

  void give_back(std::uint32_t chunk) {
    chunks_[chunk].below = free_;
    free_ = chunk;
  }

  void mark(std::size_t bucket, bool filled) {
    const std::uint64_t bit = std::uint64_t{1} << bucket % 64;
    std::uint64_t& word = filled_[bucket / 64];
    word = filled ? word | bit : word & ~bit;
  }

  /// First non-empty bucket of the lowest non-empty level.
  std::size_t first_filled() const {
    std::size_t word = 0;
    while (filled_[word] == 0) {
      ++word;
    }
    return 64 * word + std::size_t(std::countr_zero(filled_[word]));
  }

  /// The bucket whose newest entry has the least key in the queue, which becomes min_key_.
  std::size_t next_bucket() {
    const std::size_t bucket = first_filled();
    if (bucket < kWidth) {
      min_key_ = std::uint32_t(min_key_ / kWidth * kWidth + bucket);
      return bucket;
    }
    std::uint32_t newest = heads_[bucket];
    if (chunks_[newest].count == 1 && chunks_[newest].below == kNone) {
      min_key_ = chunks_[newest].entry(0).key;
      return bucket;  // alone in its bucket: used in place
    }
    heads_[bucket] = kNone;
    mark(bucket, false);
    // Oldest first, so that the newest entry stays on top.
    std::uint32_t chunk = kNone;
    min_key_ = kNone;
    while (newest != kNone) {
      for (std::uint32_t n = 0; n < chunks_[newest].count; ++n) {
        min_key_ = std::min(min_key_, chunks_[newest].entry(n).key);
      }
      const std::uint32_t older = chunks_[newest].below;
      chunks_[newest].below = chunk;
      chunk = newest;
      newest = older;
    }
    while (chunk != kNone) {
      for (std::uint32_t n = 0; n < chunks_[chunk].count; ++n) {
        put(chunks_[chunk].entry(n));
      }
      const std::uint32_t newer = chunks_[chunk].below;
      give_back(chunk);
      chunk = newer;
    }
    return min_key_ % kWidth;
  }

  std::vector<Chunk> chunks_;
  std::array<std::uint32_t, kLevels* kWidth> heads_ = none();
  std::array<std::uint64_t, kLevels * kWidth / 64> filled_{};  // one bit per bucket
  std::uint32_t free_ = kNone;
  std::uint32_t min_key_ = 0;
  std::size_t size_ = 0;
  Entry top_{};  // the last one pushed with the least key waits outside the buckets
  bool has_top_ = false;

  static constexpr std::array<std::uint32_t, kLevels * kWidth> none() {
    std::array<std::uint32_t, kLevels * kWidth> heads{};
    heads.fill(kNone);
    return heads;
  }
};
}  // namespace altiplan::kit
