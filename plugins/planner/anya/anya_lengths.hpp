// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "anya_parts.hpp"

namespace altiplan::anya {

/// Lengths of routes if no cell were blocked, in metres.
class Lengths {
 public:
  /// Both must outlive it.
  Lengths(const Level& level, const std::vector<Target>& targets)
      : level_(level), targets_(targets) {}

  /// From a point to the nearest target.
  double to_target(const Point& p) const {
    double minimum = std::numeric_limits<double>::infinity();
    for (const Target& target : targets_) {
      minimum = std::min(minimum, target.g + level_.length(target.at.x - p.x, target.at.y - p.y));
    }
    return minimum;
  }

  /// From a node's root over its interval.
  double estimate(const Root& root, const Node& node) const {
    if (node.kind == Node::Kind::flat) {
      return level_.length(node.from - root.x, 0) + to_target({node.from, double(node.line)});
    }
    if (node.kind == Node::Kind::goal) {
      const Target& target = targets_[node.target];
      return target.g + (node.bends ? over(root, node.from, node.line, target.at)
                                    : level_.length(target.at.x - root.x, target.at.y - root.y));
    }
    double minimum = std::numeric_limits<double>::infinity();
    for (const Target& target : targets_) {
      // A target on the root's side of the line is mirrored in it.
      const bool behind = (target.at.y < node.line) == (root.y < node.line);
      const Point at{target.at.x, behind ? 2 * node.line - target.at.y : target.at.y};
      const double x = crossing(root, node.line, at);
      const double length = x < node.from ? over(root, node.from, node.line, at)
                            : x > node.to ? over(root, node.to, node.line, at)
                                          : level_.length(at.x - root.x, at.y - root.y);
      minimum = std::min(minimum, target.g + length);
    }
    return minimum;
  }

  /// Where the straight line from the root to a point crosses a line between them.
  static double crossing(const Root& root, int line, const Point& to) {
    return root.x + (to.x - root.x) * ((line - root.y) / (to.y - root.y));
  }

 private:
  /// From the root over a point of a line to another point.
  double over(const Root& root, double x, int line, const Point& to) const {
    return level_.length(x - root.x, line - root.y) + level_.length(to.x - x, to.y - line);
  }

  const Level& level_;
  const std::vector<Target>& targets_;
};
}  // namespace altiplan::anya
