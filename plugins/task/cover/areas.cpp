// SPDX-License-Identifier: Apache-2.0
#include "areas.hpp"

#include <algorithm>

#include "altiplan/kit/tour.hpp"

namespace altiplan::cover {
namespace {

struct Link {
  Point2 from;
  Point2 to;
  double length() const { return (to - from).norm(); }
};

Point2 within(const Area& area, const Point2& p) {
  return area.is_outside(p) ? area.nearest(p) : p;
}

/// The shortest between two outlines, which do not cross: it ends at a corner of one of them.
Link between(const Area& a, const Area& b) {
  Link shortest{a.outline()[0], b.nearest(a.outline()[0])};
  const auto take = [&](const Link& link) {
    shortest = link.length() < shortest.length() ? link : shortest;
  };
  for (const Point2& corner : a.outline()) {
    take({corner, b.nearest(corner)});
  }
  for (const Point2& corner : b.outline()) {
    take({a.nearest(corner), corner});
  }
  return shortest;
}

/// Pieces of a tour: the areas, and one that leads from the goal back to the start.
std::vector<std::size_t> order_of(const std::vector<Area>& areas,
                                  const std::optional<Point2>& start,
                                  const std::optional<Point2>& goal, bool closed) {
  constexpr int kRounds = 2000;
  const std::size_t n = areas.size();
  const bool has_ends = start || goal || !closed;
  const std::size_t ends = 2 * (n + (has_ends ? 1 : 0));
  const auto& last = goal || !closed ? goal : start;
  std::vector<double> cost(ends * ends, 0);
  const auto set = [&](std::size_t i, std::size_t j, double length) {
    cost[i * ends + j] = cost[j * ends + i] = length;
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double length = between(areas[i], areas[j]).length();
      for (const std::size_t from : {2 * i, 2 * i + 1}) {
        set(from, 2 * j, length);
        set(from, 2 * j + 1, length);
      }
    }
    for (const std::size_t from : {2 * i, 2 * i + 1}) {
      if (has_ends && last) {
        set(from, 2 * n, (within(areas[i], *last) - *last).norm());
      }
      if (has_ends && start) {
        set(from, 2 * n + 1, (within(areas[i], *start) - *start).norm());
      }
    }
  }
  kit::Tour tour(ends / 2, std::move(cost));
  tour.construct();
  tour.improve(1, [left = kRounds]() mutable { return left-- <= 0; });
  std::vector<int> entries = tour.entries();
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](int end) { return std::size_t(end / 2) == n; });
  if (found != entries.end()) {
    const bool is_backwards = std::size_t(*found) == 2 * n + 1;  // entered at the start
    std::rotate(entries.begin(), found, entries.end());
    entries.erase(entries.begin());
    if (is_backwards) {
      std::reverse(entries.begin(), entries.end());
    }
  }
  std::vector<std::size_t> order;
  for (const int entry : entries) {
    order.push_back(std::size_t(entry / 2));
  }
  return order;
}
}  // namespace

std::vector<Stage> stages_of(const std::vector<Area>& areas, const std::optional<Point2>& start,
                             const std::optional<Point2>& goal, bool closed) {
  const std::size_t n = areas.size();
  const std::vector<std::size_t> order =
      n > 1 ? order_of(areas, start, goal, closed) : std::vector<std::size_t>{0};
  std::vector<Stage> stages;
  for (const std::size_t k : order) {
    stages.push_back({&areas[k], {}, {}, false});
  }
  for (std::size_t k = 1; k < n; ++k) {
    const Link link = between(*stages[k - 1].area, *stages[k].area);
    stages[k - 1].goal = link.from;
    stages[k].start = link.to;
  }
  Stage& first = stages.front();
  Stage& last = stages.back();
  if (start) {
    first.start = within(*first.area, *start);
  }
  if (goal) {
    last.goal = within(*last.area, *goal);
  } else if (closed && start) {
    last.goal = within(*last.area, *start);
  } else if (closed && n > 1) {
    const Link link = between(*last.area, *first.area);
    last.goal = link.from;
    first.start = link.to;
  }
  for (Stage& stage : stages) {
    const bool is_anywhere = !stage.start && !stage.goal;
    stage.closed = !goal && (is_anywhere ? closed : stage.start == stage.goal);
    if (stage.closed) {
      stage.goal.reset();
    }
  }
  return stages;
}
}  // namespace altiplan::cover
