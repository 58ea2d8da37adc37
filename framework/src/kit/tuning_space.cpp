// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/tuning_space.hpp"

#include <algorithm>
#include <map>

namespace altiplan::kit {

TuningSpace::TuningSpace(std::vector<Dimension> space) : space_(std::move(space)) {
  std::map<int, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < space_.size(); ++i) {
    if (space_[i].group >= 0) {
      groups[space_[i].group].push_back(i);
    }
  }
  for (auto& [number, members] : groups) {
    groups_.push_back(std::move(members));
  }
}

std::vector<double> TuningSpace::point(std::span<const double> position) const {
  std::vector<double> point;
  for (std::size_t i = 0; i < space_.size(); ++i) {
    const Dimension& d = space_[i];
    point.push_back(std::clamp(d.min + position[i] * (d.max - d.min), d.min, d.max));
  }
  for (const std::vector<std::size_t>& group : groups_) {
    normalise(group, point);
  }
  return point;
}

/// Finds the factor s for which the sum of clamp(s * weight, min, max) is 1. The sum is piecewise
/// linear in s and increasing, with breaks where a weight meets one of its bounds.
void TuningSpace::normalise(const std::vector<std::size_t>& group,
                            std::vector<double>& point) const {
  double reach = 0;  // upper bound of the sum of the weights that can grow
  for (const std::size_t i : group) {
    reach += point[i] > 0 ? space_[i].max : space_[i].min;
  }
  std::vector<double> knots{0};
  for (const std::size_t i : group) {
    // A weight of 0 stays 0, unless the others alone cannot reach the sum.
    constexpr double kSeed = 1e-9;
    point[i] = reach < 1 ? std::max(point[i], kSeed) : point[i];
    if (point[i] > 0) {
      knots.push_back(space_[i].min / point[i]);
      knots.push_back(space_[i].max / point[i]);
    }
  }
  std::sort(knots.begin(), knots.end());
  const auto scaled = [&](std::size_t i, double s) {
    return std::clamp(s * point[i], space_[i].min, space_[i].max);
  };
  const auto sum = [&](double s) {
    double all = 0;
    for (const std::size_t i : group) {
      all += scaled(i, s);
    }
    return all;
  };
  const auto end =
      std::find_if(knots.begin() + 1, knots.end() - 1, [&](double knot) { return sum(knot) >= 1; });
  const double middle = *(end - 1) + (*end - *(end - 1)) / 2;
  double fixed = 0;
  double free = 0;
  for (const std::size_t i : group) {
    const bool at_bound = scaled(i, middle) != middle * point[i];
    fixed += at_bound ? scaled(i, middle) : 0;
    free += at_bound ? 0 : point[i];
  }
  const double s = free > 0 ? (1 - fixed) / free : middle;
  for (const std::size_t i : group) {
    point[i] = scaled(i, s);
  }
}
}  // namespace altiplan::kit
