// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "altiplan/kit/lattice/goal_search.hpp"
#include "altiplan/kit/totals.hpp"

namespace altiplan::astar {

/// A path to a cell.
struct Label {
  double g = 0;
  std::uint32_t cell = 0;
  std::uint32_t from = 0;  ///< the label before it
  std::uint32_t next = 0;  ///< another label of the cell
  std::uint8_t in = 0;     ///< the step into the cell; kHere: linked to the start
  bool is_dominated = false;
};

/// A* with limits on what adds up: the resource-constrained shortest path, by labels (cost, totals)
/// of which a cell keeps those that no other is at least as good as in all (P. Hansen, Bicriterion
/// Path Problems, 1980; M. Desrochers, F. Soumis, A Generalized Permanent Labelling Algorithm for
/// the Shortest Path Problem with Time Windows, INFOR 26(3), 1988). A label is dropped where a
/// total and the bound of the rest exceed its limit. Complete, and optimal where A* is; a cell may
/// have exponentially many labels. Where constraints depend on two legs, labels compete among those
/// that came by the same step alone.
class LabelSearch : kit::GoalSearch {
 public:
  LabelSearch(const Request& request, const kit::SearchSettings& settings,
              const kit::Lattice& lattice, double best_cost, kit::OpenList& open)
      : GoalSearch(request, settings, lattice, best_cost, open),
        resources_(kit::resources_of(request)),
        by_step_(request.limits.turns() || request.judges_pairs()),
        first_of_(lattice.size(), kNone) {}

  kit::SearchResult run() {
    begin();
    PlanStatus status = PlanStatus::no_route;
    while (!open_.empty()) {
      const auto [f, g, index] = open_.pop();
      if (index == kGoal) {
        return with(route_to(goal_parent_, true), goal_g_, true, false);
      }
      if (labels_[index].is_dominated) {
        continue;
      }
      if (watch_.spent(progress_.expanded, open_.size()) || memory_full()) {
        status = ended();
        break;
      }
      expand(index);
    }
    if (fallback_ != kNone) {
      return with(route_to(fallback_, false), fallback_g_, false, status != PlanStatus::no_route);
    }
    progress_.memory_full = memory_full();
    return without(status, true);
  }

 private:
  void begin() {
    open_.clear(quantum());
    const std::vector<double> none(resources_.size(), 0);
    if (!add_up(none.data(), start_, start_)) {
      return;
    }
    for (const kit::Lattice::Link& link : lattice_.links(start_)) {
      const Vec3 there = lattice_.position(link.cell);
      if (rules_.cell_blocked(link.cell) ||
          (link.length > 0 && !rules_.any_leg_ok(request_.before_start(), start_, there))) {
        continue;
      }
      const double g = link_cost(start_, there, link.length);
      if (g == kInfinity || !add_up(none.data(), start_, there)) {
        continue;
      }
      at_start_ = link.length == 0;
      push({g, lattice_.index(link.cell), kNone, kNone, kit::kHere, false}, link.cell, there);
    }
  }

  /// Sets `totals_` to those of a path with a further leg; false if no route over its end keeps all
  /// limits.
  bool add_up(const double* before, const Vec3& a, const Vec3& b) {
    totals_.resize(resources_.size());
    for (std::size_t k = 0; k < resources_.size(); ++k) {
      totals_[k] = before[k] + resources_[k].of(a, b, request_);
      if (!resources_[k].allows(totals_[k], b, request_)) {
        progress_.pruned_by = resources_[k].name;
        return false;
      }
    }
    return true;
  }

  /// True if a label is at least as good as the path of cost g and `totals_`.
  bool dominates(std::size_t label, double g) const {
    const double* its = &spent_[label * resources_.size()];
    return labels_[label].g <= g &&
           std::equal(totals_.begin(), totals_.end(), its,
                      [](double ours, double other) { return other <= ours; });
  }
  bool is_dominated_by(std::size_t label, double g) const {
    const double* its = &spent_[label * resources_.size()];
    return g <= labels_[label].g &&
           std::equal(totals_.begin(), totals_.end(), its,
                      [](double ours, double other) { return ours <= other; });
  }
  bool compete(std::uint8_t a, std::uint8_t b) const { return !by_step_ || a == b; }

  bool is_needless(std::uint32_t cell, std::uint8_t in, double g) const {
    for (std::uint32_t at = first_of_[cell]; at != kNone; at = labels_[at].next) {
      if (compete(labels_[at].in, in) && dominates(at, g)) {
        return true;
      }
    }
    return false;
  }

  /// Adds a label with `totals_`, and takes those that it dominates out of its cell.
  void push(Label label, const Cell& c, const Vec3& at) {
    std::uint32_t* place = &first_of_[label.cell];
    while (*place != kNone) {
      Label& other = labels_[*place];
      if (compete(other.in, label.in) && is_dominated_by(*place, label.g)) {
        other.is_dominated = true;
        *place = other.next;
      } else {
        place = &other.next;
      }
    }
    const auto index = std::uint32_t(labels_.size());
    label.next = std::exchange(first_of_[label.cell], index);
    labels_.push_back(label);
    spent_.insert(spent_.end(), totals_.begin(), totals_.end());
    ++progress_.generated;
    open_.push(evaluation(label.g, c, at), label.g, index);
  }

  void expand(std::uint32_t index) {
    const Label label = labels_[index];  // a push may relocate it
    const Cell c = lattice_.cell(label.cell);
    const Vec3 here = label.in == kit::kHere && at_start_ ? start_ : lattice_.position(c);
    const std::optional<Approach> from = before(label.in, here);
    const std::vector<double> spent(
        spent_.begin() + std::ptrdiff_t(index * resources_.size()),
        spent_.begin() + std::ptrdiff_t((index + 1) * resources_.size()));
    ++progress_.expanded;
    remember_nearest(here);
    if (request_.trace != nullptr) {
      request_.trace->add({TraceEvent::Kind::expanded, index,
                           label.from == kNone ? -1 : std::int64_t(label.from), here,
                           evaluation(label.g, c, here)});
    }
    const kit::Lattice::Link* link = to_goal_.link_of(c);
    if (link == nullptr || add_up(spent.data(), here, goal_)) {
      try_goal(index, label.g, 0, c, here, from);
    }
    const bool judged_whole = rules_.is_first(label.in) && from;
    kit::DirectionMask kept = 0;
    std::array<double, kit::kDirections> g_to;  // of the kept ones
    for (kit::DirectionMask open = rules_.candidates(c, label.in); open != 0; open &= open - 1) {
      const int d = __builtin_ctz(open);
      const Vec3 there = lattice_.position(cell_at(c, d));
      const double g = g_to[std::size_t(d)] = label.g + step_cost(c, d, here, there);
      kept |= kit::DirectionMask(!exceeds_incumbent(g, there)) << d;
    }
    kept = kept == 0 ? 0 : rules_.legs_free(from, c, here, kept);
    for (; kept != 0; kept &= kept - 1) {
      const int d = __builtin_ctz(kept);
      const Cell to = cell_at(c, d);
      const Vec3 there = lattice_.position(to);
      const double g = g_to[std::size_t(d)];
      const auto next = std::uint32_t(label.cell + lattice_.stride(d));
      const auto in = std::uint8_t(rules_.step_after(label.in, d));
      if (!add_up(spent.data(), here, there) || is_needless(next, in, g) ||
          (judged_whole && !rules_.any_leg_ok(from, here, there))) {
        continue;
      }
      push({g, next, index, kNone, in, false}, to, there);
    }
  }

  static Cell cell_at(const Cell& c, int d) {
    const Cell o = kit::offset(d);
    return {c[0] + o[0], c[1] + o[1], c[2] + o[2]};
  }

  bool memory_full() const {
    const std::size_t of_label = sizeof(Label) + resources_.size() * sizeof(double);
    return first_of_.size() * sizeof(std::uint32_t) + labels_.size() * of_label +
               open_.size() * sizeof(kit::OpenList::Entry) + rules_.bytes() + means_bytes() >
           settings_.max_bytes;
  }

  Polyline route_to(std::uint32_t last, bool at_goal) const {
    return route_along(labels_, last, at_goal,
                       [&](std::uint32_t cell) { return lattice_.cell(cell); });
  }

  std::vector<kit::Resource> resources_;
  bool by_step_;                         ///< constraints depend on two legs
  std::vector<std::uint32_t> first_of_;  ///< label of each cell
  std::vector<Label> labels_;
  std::vector<double> spent_;   ///< totals of each label
  std::vector<double> totals_;  ///< of the path at hand
};
}  // namespace altiplan::astar
