// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/kit/sampling/leg_rules.hpp"
#include "altiplan/kit/sampling/leg_tree.hpp"
#include "altiplan/kit/sampling/point_grid.hpp"
#include "altiplan/kit/sampling/sampling.hpp"
#include "altiplan/plan_result.hpp"

namespace altiplan::kit {

struct StarSettings {
  double range = 0;         ///< metres; longest leg that the tree grows by (eta)
  double goal_bias = 0;    ///< of the samples are the goal, until it is in the tree
  double radius_scale = 1;  ///< times the least radius that converges
  std::uint64_t max_iterations = 0;
  bool bounded = false;   ///< once there is a route, keep to places where a shorter one may lead
  bool informed = false;  ///< and draw there alone
};

/// RRT* and Informed RRT* (see planners rrt_star and informed_rrt_star): one search, which draws
/// from the whole volume or from the informed set. Under limits on turns a node keeps its
/// children's turns: a parent is chosen, or changed, only where all of them still hold.
class ALTIPLAN_API StarSearch {
 public:
  /// What outlives a search, to be used again by the next.
  struct Memory {
    LegTree legs;
    PointGrid points;                ///< under the numbers of `legs`
    std::vector<double> cost;        ///< metres from the start, one entry a node
    std::vector<std::uint8_t> ends;  ///< whether a node lies within the goal's tolerance
    std::vector<std::uint32_t> near;
    std::vector<LegTree::Node> moved;
  };

  StarSearch(const Request& request, const StarSettings& settings, Memory& memory);
  PlanResult run();

 private:
  using Node = LegTree::Node;
  struct Candidate {
    Node node;
    double metres;  ///< of the leg from it
    double cost;    ///< of the way through it
  };

  bool may_go_on();
  Vec3 sample();
  void grow(const Vec3& x_rand);
  Node find_near(const Vec3& p);
  Node nearest_of_near(const Vec3& p) const;
  void list_candidates(const Vec3& x_new);
  std::optional<Candidate> choose_parent(const Vec3& x_new);
  void reach_goal(Node node);
  void rewire(Node x_new, Node x_near);
  double near_radius();

  std::optional<Approach> behind(Node node) const;
  bool turns_follow(const Approach& before, Node node);
  Node add(const Vec3& p, const Candidate& parent);
  void add_root();
  void note_end(Node node);
  void learn_length();
  PlanResult result();
  std::string reason() const;

  const Request& request_;
  const StarSettings& settings_;
  Memory& memory_;
  LegRules rules_;
  BudgetWatch watch_;
  RandomStream random_;
  std::optional<Approach> before_start_;
  Box box_;
  InformedSet set_;
  int axes_;
  double straight_;  ///< no route is shorter
  std::size_t max_nodes_;
  std::vector<Candidate> candidates_;
  bool goal_is_in_ = false;
  bool budget_ended_ = false;
  Node best_end_ = LegTree::kNone;
  double best_ = kInfinity;
  double known_ = kInfinity;  ///< the best of the iterations before
  double forgotten_at_ = kInfinity;
  double nearest_ = kInfinity;  ///< of all nodes to the goal
  double radius_ = 0;
  std::size_t radius_for_ = 0;  ///< nodes for which the radius was found
  std::uint64_t expanded_ = 0;
  std::int64_t first_at_ = 0;
  std::int64_t improved_ = 0;
  std::int64_t rewired_ = 0;
};
}  // namespace altiplan::kit
