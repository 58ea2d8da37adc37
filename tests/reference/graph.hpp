// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <compare>
#include <set>
#include <utility>
#include <vector>

#include "altiplan/geometry.hpp"

// Shortest ways in a drawn-out graph, by the textbook: nothing here is shared with the planners.
namespace altiplan::reference {

struct Edge {
  std::size_t to;
  double length;
};

struct Graph {
  std::vector<Vec3> at;
  std::vector<std::vector<Edge>> from;

  std::size_t add(const Vec3& p) {
    at.push_back(p);
    from.emplace_back();
    return at.size() - 1;
  }
  void join(std::size_t a, std::size_t b) { from[a].push_back({b, (at[b] - at[a]).norm()}); }
};

/// Length of the shortest way from `start` to every node; infinite where there is none.
inline std::vector<double> dijkstra(const Graph& graph, std::size_t start) {
  std::vector<double> best(graph.at.size(), kInfinity);
  best[start] = 0;
  std::set<std::pair<double, std::size_t>> open{{0, start}};
  while (!open.empty()) {
    const auto [g, here] = *open.begin();
    open.erase(open.begin());
    for (const Edge& edge : graph.from[here]) {
      const double length = g + edge.length;
      if (length < best[edge.to]) {
        open.erase({best[edge.to], edge.to});
        best[edge.to] = length;
        open.insert({length, edge.to});
      }
    }
  }
  return best;
}

/// How a node was reached where a leg may depend on those before it: the last leg, and the last one
/// that has a heading (kNoNode: there was none).
inline constexpr std::size_t kNoNode = ~std::size_t{0};
struct Reached {
  std::size_t before, here;
  std::size_t heading_from, heading_to;
  auto operator<=>(const Reached&) const = default;
};

/// The same by states, so that every path to a node is kept that may matter. `turn_ok(reached,
/// next)` says whether a leg may follow, `has_heading(from, to)` whether it has a heading.
template <class TurnOk, class HasHeading>
std::vector<double> dijkstra_with_turns(const Graph& graph, std::size_t start,
                                        const TurnOk& turn_ok, const HasHeading& has_heading) {
  std::vector<double> best(graph.at.size(), kInfinity);
  using State = Reached;
  std::set<std::pair<double, State>> open{{0, {kNoNode, start, kNoNode, kNoNode}}};
  std::set<State> settled;
  while (!open.empty()) {
    const auto [g, state] = *open.begin();
    open.erase(open.begin());
    if (!settled.insert(state).second) {
      continue;
    }
    best[state.here] = std::min(best[state.here], g);
    for (const Edge& edge : graph.from[state.here]) {
      State next = {state.here, edge.to, state.heading_from, state.heading_to};
      if (has_heading(state.here, edge.to)) {
        next = {state.here, edge.to, state.here, edge.to};
      }
      if (!settled.contains(next) && turn_ok(state, edge.to)) {
        open.insert({g + edge.length, next});
      }
    }
  }
  return best;
}

/// Least length over all simple paths, each walked: what Dijkstra's algorithm is held to. Given up
/// only where a path is as long as one that is known.
class AllSimplePaths {
 public:
  AllSimplePaths(const Graph& graph, std::size_t start, std::size_t goal)
      : graph_(graph), goal_(goal), on_path_(graph.at.size(), false) {
    walk(start, 0);
  }
  double shortest() const { return shortest_; }

 private:
  void walk(std::size_t here, double length) {
    if (length >= shortest_) {
      return;
    }
    if (here == goal_) {
      shortest_ = length;
      return;
    }
    on_path_[here] = true;
    std::vector<Edge> edges = graph_.from[here];
    // A good path first leaves less to walk.
    std::sort(edges.begin(), edges.end(), [&](const Edge& x, const Edge& y) {
      return (graph_.at[x.to] - graph_.at[goal_]).norm() <
             (graph_.at[y.to] - graph_.at[goal_]).norm();
    });
    for (const Edge& edge : edges) {
      if (!on_path_[edge.to]) {
        walk(edge.to, length + edge.length);
      }
    }
    on_path_[here] = false;
  }

  const Graph& graph_;
  std::size_t goal_;
  std::vector<bool> on_path_;
  double shortest_ = kInfinity;
};
}  // namespace altiplan::reference
