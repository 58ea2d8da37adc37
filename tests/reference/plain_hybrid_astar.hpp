// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <queue>
#include <tuple>
#include <vector>

#include "altiplan/kit/dubins/dubins.hpp"
#include "altiplan/request.hpp"

namespace altiplan::testing {

/// Hybrid A* in the plane as in the article (D. Dolgov et al., IJRR 29(5), 2010), in the plainest
/// form: nodes in maps and a priority queue, collisions by samples along each piece, the larger of
/// the Dubins length and the grid's distance as heuristic, a shot from every pose.
class PlainHybridAstar {
 public:
  struct Settings {
    double radius = 80;
    double cell = 40;
    int headings = 16;
    double weight_h = 1.2;
    double sample_m = 2;
  };

  PlainHybridAstar(const Request& request, const Settings& settings)
      : request_(request), settings_(settings) {
    piece_ = std::max(std::numbers::sqrt2 * settings.cell,
                      2 * kPi / settings.headings * settings.radius);
  }

  /// Length of the route found; none if there is none.
  std::optional<double> run(const Pose& start, const Pose& goal) {
    goal_ = goal;
    search_grid();
    push({start, 0, 0});
    double best = kInfinity;
    while (!open_.empty() && open_.top().f < best) {
      const Node node = open_.top();
      open_.pop();
      if (node.g > closed_[key(node.pose)]) {
        continue;
      }
      ++expanded;
      const kit::DubinsPath shot = kit::dubins_path(node.pose, goal_, settings_.radius);
      if (node.g + shot.length() < best && is_free(shot.legs(node.pose, goal_.position))) {
        best = node.g + shot.length();
      }
      for (const double share : {0.0, 1.0, -1.0, 0.5, -0.5}) {
        const double turn = share * piece_ / settings_.radius;
        const Leg leg =
            turn == 0 ? Leg::straight(node.pose.position,
                                      node.pose.position + piece_ * unit_heading(node.pose.heading))
                      : Leg::turning(node.pose, turn, piece_ / std::abs(turn), 0);
        if (is_free({leg})) {
          push({{leg.to, node.pose.heading + turn}, node.g + piece_, 0});
        }
      }
    }
    return best < kInfinity ? std::optional(best) : std::nullopt;
  }

  long expanded = 0;

 private:
  struct Node {
    Pose pose;
    double g;
    double f;
    bool operator>(const Node& other) const { return f > other.f; }
  };
  using Key = std::tuple<long, long, long>;
  using Column = std::pair<long, long>;

  Column column(const Vec3& p) const {
    return {long(std::floor(p.x() / settings_.cell)), long(std::floor(p.y() / settings_.cell))};
  }
  Key key(const Pose& pose) const {
    const double turn = pose.heading / (2 * kPi) - std::floor(pose.heading / (2 * kPi));
    const auto [x, y] = column(pose.position);
    return {x, y, std::lround(turn * settings_.headings) % settings_.headings};
  }

  void push(Node node) {
    const auto [at, is_new] = closed_.try_emplace(key(node.pose), node.g);
    if (!is_new && at->second <= node.g) {
      return;
    }
    at->second = node.g;
    const auto over_cells = grid_.find(column(node.pose.position));
    if (over_cells == grid_.end()) {
      return;
    }
    const double spare = 2 * std::numbers::sqrt2 * settings_.cell;
    const double h = std::max(kit::dubins_length(node.pose, goal_, settings_.radius),
                              over_cells->second - spare);
    node.f = node.g + settings_.weight_h * h;
    open_.push(node);
  }

  bool is_free(const std::vector<Leg>& legs) const {
    for (const Leg& leg : legs) {
      const int samples = 1 + int(leg.length() / settings_.sample_m);
      for (int n = 0; n <= samples; ++n) {
        const Vec3 p = leg.at(double(n) / samples);
        if (!request_.volume.contains(p) ||
            request_.world->clearance(p) < request_.vehicle.radius_m) {
          return false;
        }
      }
    }
    return true;
  }

  /// Dijkstra's search over square cells from the goal.
  void search_grid() {
    using Entry = std::pair<double, Column>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    grid_[column(goal_.position)] = 0;
    open.push({0, column(goal_.position)});
    while (!open.empty()) {
      const auto [d, at] = open.top();
      open.pop();
      if (d > grid_[at]) {
        continue;
      }
      for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) {
          const Column next{at.first + dx, at.second + dy};
          const Vec3 centre((double(next.first) + 0.5) * settings_.cell,
                            (double(next.second) + 0.5) * settings_.cell, goal_.position.z());
          const double to = d + settings_.cell * std::hypot(dx, dy);
          if (!request_.volume.contains(centre, settings_.cell) ||
              request_.world->clearance(centre) < request_.vehicle.radius_m) {
            continue;
          }
          const auto [entry, is_new] = grid_.try_emplace(next, to);
          if (is_new || to < entry->second) {
            entry->second = to;
            open.push({to, next});
          }
        }
      }
    }
  }

  const Request& request_;
  Settings settings_;
  double piece_;
  Pose goal_;
  std::map<Column, double> grid_;
  std::map<Key, double> closed_;
  std::priority_queue<Node, std::vector<Node>, std::greater<>> open_;
};
}  // namespace altiplan::testing
