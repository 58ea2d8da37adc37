// SPDX-License-Identifier: Apache-2.0
#include "flown.hpp"

#include <algorithm>

namespace altiplan::cover {

double Flown::seconds(const LegTime& time) const {
  double sum = 0;
  for (std::size_t i = 0; i < legs(); ++i) {
    sum += time.between(points[i], points[i + 1]);
  }
  return sum;
}

void Flown::drop_repeats() {
  for (std::size_t i = 1; i < points.size();) {
    if ((points[i] - points[i - 1]).norm() < 1e-6) {
      const bool is_last = i + 1 == points.size();
      points.erase(points.begin() + std::ptrdiff_t(is_last ? i - 1 : i));
      is_row.erase(is_row.begin() + std::ptrdiff_t(i) - 1);
    } else {
      ++i;
    }
  }
}

void Flown::replace(std::size_t i, std::size_t j, const Ring2& by) {
  const auto first = std::ptrdiff_t(i);
  const auto last = std::ptrdiff_t(j) + 1;
  std::vector<char> kinds(by.size() + 1, 0);
  const char before = is_row[i - 1];
  const char after = is_row[j];
  kinds.front() = before;
  kinds.back() = by.empty() ? char(before || after) : after;
  points.erase(points.begin() + first, points.begin() + last);
  points.insert(points.begin() + first, by.begin(), by.end());
  is_row.erase(is_row.begin() + first - 1, is_row.begin() + last);
  is_row.insert(is_row.begin() + first - 1, kinds.begin(), kinds.end());
}
}  // namespace altiplan::cover
