// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "altiplan/api.hpp"

namespace altiplan::kit {

/// A closed tour of pieces that are flown once each, in either direction: piece k has the ends 2k
/// and 2k + 1. Joins cost what a symmetric matrix says.
class ALTIPLAN_API Tour {
 public:
  /// `cost`: of the join between two ends, row by row, for all ends.
  Tour(std::size_t pieces, std::vector<double> cost);

  /// Nearest neighbour, then 2-opt and Or-opt moves to a local optimum.
  void construct();
  /// Perturbs and repairs until `spent` says so; never keeps a worse tour.
  void improve(std::uint64_t seed, const std::function<bool()>& spent);
  double cost() const { return cost_; }
  /// Ends at which the pieces are entered, in order.
  const std::vector<int>& entries() const { return entry_; }
  void set_entries(std::vector<int> entries);

 private:
  double join(int a, int b) const { return cost_of_[std::size_t(a) * ends_ + std::size_t(b)]; }
  int n() const { return int(entry_.size()); }
  int in(int k) const { return entry_[std::size_t(k)]; }
  int out(int k) const { return entry_[std::size_t(k)] ^ 1; }
  int after(int k) const { return k + 1 == n() ? 0 : k + 1; }
  int before(int k) const { return k == 0 ? n() - 1 : k - 1; }
  void reverse(int from, int to);
  void settle();
  bool improve_at(int piece);
  bool try_two_opt(int piece);
  bool try_or_opt(int piece);
  void touch(int position);

  std::size_t ends_;
  std::vector<double> cost_of_;
  std::vector<std::vector<int>> near_;  ///< of each end: ends of other pieces by the join's cost
  std::vector<int> entry_;
  std::vector<int> position_;  ///< of each piece
  std::vector<int> queue_;
  std::vector<char> queued_;
  double cost_ = 0;
};

/// Lower bound of the cost of all closed tours: the greatest 1-tree that Held and Karp's ascent
/// finds with the pieces as forced edges.
ALTIPLAN_API double tour_bound(std::size_t pieces, const std::vector<double>& cost, double upper,
                               int steps);
}  // namespace altiplan::kit
