// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/kit/sampling/star_search.hpp"
#include "beside_route.hpp"
#include "candidate.hpp"
#include "pose_motion.hpp"
#include "straight_motion.hpp"

namespace altiplan::kit {

LegTree::Node nearest_of_near(const StarMemory& memory, const Vec3& p);
/// How near the tree came to the goal, and which constraints stopped it.
std::string reason(const StarMemory& memory, double away, const std::string& refusals);

/// One search. `Motion` knows what a node is and how two are joined.
template <class Motion>
class StarGrowth {
 public:
  StarGrowth(const Request& request, const StarSettings& settings, StarMemory& memory)
      : request_(request),
        settings_(settings),
        memory_(memory),
        motion_(request, settings, memory),
        watch_(request.budget),
        random_(request.random.sub("sample")),
        box_(sampled_box(request)),
        set_(request.start.position, request.goal.position, box_),
        goals_(motion_.goals()),
        reached_(goals_.size(), false),
        min_route_(motion_.min_route()),
        max_nodes_(std::min<std::size_t>(request.budget.max_memory_bytes / Motion::kBytesPerNode,
                                         1U << 30)) {
    memory_.clear();
    for (const State& start : motion_.starts()) {
      add_root(start);
    }
  }

  PlanResult run() {
    if constexpr (!Motion::kExact) {
      if (may_go_on()) {
        join_directly();
      }
    }
    while (may_go_on()) {
      ++expanded_;
      grow(sample());
    }
    return result();
  }

 private:
  /// Excludes improvements by rounding alone.
  static constexpr double kShorter = 1 - 1e-12;
  /// Of the last length: triggers the removal of useless nodes.
  static constexpr double kForgetBelow = 0.99;
  static constexpr std::size_t kMaxShots = 64;
  using State = typename Motion::State;
  using Node = LegTree::Node;

  bool may_go_on() {
    budget_ended_ =
        watch_.spent(expanded_, memory_.legs.size()) || memory_.legs.size() >= max_nodes_;
    return !budget_ended_ && expanded_ < settings_.max_iterations &&
           best_ > min_route_ * (1 + 1e-9);
  }

  /// SampleFree: a goal, or a state in the volume or in the informed set.
  State sample() {
    if (!goal_is_in_ && random_.uniform() < settings_.goal_bias) {
      const auto last = std::int64_t(goals_.size()) - 1;
      return goals_[last == 0 ? 0 : std::size_t(random_.integer(0, last))];
    }
    if (!beside_route_.empty() && random_.uniform() < settings_.route_bias) {
      return motion_.sampled(beside_route_.draw(random_, near_radius(), box_), random_);
    }
    const Vec3 p = settings_.informed ? set_.draw(random_) : random_.in(box_);
    return motion_.sampled(p, random_);
  }

  /// Tries some paths from starts to goals, from the shortest on, until one is free.
  void join_directly() {
    std::vector<std::pair<double, std::pair<Node, std::size_t>>> paths;
    for (Node root = 0; root < Node(memory_.legs.size()); ++root) {
      for (std::size_t g = 0; g < goals_.size(); ++g) {
        paths.push_back({motion_.metres(root, goals_[g]), {root, g}});
      }
    }
    const auto end = paths.begin() + std::ptrdiff_t(std::min(paths.size(), kMaxShots));
    std::partial_sort(paths.begin(), end, paths.end());
    min_route_ = motion_.ends_are_poses() && !paths.empty() ? paths.front().first : 0;
    for (auto path = paths.begin(); path != end; ++path) {
      const auto& [metres, ends] = *path;
      if (metres <= motion_.max_cost(best_) && motion_.joins(ends.first, goals_[ends.second])) {
        add(goals_[ends.second], {ends.first, metres, metres, true});
        return learn_length();
      }
    }
  }

  /// One iteration of RRT*: Nearest, Steer, Near, the best parent, and rewiring. Where limits bend
  /// the leg from the nearest node, other nodes may still reach the sample itself: they are tried
  /// first.
  void grow(State x_rand) {
    if (!is_useful(x_rand)) {
      return;
    }
    Node nearest = find_near(place(x_rand));
    motion_.aim(x_rand, nearest, random_);
    State x_new = x_rand;
    std::optional<Candidate> parent;
    if ((place(x_rand) - memory_.legs.point(nearest)).norm() <= settings_.range) {
      parent = choose_parent(x_new);
    }
    if (!parent) {
      const std::optional<State> steered = motion_.steer(nearest, x_rand);
      if (!steered || !is_useful(*steered)) {
        return;
      }
      x_new = *steered;
      find_near(place(x_new));
      if (std::find(memory_.near.begin(), memory_.near.end(), std::uint32_t(nearest)) ==
          memory_.near.end()) {
        memory_.near.push_back(std::uint32_t(nearest));
      }
      parent = choose_parent(x_new);
    }
    if (!parent) {
      return;
    }
    const Node node = add(x_new, *parent);
    rewire(node);
    reach_goals(node);
    learn_length();
  }

  void trace(const TraceEvent& event) const {
    if (request_.trace != nullptr) {
      request_.trace->add(event);
    }
  }

  static const Vec3& place(const State& state) { return Motion::place(state); }
  bool is_useful(const State& state) const {
    return set_.contains(place(state)) && motion_.may_improve(place(state), best_) &&
           motion_.rules().point_ok(place(state));
  }

  /// Puts the nodes within the radius of p into memory_.near, at least the nearest, and returns
  /// that.
  Node find_near(const Vec3& p) {
    memory_.points.within(p, near_radius(), memory_.near);
    if (memory_.near.empty()) {
      memory_.near.push_back(std::uint32_t(memory_.points.nearest(p)));
    }
    return nearest_of_near(memory_, p);
  }

  void list_candidates(const State& x_new) {
    candidates_.clear();
    for (const std::uint32_t number : memory_.near) {
      const double metres = motion_.minimum(Node(number), x_new);
      const double edge = motion_.edge(Node(number), x_new, metres);
      candidates_.push_back({Node(number), metres, memory_.cost[number] + edge, Motion::kExact});
    }
  }

  /// The node through which the path to x_new is shortest. Edges are checked from the cheapest on
  /// until one is valid; those checked leave the list, as a path through x_new is no gain for them.
  std::optional<Candidate> choose_parent(const State& x_new) {
    list_candidates(x_new);
    const double to_go = motion_.to_go(x_new);
    double known = kInfinity;  // the least of the exact costs in the list
    while (!candidates_.empty()) {
      const auto best = std::min_element(candidates_.begin(), candidates_.end());
      if (!best->exact) {
        refine(*best, x_new, known);
        continue;
      }
      known = kInfinity;
      const Candidate candidate = *best;
      *best = candidates_.back();
      candidates_.pop_back();
      if (candidate.metres == 0 || candidate.cost == kInfinity ||
          candidate.cost + to_go > motion_.max_cost(best_)) {
        return std::nullopt;
      }
      if (motion_.joins(candidate.node, x_new)) {
        return candidate;
      }
    }
    return std::nullopt;
  }

  /// Makes the candidate exact if it costs less than `known`, else that is its cost; infinite
  /// beyond the range.
  void refine(Candidate& candidate, const State& x_new, double& known) const {
    constexpr double kRounding = 1 + 1e-9;
    const double before = memory_.cost[std::size_t(candidate.node)];
    const double range = settings_.range * kRounding;
    const double at_most = std::min(range, known - before);
    candidate.metres = motion_.metres(candidate.node, x_new, at_most);
    candidate.exact = candidate.metres <= at_most || at_most == range;
    candidate.metres = candidate.metres <= range ? candidate.metres : kInfinity;
    candidate.cost = candidate.exact ? before + candidate.metres : known;
    known = std::min(known, candidate.cost);
  }

  /// Rewires the candidates that choose_parent has left: they hold all nodes that may gain.
  void rewire(Node x_new) {
    for (const Candidate& candidate : candidates_) {
      const Node x_near = candidate.node;
      const auto gains = [&](double metres) {
        return memory_.cost[std::size_t(x_new)] + metres <
               memory_.cost[std::size_t(x_near)] * kShorter;
      };
      if constexpr (Motion::kExact) {
        if (gains(motion_.edge(x_new, motion_.state(x_near), candidate.metres))) {
          rewire(x_new, x_near);
        }
      } else if (const State state = motion_.state(x_near); gains(motion_.minimum(x_new, state))) {
        const double at_most = std::min(
            settings_.range, memory_.cost[std::size_t(x_near)] - memory_.cost[std::size_t(x_new)]);
        if (const double metres = motion_.metres(x_new, state, at_most);
            metres <= settings_.range && gains(metres)) {
          rewire(x_new, x_near);
        }
      }
    }
  }

  /// Moves x_near below x_new if all edges concerned satisfy every constraint.
  void rewire(Node x_new, Node x_near) {
    LegTree& legs = memory_.legs;
    if (!motion_.may_move(x_near, x_new)) {
      return;
    }
    legs.move(x_near, x_new);
    motion_.moved(x_near);
    ++rewired_;
    legs.below(x_near, memory_.moved);
    for (const Node node : memory_.moved) {
      memory_.cost[std::size_t(node)] =
          memory_.cost[std::size_t(legs.parent(node))] + motion_.edge_to(node);
      note_end(node);
    }
    trace({TraceEvent::Kind::rewired, x_near, x_new, legs.point(x_near),
           memory_.cost[std::size_t(x_near)]});
  }

  /// Adds goals as children of a new node in range of them, until they are in the tree.
  void reach_goals(Node node) {
    const double before = memory_.cost[std::size_t(node)];
    for (std::size_t g = 0; g < goals_.size(); ++g) {
      const double at_most =
          std::min(settings_.range, motion_.max_metres(motion_.max_cost(best_) - before));
      if (reached_[g] || motion_.minimum(node, goals_[g]) > at_most) {
        continue;
      }
      const double metres = motion_.metres(node, goals_[g], at_most);
      const double cost = before + motion_.edge(node, goals_[g], metres);
      if (metres <= settings_.range && cost <= motion_.max_cost(best_) && cost < kInfinity &&
          motion_.joins(node, goals_[g])) {
        add(goals_[g], {node, metres, cost, true});
      }
    }
  }

  /// Recomputed when n has grown by a 64th.
  double near_radius() {
    const std::size_t count = memory_.points.count();
    if (count < radius_for_ || count > radius_for_ + radius_for_ / 64) {
      radius_for_ = count;
      const double anywhere = (1 - settings_.route_bias) * double(count);  // not beside the route
      radius_ = motion_.near_radius(std::max(anywhere, 2.0), set_.measure());
    }
    return radius_;
  }

  void add_root(const State& start) {
    const Node node = memory_.legs.add(place(start), LegTree::kNone);
    memory_.points.insert(place(start));
    memory_.cost.push_back(0);
    memory_.ends.push_back(0);
    motion_.added(node);
    trace({TraceEvent::Kind::added, node, -1, place(start), 0});
  }

  Node add(const State& state, const Candidate& parent) {
    const Vec3& p = place(state);
    const Node node = memory_.legs.add(p, parent.node);
    memory_.points.insert(p);
    motion_.added(node);
    const double cost = Motion::kExact
                            ? parent.cost
                            : memory_.cost[std::size_t(parent.node)] + motion_.edge_to(node);
    memory_.cost.push_back(cost);
    memory_.ends.push_back(motion_.is_end(state) ? 1 : 0);
    nearest_ = std::min(nearest_, (p - request_.goal.position).norm());
    for (std::size_t g = 0; g < goals_.size(); ++g) {
      reached_[g] = reached_[g] || Motion::same(state, goals_[g]);
      goal_is_in_ = goal_is_in_ || reached_[g];
    }
    note_end(node);
    trace({TraceEvent::Kind::added, node, parent.node, p, cost});
    return node;
  }

  void note_end(Node node) {
    const double cost = memory_.cost[std::size_t(node)];
    if (memory_.ends[std::size_t(node)] != 0 && cost < best_ &&
        motion_.is_short_enough(node, cost)) {
      best_ = cost;
      best_end_ = node;
    }
  }

  /// After an improvement: the set of points on shorter routes shrinks, and nodes outside of it are
  /// no longer searched.
  void learn_length() {
    if (best_end_ == LegTree::kNone || best_ >= known_) {
      return;
    }
    known_ = best_;
    request_.budget.show_best(best_);
    ++improved_;
    first_at_ = first_at_ == 0 ? std::int64_t(expanded_) : first_at_;
    trace(
        {TraceEvent::Kind::iteration, std::int64_t(expanded_), -1, request_.goal.position, best_});
    beside_route_.learn(memory_.legs, best_end_);
    if (settings_.bounded) {
      set_.set_length(motion_.reach(best_));
    }
    if (settings_.bounded && best_ < kForgetBelow * forgotten_at_) {
      forgotten_at_ = best_;
      memory_.points.forget_if([&](std::size_t number) {
        const Vec3& p = memory_.points.point(number);
        return !set_.contains(p) || !motion_.may_improve(p, best_);
      });
    }
  }

  PlanResult result() {
    PlanResult result;
    result.counters = {{"expanded", std::int64_t(expanded_)},
                       {"nodes", std::int64_t(memory_.legs.size())},
                       {"rewired", rewired_},
                       {"improvements", improved_},
                       {"first_route_at", first_at_},
                       {"legs_checked", motion_.rules().checked()}};
    result.budget_hit = budget_ended_ && !watch_.cancelled();
    if (best_end_ != LegTree::kNone) {
      result.status = PlanStatus::solved;
      result.route = motion_.route_to(best_end_);
      result.message = "improved " + std::to_string(improved_ - 1) + " times";
      return result;
    }
    result.status = watch_.cancelled() ? PlanStatus::cancelled
                    : budget_ended_    ? PlanStatus::timed_out
                                       : PlanStatus::no_route;
    const double away =
        std::min(nearest_, (request_.start.position - request_.goal.position).norm());
    result.message = reason(memory_, away, motion_.refusals());
    return result;
  }

  const Request& request_;
  const StarSettings& settings_;
  StarMemory& memory_;
  Motion motion_;
  BudgetWatch watch_;
  RandomStream random_;
  Box box_;
  InformedSet set_;
  std::vector<State> goals_;
  std::vector<bool> reached_;  ///< the goals that are in the tree
  double min_route_;           ///< lower bound of the cost of a route
  std::size_t max_nodes_;
  std::vector<Candidate> candidates_;
  bool goal_is_in_ = false;
  bool budget_ended_ = false;
  Node best_end_ = LegTree::kNone;
  double best_ = kInfinity;
  BesideRoute beside_route_;
  double known_ = kInfinity;  ///< the best of the previous iterations
  double forgotten_at_ = kInfinity;
  double nearest_ = kInfinity;  ///< of all nodes to the goal
  double radius_ = 0;
  std::size_t radius_for_ = 0;  ///< number of nodes for which the radius was computed
  std::uint64_t expanded_ = 0;
  std::int64_t first_at_ = 0;
  std::int64_t improved_ = 0;
  std::int64_t rewired_ = 0;
};
}  // namespace altiplan::kit
