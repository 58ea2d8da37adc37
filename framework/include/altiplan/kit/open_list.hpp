// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace altiplan::kit {

/// The open list of a best-first search: a heap of four children a node. The least f comes first,
/// among equals the largest g (the one nearest to the goal), then the smallest node number, so the
/// order does not depend on the order of pushes. An improved node is pushed again; the caller skips
/// what it has closed.
class OpenList {
 public:
  struct Entry {
    double f = 0;  ///< in whole quanta
    double g = 0;
    std::uint32_t node = 0;
  };

  /// Empties the list. Sums of equal steps differ in their last bits by the order of addition: f is
  /// compared in whole multiples of `quantum` (> 0), so that such ties are ties.
  void clear(double quantum) {
    entries_.clear();
    per_quantum_ = 1 / quantum;
  }
  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  std::size_t bytes() const { return entries_.capacity() * sizeof(Entry); }
  const Entry& top() const { return entries_.front(); }

  void push(double f, double g, std::uint32_t node) {
    const Entry entry{std::floor(f * per_quantum_ + 0.5), g, node};
    std::size_t at = entries_.size();
    entries_.push_back(entry);
    while (at > 0) {
      const std::size_t parent = (at - 1) / 4;
      if (!before(entry, entries_[parent])) {
        break;
      }
      entries_[at] = entries_[parent];
      at = parent;
    }
    entries_[at] = entry;
  }

  Entry pop() {
    const Entry first = entries_.front();
    const Entry last = entries_.back();
    entries_.pop_back();
    const std::size_t count = entries_.size();
    if (count == 0) {
      return first;
    }
    std::size_t at = 0;
    while (true) {
      const std::size_t begin = 4 * at + 1;
      if (begin >= count) {
        break;
      }
      const std::size_t end = begin + 4 < count ? begin + 4 : count;
      std::size_t best = begin;
      for (std::size_t child = begin + 1; child < end; ++child) {
        if (before(entries_[child], entries_[best])) {
          best = child;
        }
      }
      if (!before(entries_[best], last)) {
        break;
      }
      entries_[at] = entries_[best];
      at = best;
    }
    entries_[at] = last;
    return first;
  }

 private:
  static bool before(const Entry& a, const Entry& b) {
    if (a.f != b.f) {
      return a.f < b.f;
    }
    return a.g != b.g ? a.g > b.g : a.node < b.node;
  }
  std::vector<Entry> entries_;
  double per_quantum_ = 1;
};
}  // namespace altiplan::kit
