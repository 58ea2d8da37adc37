// SPDX-License-Identifier: Apache-2.0
#include "altiplan/route.hpp"

namespace altiplan {

double length(const Route& route) {
  double sum = 0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    sum += (route[i] - route[i - 1]).norm();
  }
  return sum;
}

Route without_repeats(const Route& route) {
  Route out;
  for (const Vec3& p : route) {
    if (out.empty() || p != out.back()) {
      out.push_back(p);
    }
  }
  return out;
}
}  // namespace altiplan
