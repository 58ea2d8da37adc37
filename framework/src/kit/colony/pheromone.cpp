// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/colony/pheromone.hpp"

#include <algorithm>

namespace altiplan::kit {

void Pheromone::reset(std::size_t places, double evaporation, double alpha) {
  amounts_.assign(places, 1.0);
  remains_ = 1 - evaporation;
  per_unit_ = 1;
  largest_ = 1;
  all_changed_ = false;
  min_amount_ = std::pow(10, -std::min(140 / std::max(alpha, 1e-9), 100.0));
}

void Pheromone::evaporate() {
  constexpr double kMax = 1e100;
  if (per_unit_ <= remains_ * kMax) {
    per_unit_ /= remains_;
    return;
  }
  const double left = remains_ / per_unit_;
  for (double& amount : amounts_) {
    amount *= left;
  }
  largest_ *= left;
  per_unit_ = 1;
  all_changed_ = true;
}

bool Pheromone::settle() {
  if (!all_changed_ && largest_ * min_amount_ < 1) {
    return false;
  }
  all_changed_ = false;
  double factor = 1;
  if (largest_ > 0) {  // 0 where nothing remains and nothing was deposited
    factor = 1 / largest_;
    largest_ = 1;
    // Relative to a unit of this size, existing values are negligible.
    per_unit_ = std::min(per_unit_ * factor, 1e50);
  }
  for (double& amount : amounts_) {
    amount = std::max(amount * factor, min_amount_);
  }
  return true;
}
}  // namespace altiplan::kit
