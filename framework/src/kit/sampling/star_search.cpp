// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/sampling/star_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace altiplan::kit {
namespace {

constexpr std::size_t kBytesPerNode = 160;  ///< of all that Memory holds, with room to grow
constexpr double kShorter = 1 - 1e-12;      ///< what is shorter by rounding alone is not
constexpr double kForgetBelow = 0.99;  ///< of the last length: then useless nodes are forgotten

/// Measure of the unit ball.
double unit_ball(int axes) { return axes == 3 ? 4 * kPi / 3 : axes == 2 ? kPi : 2.0; }
}  // namespace

StarSearch::StarSearch(const Request& request, const StarSettings& settings, Memory& memory)
    : request_(request),
      settings_(settings),
      memory_(memory),
      rules_(request),
      watch_(request.budget),
      random_(request.random.sub("sample")),
      before_start_(request.before_start()),
      box_(sampled_box(request)),
      set_(request.start.position, request.goal.position, box_),
      axes_(std::max(1, free_axes(box_))),
      straight_(std::max(
          0.0, (request.goal.position - request.start.position).norm() - request.goal.tolerance_m)),
      max_nodes_(std::min<std::size_t>(request.budget.max_memory_bytes / kBytesPerNode, 1U << 30)) {
  memory_.legs.clear();
  memory_.points.clear();
  memory_.cost.clear();
  memory_.ends.clear();
  add_root();
}

PlanResult StarSearch::run() {
  while (may_go_on()) {
    ++expanded_;
    grow(sample());
  }
  return result();
}

bool StarSearch::may_go_on() {
  budget_ended_ = watch_.spent(expanded_) || memory_.legs.size() >= max_nodes_;
  return !budget_ended_ && expanded_ < settings_.max_iterations && best_ > straight_ * (1 + 1e-9);
}

/// SampleFree: the goal, or a point of the volume or of the informed set.
Vec3 StarSearch::sample() {
  if (!goal_is_in_ && random_.uniform() < settings_.goal_bias) {
    return request_.goal.position;
  }
  return settings_.informed ? set_.draw(random_) : random_.in(box_);
}

/// One turn of the loop of RRT*: Nearest, Steer, Near, the best parent, and rewiring. Where limits
/// bend the leg from the nearest node, others may still lead to the sample itself: they come first.
void StarSearch::grow(const Vec3& x_rand) {
  if (!set_.contains(x_rand) || !rules_.point_ok(x_rand)) {
    return;
  }
  const Node nearest = find_near(x_rand);
  const Vec3& x_nearest = memory_.legs.point(nearest);
  Vec3 x_new = x_rand;
  std::optional<Candidate> parent;
  if ((x_rand - x_nearest).norm() <= settings_.range) {
    parent = choose_parent(x_new);
  }
  if (!parent) {
    x_new = steer(behind(nearest), x_nearest, x_rand, settings_.range, request_.limits);
    if (x_new == x_rand || x_new == x_nearest || !set_.contains(x_new) || !rules_.point_ok(x_new)) {
      return;
    }
    find_near(x_new);
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
  // The order of choose_parent is its own: what is left of the list still holds all that may gain.
  for (const Candidate& candidate : candidates_) {
    const double cost = memory_.cost[std::size_t(node)] + candidate.metres;
    if (cost < memory_.cost[std::size_t(candidate.node)] * kShorter) {
      rewire(node, candidate.node);
    }
  }
  reach_goal(node);
  learn_length();
}

/// The goal as a child of a new node in range of it, until it is in the tree.
void StarSearch::reach_goal(Node node) {
  const Vec3& p = memory_.legs.point(node);
  const Vec3& goal = request_.goal.position;
  const double metres = (goal - p).norm();
  const double cost = memory_.cost[std::size_t(node)] + metres;
  if (!goal_is_in_ && metres <= settings_.range && cost <= request_.limits.max_route_length &&
      rules_.ok(behind(node), p, goal)) {
    add(goal, {node, metres, cost});
  }
}

/// Puts the nodes within the radius of p into memory_.near, the nearest among them whatever its
/// distance, and returns that.
LegTree::Node StarSearch::find_near(const Vec3& p) {
  memory_.points.within(p, near_radius(), memory_.near);
  if (memory_.near.empty()) {
    memory_.near.push_back(std::uint32_t(memory_.points.nearest(p)));
  }
  return nearest_of_near(p);
}

LegTree::Node StarSearch::nearest_of_near(const Vec3& p) const {
  double least = kInfinity;
  std::uint32_t best = 0;
  for (const std::uint32_t number : memory_.near) {
    const double its = (memory_.points.point(number) - p).squaredNorm();
    if (its < least || (its <= least && number < best)) {
      least = its;
      best = number;
    }
  }
  return Node(best);
}

void StarSearch::list_candidates(const Vec3& x_new) {
  candidates_.clear();
  for (const std::uint32_t number : memory_.near) {
    const double metres = (memory_.points.point(number) - x_new).norm();
    candidates_.push_back({Node(number), metres, memory_.cost[number] + metres});
  }
}

/// The node through which the way to x_new is shortest. Legs are judged from the cheapest on until
/// one is kept; those judged leave the list, as a way through x_new is no gain for them.
std::optional<StarSearch::Candidate> StarSearch::choose_parent(const Vec3& x_new) {
  list_candidates(x_new);
  const double to_go =
      std::max(0.0, (x_new - request_.goal.position).norm() - request_.goal.tolerance_m);
  while (!candidates_.empty()) {
    const auto best = std::min_element(
        candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
          return a.cost != b.cost ? a.cost < b.cost : a.node < b.node;
        });
    const Candidate candidate = *best;
    *best = candidates_.back();
    candidates_.pop_back();
    if (candidate.metres == 0 || candidate.cost + to_go > request_.limits.max_route_length) {
      return std::nullopt;
    }
    if (rules_.ok(behind(candidate.node), memory_.legs.point(candidate.node), x_new)) {
      return candidate;
    }
  }
  return std::nullopt;
}

/// Hangs x_near below x_new where the leg, the turns at both of its ends and those that follow keep
/// every rule.
void StarSearch::rewire(Node x_new, Node x_near) {
  LegTree& legs = memory_.legs;
  const Vec3& a = legs.point(x_new);
  const Vec3& b = legs.point(x_near);
  if (const auto before = behind(x_new);
      !rules_.ok(before, a, b) || !turns_follow(onward(before, a), x_near)) {
    return;
  }
  legs.move(x_near, x_new);
  ++rewired_;
  legs.below(x_near, memory_.moved);
  for (const Node node : memory_.moved) {
    const Node parent = legs.parent(node);
    memory_.cost[std::size_t(node)] =
        memory_.cost[std::size_t(parent)] + (legs.point(node) - legs.point(parent)).norm();
    note_end(node);
  }
  if (request_.trace != nullptr) {
    request_.trace->add(
        {TraceEvent::Kind::rewired, x_near, x_new, b, memory_.cost[std::size_t(x_near)]});
  }
}

/// min(gamma (log n / n)^(1/d), eta), found anew when n has grown by a 64th.
double StarSearch::near_radius() {
  const std::size_t count = memory_.points.count();
  if (count < radius_for_ || count > radius_for_ + radius_for_ / 64) {
    radius_for_ = count;
    const double n = double(std::max<std::size_t>(count, 2));
    const double d = axes_;
    radius_ = std::min(
        settings_.range,
        settings_.radius_scale *
            std::pow(2 * (1 + 1 / d) * set_.measure() / unit_ball(axes_) * std::log(n) / n, 1 / d));
  }
  return radius_;
}

/// How the vehicle comes to the node, where a rule asks for it.
std::optional<Approach> StarSearch::behind(Node node) const {
  return rules_.looks_back() ? memory_.legs.approach(node, 0, before_start_) : std::nullopt;
}

/// Whether the turns into the legs below a node hold for a vehicle that comes to it by `before`;
/// past a leg without a heading, those that follow too.
bool StarSearch::turns_follow(const Approach& before, Node node) {
  const LegTree& legs = memory_.legs;
  const Vec3& at = legs.point(node);
  for (Node child = legs.first_child(node); child != LegTree::kNone; child = legs.sibling(child)) {
    if (!rules_.follows(before, at, legs.point(child)) ||
        (!has_heading(legs.point(child) - at) && !turns_follow(onward(before, at), child))) {
      return false;
    }
  }
  return true;
}

void StarSearch::add_root() {
  const Vec3& start = request_.start.position;
  memory_.legs.add(start, LegTree::kNone);
  memory_.points.insert(start);
  memory_.cost.push_back(0);
  memory_.ends.push_back(0);
  if (request_.trace != nullptr) {
    request_.trace->add({TraceEvent::Kind::added, 0, -1, start, 0});
  }
}

LegTree::Node StarSearch::add(const Vec3& p, const Candidate& parent) {
  const Node node = memory_.legs.add(p, parent.node);
  memory_.points.insert(p);
  memory_.cost.push_back(parent.cost);
  memory_.ends.push_back(request_.goal.reached_at(p) ? 1 : 0);
  const double left = (p - request_.goal.position).norm();
  nearest_ = std::min(nearest_, left);
  goal_is_in_ = goal_is_in_ || left == 0;
  note_end(node);
  if (request_.trace != nullptr) {
    request_.trace->add({TraceEvent::Kind::added, node, parent.node, p, parent.cost});
  }
  return node;
}

void StarSearch::note_end(Node node) {
  const double cost = memory_.cost[std::size_t(node)];
  if (memory_.ends[std::size_t(node)] != 0 && cost < best_ &&
      cost <= request_.limits.max_route_length) {
    best_ = cost;
    best_end_ = node;
  }
}

/// After an improvement: where a shorter route may lead shrinks, and nodes outside of it are looked
/// for no more.
void StarSearch::learn_length() {
  if (best_end_ == LegTree::kNone || best_ >= known_) {
    return;
  }
  known_ = best_;
  ++improved_;
  first_at_ = first_at_ == 0 ? std::int64_t(expanded_) : first_at_;
  if (request_.trace != nullptr) {
    request_.trace->add(
        {TraceEvent::Kind::iteration, std::int64_t(expanded_), -1, request_.goal.position, best_});
  }
  if (!settings_.bounded) {
    return;
  }
  set_.set_length(best_ + request_.goal.tolerance_m);
  if (best_ < kForgetBelow * forgotten_at_) {
    forgotten_at_ = best_;
    memory_.points.forget_if(
        [&](std::size_t number) { return !set_.contains(memory_.points.point(number)); });
  }
}

PlanResult StarSearch::result() {
  PlanResult result;
  result.counters = {{"expanded", std::int64_t(expanded_)},
                     {"nodes", std::int64_t(memory_.legs.size())},
                     {"rewired", rewired_},
                     {"improvements", improved_},
                     {"first_route_at", first_at_},
                     {"legs_checked", rules_.checked()}};
  result.budget_hit = budget_ended_ && !watch_.cancelled();
  if (best_end_ != LegTree::kNone) {
    result.status = PlanStatus::solved;
    result.route = memory_.legs.way_to(best_end_);
    result.message = "improved " + std::to_string(improved_ - 1) + " times";
    return result;
  }
  result.status = watch_.cancelled() ? PlanStatus::cancelled
                  : budget_ended_    ? PlanStatus::timed_out
                                     : PlanStatus::no_route;
  result.message = reason();
  return result;
}

/// How near the tree came, and what was in the way.
std::string StarSearch::reason() const {
  char near[32];
  std::snprintf(near, sizeof near, "%.0f",
                std::min(nearest_, (request_.start.position - request_.goal.position).norm()));
  const std::string refusals = rules_.refusals();
  return "the tree of " + std::to_string(memory_.legs.size()) + " nodes came to " + near +
         " m of the goal" + (refusals.empty() ? "" : "; the last legs were refused by " + refusals);
}
}  // namespace altiplan::kit
