// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

namespace altiplan::hybrid_astar {

/// Priority queue with four children a node, of which a cache line holds all: the least on top.
template <class Entry>
class Heap {
 public:
  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  const Entry& top() const { return entries_.front(); }

  void push(const Entry& entry) {
    std::size_t at = entries_.size();
    entries_.push_back(entry);
    while (at > 0 && entry < entries_[(at - 1) / kChildren]) {
      entries_[at] = entries_[(at - 1) / kChildren];
      at = (at - 1) / kChildren;
    }
    entries_[at] = entry;
  }

  void pop() {
    const Entry last = entries_.back();
    entries_.pop_back();
    const std::size_t size = entries_.size();
    std::size_t at = 0;
    for (std::size_t child = 1; child < size; child = kChildren * at + 1) {
      const std::size_t end = std::min(child + kChildren, size);
      for (std::size_t other = child + 1; other < end; ++other) {
        child = entries_[other] < entries_[child] ? other : child;
      }
      if (!(entries_[child] < last)) {
        break;
      }
      entries_[at] = entries_[child];
      at = child;
    }
    if (size > 0) {
      entries_[at] = last;
    }
  }

 private:
  static constexpr std::size_t kChildren = 4;
  std::vector<Entry> entries_;
};
}  // namespace altiplan::hybrid_astar
