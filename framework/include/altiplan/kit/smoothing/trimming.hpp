// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "altiplan/params.hpp"

/// \file Trimming of a route in several rounds. Li Rongsheng et al.: Path planning for flight
/// vehicles based on improved ACO (paper 004), section 2.3 and eq. (11).
namespace altiplan::kit {

struct TrimParams {
  int longest_stride = 10;
  int shortest_stride = 4;
  double decay = 0.8;

  void describe(Fields& f) {
    f("longest_stride", longest_stride)
        .range(2, 100'000)
        .doc("stride of the first round in nodes, paper 004 l_c,max");
    f("shortest_stride", shortest_stride)
        .range(2, 100'000)
        .doc("minimum stride, paper 004 l_c,min");
    f("decay", decay)
        .range(0.01, 0.99)
        .doc("factor of the stride from round to round, sigma of eq. (11)");
    f.check(shortest_stride <= longest_stride, "shortest_stride must not exceed longest_stride");
  }

  /// Strides of the rounds: floor(longest * decay^v) while that is at least the shortest, each
  /// once.
  std::vector<std::size_t> strides() const {
    std::vector<std::size_t> all;
    double stride = longest_stride;
    for (; std::floor(stride) >= shortest_stride; stride *= decay) {
      if (all.empty() || std::size_t(stride) < all.back()) {
        all.push_back(std::size_t(stride));
      }
    }
    return all;
  }
};

/// One round: from each node kept, a straight leg to the node one stride ahead (or to the last)
/// replaces the nodes between if `is_free(from, to)` is true; else the next node is kept too.
/// `from` and `to` are indices of `nodes`; the node before `from` is the one kept before it, and
/// the nodes after `to` are unchanged.
template <class Node, class IsFree>
void trim(std::vector<Node>& nodes, std::size_t stride, const IsFree& is_free) {
  if (nodes.empty()) {
    return;
  }
  std::size_t kept = 0;
  for (std::size_t at = 0; at + 1 < nodes.size();) {
    const std::size_t ahead = std::min(at + stride, nodes.size() - 1);
    at = ahead > at + 1 && is_free(kept, ahead) ? ahead : at + 1;
    nodes[++kept] = nodes[at];
  }
  nodes.resize(kept + 1);
}
}  // namespace altiplan::kit
