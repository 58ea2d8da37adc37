// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace altiplan::kit {

/// The open list of a best-first search: a 4-ary heap. The smallest f comes first, among equals the
/// largest g (the one nearest to the goal), then the smallest node number, so the order does not
/// depend on the order of pushes. An improved node is pushed again; the caller skips closed nodes.
class OpenList {
 public:
  struct Entry {
    double f = 0;  ///< in multiples of the quantum
    double g = 0;
    std::uint32_t node = 0;
  };

  /// Empties the list. Sums of equal steps differ in their last bits by the order of addition: f is
  /// compared in integer multiples of `quantum` (> 0), so that such ties are ties.
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
    entries_.push_back(entry);
    lift(entries_.size() - 1, entry);
  }

  Entry pop() {
    const Entry first = entries_.front();
    const Entry last = entries_.back();
    entries_.pop_back();
    const std::size_t count = entries_.size();
    if (count == 0) {
      return first;
    }
    // The hole sinks to a leaf, where the last entry nearly always belongs, and rises from there.
    std::size_t at = 0;
    std::size_t child = 1;
    for (; child + 4 <= count; child = 4 * at + 1) {
      const std::size_t left = child + before(entries_[child + 1], entries_[child]);
      const std::size_t right = child + 2 + before(entries_[child + 3], entries_[child + 2]);
      const std::size_t best = before(entries_[right], entries_[left]) ? right : left;
      entries_[at] = entries_[best];
      at = best;
    }
    if (child < count) {
      std::size_t best = child;
      while (++child < count) {
        best = before(entries_[child], entries_[best]) ? child : best;
      }
      entries_[at] = entries_[best];
      at = best;
    }
    lift(at, last);
    return first;
  }

 private:
  /// Sifts the entry up from that position.
  void lift(std::size_t at, const Entry& entry) {
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

  /// Branch-free: no processor can predict which of two children comes first.
  static bool before(const Entry& a, const Entry& b) {
    const int by_node = a.node < b.node;
    const int by_g = int(a.g > b.g) | (int(a.g == b.g) & by_node);
    return (int(a.f < b.f) | (int(a.f == b.f) & by_g)) != 0;
  }
  std::vector<Entry> entries_;
  double per_quantum_ = 1;
};
}  // namespace altiplan::kit
