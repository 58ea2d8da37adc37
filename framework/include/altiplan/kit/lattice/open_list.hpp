// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace altiplan::kit {

/// The open list of a best-first search: a 4-ary heap of the entries that come soon; the others
/// wait in heaps of ranges, unordered until they are needed (R. Paredes, G. Navarro, Optimal
/// Incremental Sorting, ALENEX 2006, doi:10.1137/1.9781611972863.16), so that a pop stays in fast
/// memory. The smallest f comes first, among equals the largest g (the one nearest to the goal),
/// then the smallest node number, so the order does not depend on the order of pushes. An improved
/// node is pushed again; the caller skips closed nodes.
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
    later_.clear();
    limit_ = std::numeric_limits<double>::infinity();
    soon_ = kSoon;
    size_ = 0;
    per_quantum_ = 1 / quantum;
  }
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const {
    std::size_t count = entries_.capacity();
    for (const Range& range : later_) {
      count += range.entries.capacity();
    }
    return count * sizeof(Entry);
  }
  const Entry& top() const { return entries_.front(); }

  void push(double f, double g, std::uint32_t node) {
    const Entry entry{std::floor(f * per_quantum_ + 0.5), g, node};
    ++size_;
    if (!later_.empty() && entry.f >= limit_) {
      std::size_t range = later_.size() - 1;
      while (range > 0 && entry.f >= later_[range - 1].from) {
        --range;
      }
      later_[range].entries.push_back(entry);
      return;
    }
    entries_.push_back(entry);
    lift(entries_.size() - 1, entry);
    if (entries_.size() > soon_) {
      arrange();
    }
  }

  Entry pop() {
    --size_;
    const Entry first = entries_.front();
    const Entry last = entries_.back();
    entries_.pop_back();
    const std::size_t count = entries_.size();
    if (count == 0) {
      refill();
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
  static constexpr std::size_t kSoon = 8192;  ///< entries of a heap that stays in fast memory

  /// Entries from an f on, up to that of the range before it.
  struct Range {
    double from;
    std::vector<Entry> entries;
  };

  /// Takes the soonest range into the empty heap.
  void refill() {
    if (later_.empty()) {
      return;
    }
    entries_.swap(later_.back().entries);
    later_.pop_back();
    limit_ = later_.empty() ? std::numeric_limits<double>::infinity() : later_.back().from;
    arrange();
  }

  /// Makes a heap of the soonest entries.
  void arrange() {
    while (entries_.size() > kSoon / 2 && split()) {
    }
    soon_ = std::max(kSoon, 2 * entries_.size());  // many may be equal
    for (std::size_t i = 1; i < entries_.size(); ++i) {
      const Entry entry = entries_[i];
      lift(i, entry);
    }
  }

  /// Moves about half of the entries, those of larger f, to a range of their own; false if all are
  /// equal.
  bool split() {
    constexpr std::size_t kSamples = 15;
    std::array<double, kSamples> samples;
    for (std::size_t i = 0; i < kSamples; ++i) {
      samples[i] = entries_[i * (entries_.size() - 1) / (kSamples - 1)].f;
    }
    std::nth_element(samples.begin(), samples.begin() + kSamples / 2, samples.end());
    double from = samples[kSamples / 2];
    const auto is_sooner = [&from](const Entry& entry) { return entry.f < from; };
    auto middle = std::partition(entries_.begin(), entries_.end(), is_sooner);
    if (middle == entries_.begin()) {  // many equal the least
      from = std::nextafter(from, std::numeric_limits<double>::infinity());
      middle = std::partition(entries_.begin(), entries_.end(), is_sooner);
    }
    if (middle == entries_.end()) {
      return false;
    }
    later_.push_back({from, {middle, entries_.end()}});
    limit_ = from;
    entries_.erase(middle, entries_.end());
    return true;
  }

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
  std::vector<Range> later_;                                ///< the last one comes soonest
  double limit_ = std::numeric_limits<double>::infinity();  ///< f of the soonest range
  std::size_t soon_ = kSoon;  ///< the heap's size beyond which it is split
  std::size_t size_ = 0;
  double per_quantum_ = 1;
};
}  // namespace altiplan::kit
