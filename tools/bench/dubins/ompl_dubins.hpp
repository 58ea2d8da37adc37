// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "altiplan/leg.hpp"

namespace altiplan::bench {

/// OMPL's DubinsStateSpace; the states of the pairs are made beforehand.
class OmplDubins {
 public:
  OmplDubins(double radius, const std::vector<std::pair<Pose, Pose>>& pairs);
  ~OmplDubins();
  double length(std::size_t pair) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace altiplan::bench
