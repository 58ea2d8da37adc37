// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "altiplan/tuner.hpp"

namespace altiplan::kit {

/// A tuner's space mapped to the unit cube: a search moves through positions, each number from 0 to
/// 1, and evaluates the corresponding points.
class ALTIPLAN_API TuningSpace {
 public:
  explicit TuningSpace(std::vector<Dimension> space);

  std::size_t dimensions() const { return space_.size(); }
  /// Maps numbers outside of groups linearly to their ranges. Those of a group are scaled likewise
  /// and then divided by their sum; a number that would leave its bounds stays at its bound, and
  /// the others share the rest. A group whose numbers are all 0 has equal weights, as far as bounds
  /// allow. Sums are 1 to within a few units in the last place.
  std::vector<double> point(std::span<const double> position) const;

 private:
  void normalise(const std::vector<std::size_t>& group, std::vector<double>& point) const;

  std::vector<Dimension> space_;
  std::vector<std::vector<std::size_t>> groups_;  ///< dimension indices of each group
};
}  // namespace altiplan::kit
