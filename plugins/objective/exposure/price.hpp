// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace exposure {

/// What a metre costs by the value of a field: linear between pairs of both.
struct Price {
  std::vector<std::array<double, 2>> pairs;  ///< by ascending value; none: the value itself

  bool is_in_order() const {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (!(pairs[i][1] >= 0) || (i > 0 && !(pairs[i][0] > pairs[i - 1][0]))) {
        return false;
      }
    }
    return true;
  }

  /// Of a value that is a number, which may be infinite.
  double operator()(double value) const {
    if (pairs.empty()) {
      return value;
    }
    const auto next =
        std::find_if(pairs.begin(), pairs.end(), [&](const auto& pair) { return pair[0] > value; });
    if (next == pairs.begin()) {
      return pairs.front()[1];
    }
    const auto& [before, price] = *(next - 1);
    return next == pairs.end()
               ? price
               : price + (value - before) / ((*next)[0] - before) * ((*next)[1] - price);
  }

  void apply(std::vector<float>& values) const {
    for (float& value : values) {
      value = std::isnan(value) ? value : float((*this)(double(value)));
    }
  }
};
}  // namespace exposure
