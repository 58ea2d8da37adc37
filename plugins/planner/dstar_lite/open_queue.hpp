// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "altiplan/kit/lattice/bucket_queue.hpp"
#include "altiplan/kit/lattice/open_list.hpp"

namespace altiplan::dstar_lite {

/// A vertex on a list.
struct Entry {
  std::uint32_t key;
  std::uint32_t h;  ///< the estimate contained in the key
  std::uint32_t node;
};

/// A heap of entries, minimum key first, among equals the one nearest to the start; an entry whose
/// key has changed is pushed again.
class Heap {
 public:
  void clear() { list_.clear(1); }
  bool empty() const { return list_.empty(); }
  std::size_t size() const { return list_.size(); }
  std::size_t bytes() const { return list_.size() * sizeof(kit::OpenList::Entry); }
  Entry top() const { return entry(list_.top()); }
  void push(const Entry& entry) { list_.push(entry.key, -double(entry.h), entry.node); }
  Entry pop() { return entry(list_.pop()); }

 private:
  static Entry entry(const kit::OpenList::Entry& kept) {
    return {std::uint32_t(kept.f), std::uint32_t(-kept.g), kept.node};
  }
  kit::OpenList list_;
};

/// The open list. A first search pops keys in non-decreasing order, from buckets; a repair puts the
/// few keys below the last one popped into a heap and leaves the buckets as they are.
class OpenQueue {
 public:
  void clear() {
    buckets_.clear();
    below_.clear();
    next_.reset();
    min_key_ = 0;
  }
  bool empty() const { return below_.empty() && !next_ && buckets_.empty(); }
  std::size_t size() const { return below_.size() + buckets_.size() + (next_ ? 1 : 0); }
  std::size_t bytes() const { return below_.bytes() + buckets_.bytes(); }
  void push(const Entry& entry) {
    if (entry.key < min_key_) {
      below_.push(entry);
    } else {
      buckets_.push(entry.key, entry.node, entry.h);
    }
  }
  /// Neither may be called on an empty queue.
  Entry top() {
    if (!below_.empty()) {
      return below_.top();
    }
    if (!next_) {
      const kit::BucketQueue::Entry entry = buckets_.pop();
      min_key_ = entry.key;
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
  Heap below_;                 ///< keys below min_key_
  std::optional<Entry> next_;  ///< already taken from the buckets
  std::uint32_t min_key_ = 0;  ///< the last key taken from the buckets
};
}  // namespace altiplan::dstar_lite
