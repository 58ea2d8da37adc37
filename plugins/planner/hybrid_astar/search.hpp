// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/kit/dubins/steering.hpp"
#include "altiplan/planner.hpp"
#include "cells.hpp"
#include "columns.hpp"

namespace altiplan::hybrid_astar {

struct Settings {
  double radius = 0;       ///< of turns, metres
  double cell_m = 0;       ///< horizontal
  double cell_height = 0;  ///< metres
  int headings = 16;
  double weight_h = 1;
  std::size_t max_bytes = 0;
};

/// The search of one request.
class Search {
 public:
  Search(const Request& request, const Settings& settings)
      : request_(request),
        settings_(settings),
        steering_(request, settings.radius),
        starts_(request.start_poses(request.start.loiter ? kLoiterPoses : settings.headings)),
        goals_(request.goal_poses(request.goal.loiter ? kLoiterPoses : settings.headings)),
        columns_(request, settings.cell_m, starts_, goals_),
        rules_(request),
        watch_(request.budget),
        length_(std::max(std::numbers::sqrt2 * settings.cell_m,
                         2 * kPi / settings.headings * settings.radius)) {
    for (const double angle : {steering_.limits().climb, -steering_.limits().sink}) {
      if (angle != 0) {
        gradients_.push_back(std::tan(angle));
      }
    }
  }

  PlanResult run() {
    if (steering_.is_too_windy()) {
      return counted(kit::too_windy());
    }
    columns_.begin(watch_);
    add_starts();
    expand();
    return finished();
  }

 private:
  using Index = std::uint32_t;
  static constexpr Index kNone = ~Index{0};
  /// A route shorter by less than this share is not worth its search.
  static constexpr double kTie = 1e-9;
  /// Places where a loiter circle may be left or joined.
  static constexpr int kLoiterPoses = 64;
  /// Poses that lead to the goal, if there are so many, do so from anywhere.
  static constexpr std::size_t kManyApproaches = 2048;
  static constexpr double kChordTurn = 0.2;             ///< radians of a turn that a chord prices
  static constexpr std::uint64_t kManyExpanded = 5000;  ///< for a search that finds nothing

  /// A continuous pose, reached by one piece from its parent.
  struct Node {
    Pose pose;
    double g = 0;  ///< metres through the air from the start, along slopes
    Index parent = kNone;
    bool is_superseded = false;  ///< a shorter path to its cell has been found since
    double turn = 0;             ///< of the piece, radians
    double gradient = 0;         ///< of the piece
  };

  struct Entry {
    double f;
    Index node;
    bool operator<(const Entry& other) const {
      return f != other.f ? f < other.f : node > other.node;  // the newest of equals first
    }
  };

  void add_starts() {
    for (const Pose& pose : starts_) {
      add({pose, 0, kNone});
    }
  }

  /// Poses from which pieces lead to a goal, flown backwards from there; at most kManyApproaches.
  std::size_t count_approaches() {
    std::vector<Pose> poses = goals_;
    Cells known;
    for (std::size_t i = 0; i < poses.size() && poses.size() < kManyApproaches; ++i) {
      const Pose to = poses[i];
      for (const double turn : turns()) {
        for (const double gradient : gradients_) {
          const Leg leg = steering_.piece_to(to, length_, turn, gradient);
          const Pose from = steering_.pose_on(leg, 0, to.heading - turn);
          if (request_.volume.contains(leg.from) && known.find(key(from)) == Cells::kNone &&
              leg_ok(std::nullopt, leg, request_)) {
            known.exchange(key(from), Cells::Node(i));
            poses.push_back(from);
          }
        }
      }
    }
    return std::min(poses.size(), kManyApproaches);
  }

  /// True if the search goes on although few poses lead to the goal, which shots seldom hit.
  bool is_hopeless() const {
    return best_ == kInfinity && approach_count_ < kManyApproaches &&
           expanded_ > kManyExpanded + 10 * approach_count_;
  }

  void expand() {
    while (!open_.empty() && open_.top().f < best_ * (1 - kTie) && !is_hopeless()) {
      const auto [f, at] = open_.top();
      if (watch_.spent(expanded_, open_.size()) || bytes() > settings_.max_bytes) {
        ended_ = true;
        return;
      }
      open_.pop();
      const Node node = nodes_[at];
      if (node.is_superseded) {
        continue;
      }
      if (++expanded_ == kManyExpanded && best_ == kInfinity) {
        approach_count_ = count_approaches();
      }
      if (request_.trace != nullptr) {
        request_.trace->add({TraceEvent::Kind::expanded, at,
                             node.parent == kNone ? -1 : std::int64_t(node.parent),
                             node.pose.position, f});
      }
      note_nearest(node.pose.position);
      if (is_time_for_a_shot(request_.objective
                                 ? (node.pose.position - request_.goal.position).norm()
                                 : f - node.g)) {
        shoot(at, node);
      }
      grow(at, node);
    }
  }

  std::array<double, 5> turns() const {
    const double sharpest = length_ / settings_.radius;
    return {0, sharpest, -sharpest, sharpest / 2, -sharpest / 2};
  }

  /// Pieces straight on and on both sides: level, at the limits of climb and descent, and toward
  /// the middle of the heights that limits above ground leave.
  void grow(Index at, const Node& node) {
    const std::optional<Approach> before = approach(at);
    for (const double turn : turns()) {
      for (const double gradient : gradients_) {
        step(at, node, before, turn, gradient);
      }
      const Vec3 end = steering_.piece(node.pose, length_, turn, 0).to;
      if (const auto middle = columns_.middle_above_ground(end.x(), end.y())) {
        const double wanted = (*middle - node.pose.position.z()) / length_;
        step(at, node, before, turn,
             std::clamp(wanted, *std::min_element(gradients_.begin(), gradients_.end()),
                        *std::max_element(gradients_.begin(), gradients_.end())));
      }
    }
  }

  void step(Index at, const Node& node, const std::optional<Approach>& before, double turn,
            double gradient) {
    Node next;
    next.turn = turn;
    next.gradient = gradient;
    next.parent = at;
    const Leg leg = leg_of(node, next);
    next.pose = steering_.pose_on(leg, 1, node.pose.heading + turn);
    next.g = node.g + (request_.objective ? cost(leg) : length_ * std::hypot(1, gradient));
    const Index known = closed_.find(key(next.pose));
    if ((known != kNone && next.g >= nodes_[known].g) || !request_.volume.contains(leg.to)) {
      return;
    }
    ++checked_;
    if (rules_.ok(before, leg)) {
      add(next);
    } else {
      ++refused_;
    }
  }

  Leg leg_of(const Node& from, const Node& to) const {
    return steering_.piece(from.pose, length_, to.turn, to.gradient);
  }

  double cost(const Leg& leg) const {
    if (!request_.objective) {
      return std::hypot(leg.air_length(), leg.to.z() - leg.from.z());
    }
    // Of a turn by few chords: those of its exact cost are thousands.
    const int pieces = leg.turns() ? int(std::ceil(std::abs(leg.turn) / kChordTurn)) : 1;
    double sum = 0;
    for (int k = 0; k < pieces; ++k) {
      sum += request_.objective->cost(
          Leg::straight(leg.at(double(k) / pieces), leg.at((k + 1.0) / pieces)), 0, request_);
    }
    return sum;
  }
  double cost_to_goal(const Pose& pose) {
    return request_.objective ? columns_(pose.position)
                              : steering_.min_length_to_goal(pose, columns_(pose.position));
  }

  void add(const Node& node) {
    const double h = cost_to_goal(node.pose);
    if (!(node.g + h < best_)) {
      return;
    }
    const auto at = Index(nodes_.size());
    nodes_.push_back(node);
    if (const Index before = closed_.exchange(key(node.pose), at); before != kNone) {
      nodes_[before].is_superseded = true;
    }
    open_.push({node.g + settings_.weight_h * h, at});
  }

  /// Far from the goal one in many: a shot costs as much as several pieces, and seldom hits.
  bool is_time_for_a_shot(double h) const {
    const auto every = std::uint64_t(std::clamp(h / (8 * length_), 1.0, 32.0));
    return (expanded_ - 1) % every == 0;
  }

  /// The shortest free one of the paths without obstacles to the goal.
  void shoot(Index at, const Node& node) {
    shots_.clear();
    for (std::size_t k = 0; k < goals_.size(); ++k) {
      const double length = steering_.length(node.pose, goals_[k]);
      const double at_least =
          request_.objective
              ? request_.objective->bound(node.pose.position, goals_[k].position, request_)
              : length;
      if (length < kInfinity && node.g + at_least < best_ * (1 - kTie)) {
        shots_.emplace_back(length, k);
      }
    }
    std::sort(shots_.begin(), shots_.end());
    for (const auto& [promised, k] : shots_) {
      const auto path = steering_.path(node.pose, goals_[k]);
      double whole = node.g;
      for (const Leg& leg : path ? path->legs : std::vector<Leg>()) {
        whole += cost(leg);
      }
      if (path && (!request_.objective || whole < best_ * (1 - kTie)) && is_free(at, path->legs)) {
        best_ = whole;
        request_.budget.show_best(best_);
        best_node_ = at;
        best_legs_ = path->legs;
        if (request_.trace != nullptr) {
          request_.trace->add({TraceEvent::Kind::added, std::int64_t(nodes_.size()), at,
                               best_legs_.empty() ? node.pose.position : best_legs_.back().to,
                               best_});
        }
        return;
      }
    }
  }

  bool is_free(Index at, const std::vector<Leg>& legs) {
    std::optional<Approach> before = approach(at);
    for (const Leg& leg : legs) {
      ++checked_;
      if (!rules_.ok(before, leg)) {
        ++refused_;
        return false;
      }
      before = onward(before, leg);
    }
    return request_.limits.max_route_length == kInfinity ||
           length(route_to(at, legs)) <= request_.limits.max_route_length;
  }

  std::optional<Approach> approach(Index at) const {
    const Node& node = nodes_[at];
    return node.parent == kNone ? request_.before_start(node.pose.position)
                                : onward(std::nullopt, leg_of(nodes_[node.parent], node));
  }

  Route route_to(Index at, const std::vector<Leg>& last) const {
    std::vector<Leg> legs;
    for (Index node = at; nodes_[node].parent != kNone; node = nodes_[node].parent) {
      legs.push_back(leg_of(nodes_[nodes_[node].parent], nodes_[node]));
    }
    std::reverse(legs.begin(), legs.end());
    legs.insert(legs.end(), last.begin(), last.end());
    return kit::route_of(legs, nodes_[at].pose.position, request_);
  }

  std::uint64_t key(const Pose& pose) const {
    const Vec3 p = pose.position - request_.volume.min;
    const auto cell = [](double x, double size) { return std::uint64_t(std::int64_t(x / size)); };
    const double turn = pose.heading / (2 * kPi) - std::floor(pose.heading / (2 * kPi));
    const auto heading =
        std::uint64_t(std::llround(turn * settings_.headings)) % std::uint64_t(settings_.headings);
    return cell(p.x(), settings_.cell_m) << 44 | cell(p.y(), settings_.cell_m) << 24 |
           cell(p.z(), settings_.cell_height) << 8 | heading;
  }

  std::size_t bytes() const {
    return nodes_.size() * (sizeof(Node) + sizeof(Entry)) + closed_.bytes();
  }

  void note_nearest(const Vec3& p) {
    const Goal& goal = request_.goal;
    const double off =
        std::abs((p - goal.position).norm() - (goal.loiter ? goal.loiter->radius : 0));
    if (off < nearest_) {
      nearest_ = off;
    }
  }

  PlanResult counted(PlanResult result) const {
    result.counters = {{"expanded", std::int64_t(expanded_)},
                       {"nodes", std::int64_t(nodes_.size())},
                       {"legs_checked", checked_}};
    return result;
  }

  PlanResult finished() {
    PlanResult result;
    result.budget_hit = ended_ && !watch_.cancelled();
    if (best_ < kInfinity) {
      result.status = PlanStatus::solved;
      result.route = route_to(best_node_, best_legs_);
      return counted(std::move(result));
    }
    const bool by_memory = bytes() > settings_.max_bytes;
    result.reason = by_memory ? Reason::memory : Reason::none;
    result.status = !ended_              ? PlanStatus::no_route
                    : watch_.cancelled() ? PlanStatus::cancelled
                                         : PlanStatus::timed_out;
    result.message = reason(by_memory);
    return counted(std::move(result));
  }

  std::string reason(bool by_memory) {
    const auto metres = [](double value) {
      return std::isfinite(value) ? std::to_string(std::int64_t(value)) + " m" : "any distance";
    };
    if (nodes_.empty() && !ended_) {
      return "no route: " + columns_.shut_in();
    }
    const std::string refusals = rules_.refusals();
    return std::to_string(expanded_) + " poses expanded, the nearest " + metres(nearest_) +
           " from the goal; " + std::to_string(refused_) + " of " + std::to_string(checked_) +
           " legs refused, with turns of " + metres(settings_.radius) +
           (refusals.empty() ? "" : ", of the last by " + refusals) +
           (is_hopeless()
                ? "; poses from which the goal can be reached: " + std::to_string(approach_count_) +
                      ": check its heading, the volume and obstacles"
                : "") +
           (by_memory ? "; max_memory_mb is used up" : "");
  }

  const Request& request_;
  const Settings& settings_;
  kit::Steering steering_;
  std::vector<Pose> starts_;
  std::vector<Pose> goals_;
  std::vector<std::pair<double, std::size_t>> shots_;  ///< lengths, of indices of goals_
  Columns columns_;
  kit::LegRules rules_;
  BudgetWatch watch_;
  double length_;  ///< of a piece, through the air: it leaves its cell, or its heading
  std::vector<double> gradients_{0};  ///< of pieces
  std::vector<Node> nodes_;
  Heap<Entry> open_;
  Cells closed_;  ///< the best node of each cell
  double best_ = kInfinity;
  Index best_node_ = kNone;
  std::vector<Leg> best_legs_;
  bool ended_ = false;
  std::uint64_t expanded_ = 0;
  std::size_t approach_count_ = kManyApproaches;  ///< unless they are counted
  std::int64_t checked_ = 0;
  std::int64_t refused_ = 0;
  double nearest_ = kInfinity;
};
}  // namespace altiplan::hybrid_astar
