// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "altiplan/kit/bucket_queue.hpp"

namespace altiplan::dstar_lite {

/// A heap of entries, the least key first, among equals the one nearest to the start; an entry
/// whose key has changed is pushed again.
class Heap {
 public:
  struct Entry {
    std::uint32_t key;
    std::uint32_t h;  ///< the estimate that is a part of the key
    std::uint32_t node;

    /// Of heaps of the standard library, which have the greatest on top.
    friend bool operator<(const Entry& a, const Entry& b) { return a.rank() > b.rank(); }

   private:
    std::uint64_t rank() const { return std::uint64_t{key} << 32 | h; }
  };
  void clear() { entries_.clear(); }
  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  std::size_t bytes() const { return entries_.size() * sizeof(Entry); }
  const Entry& top() const { return entries_.front(); }
  void push(const Entry& entry) {
    entries_.push_back(entry);
    std::push_heap(entries_.begin(), entries_.end());
  }
  Entry pop() {
    std::pop_heap(entries_.begin(), entries_.end());
    const Entry entry = entries_.back();
    entries_.pop_back();
    return entry;
  }

 private:
  std::vector<Entry> entries_;
};

/// The open list. A first search takes keys that never fall, from buckets; a repair puts keys below
/// the last one taken, few of them, into a heap, and leaves the buckets as they are.
class OpenQueue {
 public:
  using Entry = Heap::Entry;

  void clear() {
    buckets_.clear();
    below_.clear();
    next_.reset();
    least_ = 0;
  }
  bool empty() const { return below_.empty() && !next_ && buckets_.empty(); }
  std::size_t size() const { return below_.size() + buckets_.size() + (next_ ? 1 : 0); }
  std::size_t bytes() const { return below_.bytes() + buckets_.bytes(); }
  void push(const Entry& entry) {
    if (entry.key < least_) {
      below_.push(entry);
    } else {
      buckets_.push(entry.key, entry.node, entry.h);
    }
  }
  /// Neither is to be called on an empty queue.
  Entry top() {
    if (!below_.empty()) {
      return below_.top();
    }
    if (!next_) {
      const kit::BucketQueue::Entry entry = buckets_.pop();
      least_ = entry.key;
      next_ = Entry{entry.key, entry.from, entry.node};
    }
    return *next_;
  }
  Entry pop() {
    if (!below_.empty()) {
      return below_.pop();
    }
    const Entry entry = top();
    next_.reset();
    return entry;
  }

 private:
  kit::BucketQueue buckets_;
  Heap below_;                 ///< keys below least_
  std::optional<Entry> next_;  ///< taken from the buckets already
  std::uint32_t least_ = 0;    ///< the last key taken from the buckets
};
}  // namespace altiplan::dstar_lite
