// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "altiplan/request.hpp"
#include "anya_lengths.hpp"
#include "anya_parts.hpp"

namespace altiplan::anya {

/// One search from the starts to the nearest target.
class Search {
 public:
  enum class End { found, exhausted, spent };

  /// Numbers of intervals.
  struct Effort {
    std::uint64_t expanded = 0;
    std::int64_t generated = 0;
  };

  /// All arguments must outlive the search; `effort` counts on, and the budget with it.
  Search(const Level& level, Corner rule, const std::vector<Target>& targets, BudgetWatch& watch,
         std::size_t max_bytes, Memory& memory, Effort& effort)
      : level_(level),
        rule_(rule),
        targets_(targets),
        lengths_(level, targets),
        watch_(watch),
        max_bytes_(max_bytes),
        memory_(memory),
        effort_(effort),
        roots_(memory.roots),
        fresh_(memory.successors) {
    memory_.root_at.reset(level.corners());
    roots_.clear();
    memory_.nodes.clear();
    memory_.unused.clear();
    fresh_.clear();
    const double across = level.length(level.width(), level.height());
    tie_ = 1e-13 * across;
    memory_.open.clear(kQuanta * tie_);
  }

  /// Adds a start, in or beside a free cell, that lies `g` metres along the route.
  void start(const Point& at, double g) {
    const std::uint32_t root = add_root({at.x, at.y, g, kNone, kNoCorner});
    const int row = int(at.y);
    const bool on_line = at.y == row;
    for (int side = on_line ? row - 1 : row; side <= row; ++side) {
      const std::optional<Run> run = level_.run_at(side, at.x);
      if (!run) {
        continue;
      }
      reach_targets(root, side, run->left, run->right);
      if (at.y > side) {
        enter(root, -1, side, *run);
      }
      if (at.y < side + 1) {
        enter(root, 1, side + 1, *run);
      }
    }
    if (on_line) {
      flat<true>(root, row, int(at.x));
      flat<false>(root, row, upper(at.x));
    }
    push_all();
  }

  template <class Expanded>
  End run(const Expanded& expanded_root) {
    while (!memory_.open.empty()) {
      const kit::OpenList::Entry entry = memory_.open.pop();
      Node node = memory_.take(entry.node);
      if (!is_best(node.root)) {
        continue;
      }
      if (watch_.spent(effort_.expanded, memory_.open.size()) || memory_full()) {
        return End::spent;
      }
      if (node.kind == Node::Kind::goal) {
        goal_ = node;
        return End::found;
      }
      expanded_root(node.root, entry.f * kQuanta * tie_);
      do {
        if (watch_.spent(effort_.expanded, memory_.open.size())) {
          return End::spent;
        }
        ++effort_.expanded;
        expand(node);
      } while (intermediate(node));
      push_all();
    }
    return End::exhausted;
  }

  const Node& goal() const { return goal_; }
  const Root& root(std::uint32_t number) const { return roots_[number]; }
  /// The root with the least straight distance to a target.
  const Root& nearest() const { return roots_[nearest_]; }
  bool memory_full() const {
    return double(level_.corners()) * Memory::kBytesPerCell + double(memory_.bytes()) >
           double(max_bytes_);
  }
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

 private:
  static constexpr double kQuanta = 10;  ///< of tie_, by which f is compared
  static constexpr std::size_t kNoCorner = ~std::size_t{0};

  /// Root history: a path over a corner that another path reaches sooner is none of the shortest.
  bool is_best(std::uint32_t root) const {
    const std::size_t corner = roots_[root].corner;
    return corner == kNoCorner || memory_.root_at[corner] == root + 1;
  }

  std::uint32_t add_root(const Root& root) {
    roots_.push_back(root);
    const auto number = std::uint32_t(roots_.size() - 1);
    if (const double left = lengths_.to_target({root.x, root.y}); left < nearest_left_) {
      nearest_left_ = left;
      nearest_ = number;
    }
    return number;
  }

  /// The corner as a root, reached from `parent`; nothing if another path there is as short. Among
  /// equals only the first counts: what the other could add turns the wrong way for the first, so
  /// it is none of the shortest.
  std::optional<std::uint32_t> turn(std::uint32_t parent, int x, int line) {
    const Root& from = roots_[parent];
    const double g = from.g + level_.length(x - from.x, line - from.y);
    const std::size_t corner = level_.corner(x, line);
    const std::uint32_t known = memory_.root_at[corner];
    if (known != 0 && g >= roots_[known - 1].g - tie_) {
      return std::nullopt;
    }
    const std::uint32_t root = add_root({double(x), double(line), g, parent, corner});
    memory_.root_at.at(corner) = root + 1;
    return root;
  }

  void expand(const Node& node) {
    if (node.kind == Node::Kind::flat) {
      if (node.ahead) {
        turn_off<true>(node);
      } else {
        turn_off<false>(node);
      }
      return;
    }
    const Root root = roots_[node.root];
    const int way = node.line > root.y ? 1 : -1;
    const int next = node.line + way;
    const Run run = level_.run(row_beyond(node.line, way), int(node.from));
    const double from = node.left.at(root, next);
    const double to = node.right.at(root, next);
    // What the root sees of the next line.
    if (from < run.right && to > run.left) {
      Node seen = node;
      seen.line = next;
      seen.cut_left(root, from, run.left, node.left);
      seen.cut_right(root, to, run.right, node.right);
      project(seen, way);
    }
    around<false>(node, way, run, from);
    around<true>(node, way, run, to);
  }

  static int row_beyond(int line, int way) { return way > 0 ? line : line - 1; }

  /// The points that a node's root does not see: they are reached around the corner at an end of
  /// the interval, if there is one. `edge`: where the ray through that end crosses the next line.
  template <bool kRight>
  void around(const Node& node, int way, const Run& run, double edge) {
    const double end = kRight ? node.to : node.from;
    const int x = int(end);
    if (x != end) {
      return;
    }
    const bool blocked_before = level_.blocked(row_beyond(node.line, -way), kRight ? x : x - 1);
    const bool blocked_beyond = x == (kRight ? run.right : run.left);
    // A blocked cell of the row before ends there, or one of the row beyond, and the path bends
    // toward it.
    const bool bends_beyond = kRight ? edge < end : edge > end;
    if (blocked_beyond ? blocked_before || !bends_beyond : !blocked_before) {
      return;
    }
    const std::optional<std::uint32_t> number = turn(node.root, x, node.line);
    if (!number) {
      return;
    }
    if (kRight ? edge < run.right : edge > run.left) {
      const Root& root = roots_[*number];
      const Root& parent = roots_[node.root];
      const Ray straight{root.x - parent.x, root.y - parent.y};
      Node hidden;
      hidden.root = *number;
      hidden.line = node.line + way;
      hidden.cut_left(root, kRight ? edge : run.left, run.left, straight);
      hidden.cut_right(root, kRight ? run.right : edge, run.right, straight);
      if (kRight) {
        hidden.right = Ray{run.right - root.x, double(way)};
      } else {
        hidden.left = Ray{run.left - root.x, double(way)};
      }
      project(hidden, way);
    }
    if (!blocked_beyond) {
      flat<kRight>(*number, node.line, x);
    }
  }

  /// Splits an interval seen from the row before its line into those beside the runs of the row
  /// beyond.
  void project(const Node& whole, int way) {
    const int row = row_beyond(whole.line, way);
    const Root root = roots_[whole.root];
    const int limit = upper(whole.to);
    int x = level_.first_free(row, int(whole.from), limit);
    while (x < limit) {
      const int end = level_.first_blocked(row, x);
      Node node = whole;
      node.cut_left(root, whole.from, x, whole.left);
      node.cut_right(root, whole.to, end, whole.right);
      add_cone(node, row);
      x = level_.first_free(row, end, limit);
    }
    if (rule_ == Corner::any) {
      squeeze<false>(whole, way, row);
      squeeze<true>(whole, way, row);
    }
  }

  /// Passes between two blocked cells that meet at an end of the interval.
  template <bool kRight>
  void squeeze(const Node& node, int way, int row) {
    const double end = kRight ? node.to : node.from;
    const int x = int(end);
    const int inner = kRight ? x - 1 : x;
    const int outer = kRight ? x : x - 1;
    if (x != end || !level_.blocked(row_beyond(node.line, -way), outer) ||
        !level_.blocked(row, inner) || level_.blocked(row, outer)) {
      return;
    }
    if (const std::optional<std::uint32_t> root = turn(node.root, x, node.line)) {
      reach_beside<kRight>(*root, way, x);
      flat<kRight>(*root, node.line, x);
    }
  }

  /// From a corner into the row beyond it, on the side of kRight.
  template <bool kRight>
  void reach_beside(std::uint32_t root, int way, int x) {
    const int line = int(roots_[root].y);
    const int row = row_beyond(line, way);
    Run part = level_.run(row, kRight ? x : x - 1);
    (kRight ? part.left : part.right) = x;
    reach_targets(root, row, part.left, part.right);
    enter(root, way, line + way, part);
  }

  /// From a root in or beside a row: all points of a line between the row's ends are visible.
  void enter(std::uint32_t number, int way, int line, const Run& run) {
    const Root& root = roots_[number];
    Node node;
    node.root = number;
    node.line = line;
    node.from = run.left;
    node.to = run.right;
    node.left = {run.left - root.x, line - root.y};
    node.right = {run.right - root.x, line - root.y};
    project(node, way);
  }

  /// A path that runs along a line, from x on.
  template <bool kAhead>
  void flat(std::uint32_t root, int line, int x) {
    int end = x;
    const std::optional<int> corner = level_.next_turn<kAhead>(line, x, rule_, end);
    for (std::uint32_t t = 0; t < targets_.size(); ++t) {
      const Point& at = targets_[t].at;
      if (at.y == line && (kAhead ? x <= at.x && at.x <= end : end <= at.x && at.x <= x)) {
        add_goal(root, t);
      }
    }
    if (corner) {
      Node node;
      node.kind = Node::Kind::flat;
      node.root = root;
      node.line = line;
      node.from = *corner;
      node.ahead = kAhead;
      fresh_.push_back(node);
    }
  }

  /// The path of a flat node turns off around the corner, and goes on.
  template <bool kAhead>
  void turn_off(const Node& node) {
    const int x = int(node.from);
    const std::optional<std::uint32_t> root = turn(node.root, x, node.line);
    if (!root) {
      return;
    }
    const bool above = level_.blocked(node.line, kAhead ? x - 1 : x);
    reach_beside<kAhead>(*root, above ? 1 : -1, x);
    flat<kAhead>(node.root, node.line, x);
  }

  void add_cone(const Node& node, int row) {
    bool all = true;
    for (std::uint32_t t = 0; t < targets_.size(); ++t) {
      const Target& target = targets_[t];
      if (target.beside(row, node.from, node.to)) {
        add_goal(node, t);
      } else {
        all = false;
      }
    }
    if (!all) {
      fresh_.push_back(node);
    }
  }

  void reach_targets(std::uint32_t root, int row, double from, double to) {
    for (std::uint32_t t = 0; t < targets_.size(); ++t) {
      if (targets_[t].beside(row, from, to)) {
        add_goal(root, t);
      }
    }
  }

  void add_goal(std::uint32_t root, std::uint32_t target) {
    Node node;
    node.kind = Node::Kind::goal;
    node.root = root;
    node.target = target;
    fresh_.push_back(node);
  }

  void add_goal(Node node, std::uint32_t target) {
    const Root& root = roots_[node.root];
    const Point& at = targets_[target].at;
    const double x = Lengths::crossing(root, node.line, at);
    node.kind = Node::Kind::goal;
    node.target = target;
    node.bends = x < node.from || x > node.to;
    node.from = x < node.from ? node.from : node.to;
    fresh_.push_back(node);
  }

  /// Intermediate pruning: a node whose only successor has its root is replaced by that.
  bool intermediate(Node& node) {
    if (fresh_.size() != 1 || fresh_[0].kind != Node::Kind::cone || fresh_[0].root != node.root) {
      return false;
    }
    node = fresh_[0];
    fresh_.clear();
    return true;
  }

  void push_all() {
    for (const Node& node : fresh_) {
      const std::uint32_t number = memory_.keep(node);
      const double g = roots_[node.root].g;
      memory_.open.push(g + lengths_.estimate(roots_[node.root], node), g, number);
      ++effort_.generated;
    }
    fresh_.clear();
  }

  const Level& level_;
  Corner rule_;
  const std::vector<Target>& targets_;
  Lengths lengths_;
  BudgetWatch& watch_;
  std::size_t max_bytes_;
  Memory& memory_;
  Effort& effort_;
  std::vector<Root>& roots_;
  std::vector<Node>& fresh_;
  double tie_ = 0;  ///< lengths that differ by less are equal
  Node goal_;
  std::uint32_t nearest_ = 0;
  double nearest_left_ = std::numeric_limits<double>::infinity();
};
}  // namespace altiplan::anya
