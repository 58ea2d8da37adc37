// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/any_angle/any_angle.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "altiplan/kit/lattice/line_of_sight.hpp"

namespace altiplan::kit {
namespace {

/// By direction: the offset on each axis, from 0 on.
constexpr auto kOffsets = [] {
  std::array<std::array<std::uint8_t, 3>, kDirections> offsets{};
  for (int d = 0; d < kDirections; ++d) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      offsets[std::size_t(d)][axis] = std::uint8_t(offset(d)[axis] + 1);
    }
  }
  return offsets;
}();

/// Inline equivalent of lround, except for the last number below a half.
std::uint32_t rounded(double cost) {
  return std::uint32_t(cost + 0.5);  // NOLINT(bugprone-incorrect-roundings)
}
}  // namespace

AnyAngleSearch::Result AnyAngleSearch::run() {
  const Box box = lattice_.spec().box();
  // Few paths are longer than four times this, except in a maze.
  double longest_m = 4 * (box.max - box.min).sum();
  for (;; longest_m *= 4) {
    begin(longest_m);
    if (const auto status = search()) {
      const bool at_goal = *status == PlanStatus::solved;
      const bool cut_short = !at_goal && *status != PlanStatus::no_route;
      progress_.memory_full = cut_short && memory_full();
      Result result{*status, {}, false, cut_short, progress_, {}};
      if (const Node last = at_goal ? goal_.node : fallback_; last != kNone) {
        result.route = route_to(last);
        const bool fits =
            length(result.route) <= request_.limits.max_route_length + kLengthTolerance;
        if (fits) {
          result.status = PlanStatus::solved;
          result.at_goal = at_goal;
        } else {  // by less than the resolution of costs
          result.status = at_goal ? PlanStatus::no_route : *status;
          result.route.clear();
          result.progress.too_long = true;
        }
      }
      return result;
    }
  }
}

/// Nothing if a path is too long for costs of this resolution.
std::optional<PlanStatus> AnyAngleSearch::search() {
  while (!open_.empty()) {
    const BucketQueue::Entry entry = open_.pop();
    const Node s = entry.node;
    if (is_closed(s) || entry.from != g(s)) {
      continue;  // stale entry: a leg was refused, and the path became longer
    }
    if (watch_.spent(progress_.expanded, open_.size()) || memory_full()) {
      return watch_.cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out;
    }
    ++progress_.expanded;
    if (settings_.sight == Sight::lazy && !set_vertex(s)) {
      continue;
    }
    if (g(s) > kMax) {
      return std::nullopt;
    }
    close(s);
    if (request_.trace != nullptr) {
      add_to_trace(s);
    }
    if (s == goal_.node) {
      return PlanStatus::solved;
    }
    expand(s);
  }
  return PlanStatus::no_route;
}

void AnyAngleSearch::close(Node n) {
  reached_.at(n) |= std::uint64_t{kClosed} << 32;
  if (!is_end(n)) {
    const std::size_t bit = nodes_.grid->bit(numbers_.cell(n));
    closed_.at(bit / 64) |= std::uint64_t{1} << bit % 64;
  }
}

void AnyAngleSearch::expand(Node s) {
  if (request_.goal.tolerance_m > 0) {
    remember_fallback(s);
  }
  if (is_end(s)) {
    for (const Node v : start_.links) {
      update_vertex(s, v, distance(s, v), heuristic(v));
    }
    return;
  }
  const Cell key = numbers_.cell(s);
  const Node p = parent(s);
  const Place from = place(p);
  const std::uint32_t g_parent = g(p);
  // Squared distances of the neighbours from the parent and from the goal, by axis and offset.
  std::array<std::array<double, 3>, 3> to_parent;
  std::array<std::array<double, 3>, 3> to_goal;
  std::array<std::array<Node, 3>, 3> part;  // of their indices
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<int>& rows = nodes_.cell[axis];
    for (int o = 0; o < 3; ++o) {
      const int row = std::clamp(key[axis] + o - 1, 0, int(rows.size()) - 1);
      const double at = unit_[axis] * rows[std::size_t(row)];
      to_parent[axis][std::size_t(o)] = (at - from[axis]) * (at - from[axis]);
      to_goal[axis][std::size_t(o)] = (at - goal_.place[axis]) * (at - goal_.place[axis]);
      part[axis][std::size_t(o)] = numbers_.part(axis, row);
    }
  }
  const auto sum = [](const auto& parts, int d) {
    const auto& [x, y, z] = kOffsets[std::size_t(d)];
    return parts[0][x] + parts[1][y] + parts[2][z];
  };
  const bool untested = !has_limits_ && settings_.sight == Sight::lazy;
  const DirectionMask free = steps(key);
  if (free != lattice_steps_) {
    rules_.count_blocked(__builtin_popcount(lattice_steps_ & ~free));
  }
  for (DirectionMask open = free & ~closed_around(key); open != 0; open &= open - 1) {
    const int d = std::countr_zero(open);
    const Node v = sum(part, d);
    const std::uint32_t through_parent = g_parent + rounded(std::sqrt(sum(to_parent, d)));
    if (!is_shorter(through_parent, v)) {
      continue;  // no shorter by way of s
    }
    const std::uint32_t h = rounded(settings_.weight_h * std::sqrt(sum(to_goal, d)));
    if (untested) {
      take(v, p, through_parent, h);
    } else {
      update_vertex(s, v, through_parent, h);
    }
  }
  if (s >= min_link_ && s <= max_link_ &&
      std::find(goal_.links.begin(), goal_.links.end(), s) != goal_.links.end()) {
    update_vertex(s, goal_.node, g_parent + distance(p, goal_.node), 0);
  }
}

/// Reaches v straight from the parent of s, or else from s.
void AnyAngleSearch::update_vertex(Node s, Node v, std::uint32_t through_parent, std::uint32_t h) {
  if (!is_shorter(through_parent, v)) {
    return;
  }
  const Node p = parent(s);
  if (settings_.angles == AngleRule::printed && !keeps_limits(s, v)) {
    return;
  }
  if (may_take(p, v)) {
    take(v, p, through_parent, h);
  } else if (const std::uint32_t through_s = g(s) + distance(s, v);
             s != p && is_shorter(through_s, v) && may_take(s, v)) {
    take(v, s, through_s, h);
  }
}

/// Checks the leg to s, which was taken unchecked. False if it violates a constraint: then s is
/// reached from the best of its closed neighbours and returns to the open list, or becomes
/// unreached.
bool AnyAngleSearch::set_vertex(Node s) {
  if (s == start_.node || sees(parent(s), s)) {
    return true;
  }
  std::uint32_t minimum = kNone;
  Node best = kNone;
  const auto consider = [&](Node from, bool is_free) {
    const std::uint32_t through = g(from) + distance(from, s);
    if (through < minimum && (is_free || sees(from, s))) {
      minimum = through;
      best = from;
    }
  };
  if (is_end(s)) {
    for (const Node link : goal_.links) {
      if (is_closed(link)) {
        consider(link, false);
      }
    }
  } else {
    const Cell key = numbers_.cell(s);
    for (DirectionMask from = closed_around(key) & steps(key); from != 0; from &= from - 1) {
      const Cell o = offset(std::countr_zero(from));
      consider(numbers_.index({key[0] + o[0], key[1] + o[1], key[2] + o[2]}), steps_are_free_);
    }
    if (std::find(start_.links.begin(), start_.links.end(), s) != start_.links.end()) {
      consider(start_.node, false);
    }
  }
  reached_.at(s) = 0;  // may be generated again
  if (best != kNone) {
    take(s, best, minimum, heuristic(s));
  }
  return false;
}

bool AnyAngleSearch::may_take(Node a, Node b) {
  if (settings_.sight == Sight::eager) {
    return sees(a, b);
  }
  return settings_.angles == AngleRule::printed || keeps_limits(a, b);
}

/// The approach to a node.
std::optional<Approach> AnyAngleSearch::before(Node n) const {
  const std::optional<Approach> first = request_.before_start();
  if (n == start_.node) {
    return first;
  }
  const Vec3 from = position(parent(n));
  for (n = parent(n); n != start_.node; n = parent(n)) {
    if (const Vec3 leg = position(n) - position(parent(n)); has_heading(leg)) {
      return Approach(from, leg);
    }
  }
  return Approach(from, onward(first, start_.position).heading);
}

bool AnyAngleSearch::keeps_limits(Node a, Node b) {
  return !has_limits_ || rules_.keeps_limits(before(a), position(a), position(b));
}

bool AnyAngleSearch::sees(Node a, Node b) {
  const End* ends[] = {end(a), end(b)};
  const bool by_cells = std::all_of(std::begin(ends), std::end(ends),
                                    [](const End* end) { return end == nullptr || end->centred; });
  const bool printed = settings_.angles == AngleRule::printed;
  if (!by_cells) {
    return rules_.any_leg_ok(printed ? std::nullopt : before(a), position(a), position(b));
  }
  const Cell from = cell_of(a);
  const Cell to = cell_of(b);
  const bool is_wide = rules_.wide_grid() != nullptr && memory_.wide_sight.line_of_sight(from, to);
  if (is_wide && !has_limits_) {
    return true;
  }
  return line_of_sight(from, to) &&
         (cells_decide_ || printed ||
          rules_.keeps_rules(before(a), position(a), position(b), is_wide));
}

bool AnyAngleSearch::line_of_sight(const Cell& a, const Cell& b) {
  const bool is_free = memory_.sight.line_of_sight(a, b);
  rules_.count_blocked(is_free ? 0 : 1);
  return is_free;
}

void AnyAngleSearch::take(Node v, Node parent, std::uint32_t g, std::uint32_t h) {
  if (longest_ != kNone && g + h / settings_.weight_h > longest_) {
    progress_.too_long = true;
    return;
  }
  reached_.at(v) = std::uint64_t{kLongest - g} << 32 | parent;
  ++progress_.generated;
  open_.push(g + h, v, g);
  if (h < nearest_) {
    nearest_ = h;
    progress_.nearest = position(v);
  }
}

void AnyAngleSearch::remember_fallback(Node s) {
  if (request_.goal.reached_at(position(s)) && (fallback_ == kNone || g(s) < g(fallback_))) {
    fallback_ = s;
  }
}

Polyline AnyAngleSearch::route_to(Node last) const {
  Polyline route;
  for (Node n = last; n != start_.node; n = parent(n)) {
    route.push_back(position(n));
  }
  route.push_back(start_.position);
  std::reverse(route.begin(), route.end());
  return route;
}

std::uint32_t AnyAngleSearch::apart(const Place& a, const Place& b) const {
  double square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    square += (a[axis] - b[axis]) * (a[axis] - b[axis]);
  }
  return rounded(std::sqrt(square));
}

std::uint32_t AnyAngleSearch::heuristic(Node n) const {
  return rounded(settings_.weight_h * distance(n, goal_.node));
}

bool AnyAngleSearch::memory_full() const {
  return memory_.bytes() + open_.bytes() > settings_.max_bytes;
}

void AnyAngleSearch::add_to_trace(Node s) const {
  request_.trace->add({TraceEvent::Kind::expanded, std::int64_t(s),
                       s == start_.node ? -1 : std::int64_t(parent(s)), position(s),
                       (g(s) + heuristic(s)) / per_metre_});
}
}  // namespace altiplan::kit
