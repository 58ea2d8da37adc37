// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "altiplan/route.hpp"

namespace altiplan::kit {

/// Trees of points joined by legs, as sampling planners grow them: each point has a parent, or is a
/// root. Nodes are numbered 0, 1, 2 … as added; a number is never reused.
class LegTree {
 public:
  using Node = std::int32_t;
  static constexpr Node kNone = -1;

  void clear() {
    points_.clear();
    links_.clear();
  }
  void reserve(std::size_t count) {
    points_.reserve(count);
    links_.reserve(count);
  }
  /// Number of nodes added.
  std::size_t size() const { return points_.size(); }

  /// Adds a node below `parent`, a root if that is kNone.
  Node add(const Vec3& p, Node parent) {
    const Node node = Node(points_.size());
    points_.push_back(p);
    links_.push_back({});
    hang(node, parent);
    return node;
  }
  const Vec3& point(Node node) const { return points_[std::size_t(node)]; }
  Node parent(Node node) const { return links_[std::size_t(node)].parent; }
  Node first_child(Node node) const { return links_[std::size_t(node)].child; }
  /// The next child of the same parent.
  Node sibling(Node node) const { return links_[std::size_t(node)].next; }

  /// Moves a node, with its subtree, to another parent (outside that subtree), or makes it a root.
  void move(Node node, Node parent) {
    Links& links = links_[std::size_t(node)];
    if (links.previous != kNone) {
      links_[std::size_t(links.previous)].next = links.next;
    } else if (links.parent != kNone) {
      links_[std::size_t(links.parent)].child = links.next;
    }
    if (links.next != kNone) {
      links_[std::size_t(links.next)].previous = links.previous;
    }
    hang(node, parent);
  }

  /// The node and its subtree, each after its parent.
  void below(Node node, std::vector<Node>& found) const {
    found.assign(1, node);
    for (std::size_t i = 0; i < found.size(); ++i) {
      for (Node child = first_child(found[i]); child != kNone; child = sibling(child)) {
        found.push_back(child);
      }
    }
  }

  /// The approach to the node by the legs from `root`, itself reached by `to_root`; from the root
  /// of another tree, which has no known approach.
  std::optional<Approach> approach(Node node, Node root,
                                   const std::optional<Approach>& to_root) const {
    const Node last = parent(node);
    if (node == root || last == kNone) {
      return node == root ? to_root : std::nullopt;
    }
    Node n = last;
    for (; n != root && parent(n) != kNone; n = parent(n)) {
      if (const Vec3 leg = point(n) - point(parent(n)); has_heading(leg)) {
        return Approach(point(last), leg);
      }
    }
    const bool is_known = n == root && to_root;
    return Approach(point(last), is_known ? to_root->heading_at(point(n)) : Vec3::Zero());
  }

  /// The points from its root to the node.
  Polyline way_to(Node node) const {
    Polyline way;
    for (; node != kNone; node = parent(node)) {
      way.push_back(point(node));
    }
    return {way.rbegin(), way.rend()};
  }

 private:
  struct Links {
    Node parent = kNone;
    Node child = kNone;     ///< the last one added
    Node next = kNone;      ///< child of the same parent
    Node previous = kNone;  ///< the reverse link
  };

  void hang(Node node, Node parent) {
    Links& links = links_[std::size_t(node)];
    links.parent = parent;
    links.previous = kNone;
    links.next = kNone;
    if (parent != kNone) {
      Links& above = links_[std::size_t(parent)];
      links.next = above.child;
      if (above.child != kNone) {
        links_[std::size_t(above.child)].previous = node;
      }
      above.child = node;
    }
  }

  std::vector<Vec3> points_;
  std::vector<Links> links_;  ///< one entry per point
};
}  // namespace altiplan::kit
