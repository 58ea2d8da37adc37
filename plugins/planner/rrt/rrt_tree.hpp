// SPDX-License-Identifier: Apache-2.0
// The tree of `rrt`: legs, an index of the nodes that may grow, and what has been cut off. Nodes
// are never renumbered: a node that is kept through changes keeps its index.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "altiplan/kit/sampling/kd_tree.hpp"
#include "altiplan/kit/sampling/leg_tree.hpp"
#include "altiplan/trace.hpp"

namespace altiplan::rrt {

using Node = kit::LegTree::Node;
inline constexpr Node kNone = kit::LegTree::kNone;

class Tree {
 public:
  enum class Place : std::uint8_t {
    growing,  ///< may be chosen
    resting,  ///< failed too often
    end,      ///< at the goal
    loose,    ///< cut off, until the tree grows near
    removed,
  };
  static constexpr std::size_t kBytesPerNode = 160;

  void clear(Trace* trace) {
    trace_ = trace;
    legs_.clear();
    growing_.clear();
    marks_.clear();
    resting_.clear();
    counts_ = {};
    longest_leg_ = 0;
    has_woken_ = false;
    clear_loose();
  }

  /// Number of indices assigned.
  std::size_t size() const { return legs_.size(); }
  std::size_t count(Place place) const { return counts_[std::size_t(place)]; }
  /// Nodes that are not removed.
  std::size_t in_use() const { return size() - count(Place::removed); }
  const Vec3& point(Node node) const { return legs_.point(node); }
  Node parent(Node node) const { return legs_.parent(node); }
  Place place(Node node) const { return marks_[std::size_t(node)].place; }
  bool is_rooted(Node node) const { return place(node) < Place::loose; }
  const kit::LegTree& legs() const { return legs_; }
  Polyline way_to(Node node) const { return legs_.way_to(node); }
  /// Approach of the vehicle to a node from `root`, which it approaches by `to_root`.
  std::optional<Approach> approach(Node node, Node root,
                                   const std::optional<Approach>& to_root) const {
    return legs_.approach(node, root, to_root);
  }
  /// Upper bound of the length of every leg.
  double longest_leg() const { return longest_leg_; }

  Node add(const Vec3& p, Node parent, Place place = Place::growing) {
    const Node node = legs_.add(p, parent);
    growing_.insert(p);  // under the same index
    marks_.push_back({});
    ++counts_[std::size_t(Place::growing)];
    put(node, place);
    note_leg(node);
    note(TraceEvent::Kind::added, node);
    return node;
  }

  /// The growing node q with minimum w_random |q - random| + w_goal |q - goal| (paper 000, eqs. (2)
  /// to (4)).
  Node choose(const Vec3& random, double w_random, const Vec3& goal, double w_goal) const {
    return Node(w_goal == 0 ? growing_.nearest(random)
                            : growing_.min_sum(random, w_random, goal, w_goal));
  }
  /// The growing node nearest to p.
  Node nearest(const Vec3& p) const { return Node(growing_.nearest(p)); }

  bool has_grown_to_goal(Node node) const { return marks_[std::size_t(node)].grown_to_goal; }
  void set_grown_to_goal(Node node) { marks_[std::size_t(node)].grown_to_goal = true; }

  /// Counts a failed extension. A node that has `maximum` of them rests until none is left to grow.
  void count_failure(Node node, int maximum) {
    if (++marks_[std::size_t(node)].failures < maximum) {
      return;
    }
    put(node, Place::resting);
    resting_.push_back(node);
    if (count(Place::growing) == 0) {
      wake();
    }
  }
  /// True if all nodes have rested.
  bool has_woken() const { return has_woken_; }
  void wake() {
    has_woken_ = true;
    for (const Node node : resting_) {
      if (place(node) == Place::resting) {
        marks_[std::size_t(node)].failures = 0;
        put(node, Place::growing);
      }
    }
    resting_.clear();
  }

  /// Attaches a node, with all below it, to another parent; positions are unchanged.
  void move(Node node, Node parent) {
    legs_.move(node, parent);
    if (parent != kNone) {
      note_leg(node);
      note(TraceEvent::Kind::rewired, node);
    }
  }
  /// The node and all below it, each after its parent.
  const std::vector<Node>& below(Node node) {
    legs_.below(node, below_);
    return below_;
  }
  /// A copy of the children of a node, as some may be moved meanwhile.
  std::vector<Node> children(Node node) const {
    std::vector<Node> found;
    for (Node child = legs_.first_child(node); child != kNone; child = legs_.sibling(child)) {
      found.push_back(child);
    }
    return found;
  }

  void put(Node node, Place place) {
    Mark& mark = marks_[std::size_t(node)];
    if (mark.place == place) {
      return;
    }
    if (mark.place == Place::growing) {
      growing_.erase(std::size_t(node));
    } else if (mark.place == Place::loose) {
      loose_.erase(std::size_t(mark.loose));
    }
    if (place == Place::growing) {
      growing_.restore(std::size_t(node));
    } else if (place == Place::loose) {
      mark.loose = std::int32_t(loose_.insert(point(node)));
      loose_nodes_.push_back(node);
    } else if (place == Place::removed) {
      note(TraceEvent::Kind::removed, node);
    }
    --counts_[std::size_t(mark.place)];
    ++counts_[std::size_t(place)];
    mark.place = place;
    if (count(Place::loose) == 0) {
      clear_loose();
    }
  }

  /// Removes the loose nodes, except those of one branch unless that is kNone.
  void remove_loose(Node branch) {
    std::vector<Node> kept;
    if (branch != kNone) {
      kept = below(branch);
      std::sort(kept.begin(), kept.end());
    }
    loose_.within(Box{Vec3::Constant(-kInfinity), Vec3::Constant(kInfinity)}, numbers_);
    for (const std::size_t number : numbers_) {
      const Node node = loose_nodes_[number];
      if (!std::binary_search(kept.begin(), kept.end(), node)) {
        put(node, Place::removed);
      }
    }
  }

  /// Nodes in the box that are not removed, except the end; `found` is cleared first.
  void within(const Box& box, std::vector<Node>& found) {
    growing_.within(box, numbers_);
    found.assign(numbers_.begin(), numbers_.end());
    loose_.within(box, numbers_);
    for (const std::size_t number : numbers_) {
      found.push_back(loose_nodes_[number]);
    }
    std::erase_if(resting_, [&](Node node) { return place(node) != Place::resting; });
    for (const Node node : resting_) {
      if (box.contains(point(node))) {
        found.push_back(node);
      }
    }
  }
  /// Loose nodes at most `radius` from p; `found` is cleared first.
  void loose_within(const Vec3& p, double radius, std::vector<Node>& found) {
    found.clear();
    loose_.within(p, radius, numbers_);
    for (const std::size_t number : numbers_) {
      found.push_back(loose_nodes_[number]);
    }
  }

 private:
  struct Mark {
    std::uint16_t failures = 0;
    bool grown_to_goal = false;
    Place place = Place::growing;
    std::int32_t loose = 0;  ///< index in loose_
  };

  void clear_loose() {
    loose_.clear();
    loose_nodes_.clear();
  }
  void note_leg(Node node) {
    if (parent(node) != kNone) {
      longest_leg_ = std::max(longest_leg_, (point(node) - point(parent(node))).norm());
    }
  }
  void note(TraceEvent::Kind kind, Node node) const {
    if (trace_ != nullptr) {
      trace_->add({kind, node, parent(node), point(node), 0});
    }
  }

  kit::LegTree legs_;
  kit::KdTree growing_;
  kit::KdTree loose_;
  std::vector<Node> loose_nodes_;  ///< by index in loose_
  std::vector<Mark> marks_;        ///< one entry per node
  std::vector<Node> resting_;      ///< may contain nodes that have since changed state
  std::array<std::size_t, 5> counts_{};
  double longest_leg_ = 0;
  bool has_woken_ = false;
  Trace* trace_ = nullptr;
  std::vector<Node> below_;
  std::vector<std::size_t> numbers_;
};
}  // namespace altiplan::rrt
