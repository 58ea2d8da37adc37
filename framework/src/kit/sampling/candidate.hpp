// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tuple>

#include "altiplan/kit/sampling/leg_tree.hpp"

namespace altiplan::kit {

/// A possible parent of a node; those that come first are tried first.
struct Candidate {
  LegTree::Node node;
  double metres;  ///< of the edge from it
  double cost;    ///< of the path through it
  bool exact;     ///< false: lower bounds

  friend bool operator<(const Candidate& a, const Candidate& b) {
    return std::tuple(a.cost, !a.exact, a.node) < std::tuple(b.cost, !b.exact, b.node);
  }
};
}  // namespace altiplan::kit
