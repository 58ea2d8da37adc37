// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/sampling/tree_time.hpp"

#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/measures.hpp"

namespace altiplan::kit {

using Node = LegTree::Node;

namespace {
/// Seconds, in the time of request.start, at which a vehicle reaches the node from the root.
double time_at(const LegTree& tree, Node node, const Request& request) {
  double time_s = request.start.time_s;
  for (; tree.parent(node) != LegTree::kNone; node = tree.parent(node)) {
    time_s += leg_duration(Leg::straight(tree.point(tree.parent(node)), tree.point(node)), request);
  }
  return time_s;
}
}  // namespace

bool leg_in_time(const LegTree& tree, Node node, const Vec3& to, const Request& request) {
  const Leg leg = Leg::straight(tree.point(node), to);
  return meets_moving(leg, time_at(tree, node, request), request) == nullptr;
}

bool branch_in_time(const LegTree& tree, Node node, Node parent, const Request& request) {
  struct Departure {
    Node from;
    Node to;
    double time_s;
  };
  std::vector<Departure> open{{parent, node, time_at(tree, parent, request)}};
  while (!open.empty()) {
    const auto [from, to, time_s] = open.back();
    open.pop_back();
    const Leg leg = Leg::straight(tree.point(from), tree.point(to));
    if (meets_moving(leg, time_s, request) != nullptr) {
      return false;
    }
    const double then_s = time_s + leg_duration(leg, request);
    for (Node child = tree.first_child(to); child != LegTree::kNone; child = tree.sibling(child)) {
      open.push_back({to, child, then_s});
    }
  }
  return true;
}
}  // namespace altiplan::kit
