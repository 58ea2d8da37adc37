// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/request.hpp"

namespace altiplan::bench {

/// Towers on three tenths of the ground of 80 x 80 x 100 cells of 1 m, and queries across it: free
/// cells' centres at least half the diagonal apart; `low`: both ends in the lowest fifth, most
/// of them with towers in the straight line.
class City {
 public:
  City(bool low, std::size_t queries);
  const std::vector<Request>& queries() const { return queries_; }
  /// Queries whose straight leg is free.
  std::size_t open() const { return open_; }

 private:
  std::vector<Request> queries_;
  std::size_t open_ = 0;
};
}  // namespace altiplan::bench
