// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "flown.hpp"

namespace altiplan::cover {
namespace {

/// A gap's longest extent.
struct Extent {
  Point2 centre;
  Point2 from;
  Point2 to;
};

Extent extent_of(const std::vector<Point2>& gap) {
  Point2 centre(0, 0);
  for (const Point2& p : gap) {
    centre += p / double(gap.size());
  }
  const auto farthest = [&](const Point2& from) {
    return *std::max_element(gap.begin(), gap.end(), [&](const Point2& p, const Point2& q) {
      return (p - from).squaredNorm() < (q - from).squaredNorm();
    });
  };
  const Point2 from = farthest(centre);
  return {centre, from, farthest(from)};
}

/// A stop in place of part of a join, or within it.
struct Insertion {
  double cost_s;
  std::size_t leg;
  Segment stop;
};

/// By cost, into the joins that pass nearest.
std::vector<Insertion> insertions(const Problem& problem, const Flown& flown, const Point2& gap,
                                  const std::vector<Segment>& stops) {
  constexpr std::size_t kJoins = 10;
  std::vector<std::pair<double, std::size_t>> joins;
  for (std::size_t i = 0; i < flown.legs(); ++i) {
    if (!flown.is_row[i]) {
      const auto& [a, b] = flown.leg(i);
      joins.emplace_back((a - gap).norm() + (gap - b).norm() - (b - a).norm(), i);
    }
  }
  const std::size_t near = std::min(kJoins, joins.size());
  std::partial_sort(joins.begin(), joins.begin() + std::ptrdiff_t(near), joins.end());
  joins.resize(near);
  std::vector<Insertion> all;
  for (const auto& [detour, i] : joins) {
    const auto& [a, b] = flown.leg(i);
    for (const Segment& stop : stops) {
      for (const Segment& way : {stop, Segment{stop.b, stop.a}}) {
        const double cost = problem.time.between(a, way.a) + problem.time.between(way.a, way.b) +
                            problem.time.between(way.b, b) - problem.time.between(a, b);
        all.push_back({cost, i, way});
      }
    }
  }
  std::sort(all.begin(), all.end(), [](const Insertion& x, const Insertion& y) {
    return x.cost_s < y.cost_s || (x.cost_s == y.cost_s && x.leg < y.leg);
  });
  return all;
}

/// Inserts the cheapest stop that covers most of the gap; returns the square metres that gains.
double cover_gap(const Problem& problem, const Area& area, Flown& flown, Swept& swept,
                 const std::vector<Point2>& gap) {
  constexpr int kTries = 20;
  int tried = 0;
  const std::vector<Segment> stops = stops_for(problem, area, swept, gap);
  for (const Insertion& insertion : insertions(problem, flown, gap[0], stops)) {
    const Segment old[] = {flown.leg(insertion.leg)};
    const auto& [a, b] = old[0];
    const auto& [p, q] = insertion.stop;
    if (!area.sees(a, p) || !area.sees(q, b)) {
      continue;
    }
    std::vector<Segment> by{{a, p}, {q, b}};
    if (p != q) {
      by.push_back(insertion.stop);
    }
    const Point2 about[] = {a, b, p, q};
    const double was = swept.uncovered();
    swept.replace(old, by, about);
    const double gained = was - swept.uncovered();
    if (gained >= 0.5 * swept.square_metres(gap.size()) || (tried > kTries / 3 && gained > 0)) {
      const Ring2 inserted = p == q ? Ring2{p} : Ring2{p, q};
      flown.points.insert(flown.points.begin() + std::ptrdiff_t(insertion.leg) + 1,
                          inserted.begin(), inserted.end());
      flown.is_row.insert(flown.is_row.begin() + std::ptrdiff_t(insertion.leg), inserted.size(), 0);
      return gained;
    }
    swept.replace(by, old, about);
    if (++tried > kTries) {
      break;
    }
  }
  return 0;
}
}  // namespace

std::vector<Segment> stops_for(const Problem& problem, const Area& area, const Swept& swept,
                               const std::vector<Point2>& gap) {
  const auto& [centre, u, v] = extent_of(gap);
  const double half = problem.half();
  const double length = (v - u).norm();
  const Point2 along = length > 1e-9 ? Point2((v - u) / length) : Point2(1, 0);
  const Point2 side(-along.y(), along.x());
  std::vector<Segment> stops;
  const auto offer = [&](const Segment& stop) {
    const bool covers_all =
        std::all_of(gap.begin(), gap.end(), [&](const Point2& p) { return swept.covers(stop, p); });
    if (covers_all && area.sees(stop.a, stop.b)) {
      stops.push_back(stop);
    }
  };
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) {
      const Point2 p = centre + 0.33 * half * (i * along + j * side);
      offer({p, p});
    }
  }
  if (stops.empty() || length > 1.6 * half) {
    for (int j = -4; j <= 4; ++j) {
      for (const double inset : {0.0, 0.4, 0.8, 0.95}) {
        const Point2 by = 0.23 * half * j * side;
        if (2 * inset * half < length) {
          offer({u + inset * half * along + by, v - inset * half * along + by});
        }
      }
    }
  }
  if (stops.empty()) {
    for (const Point2& p : {centre, gap[gap.size() / 2], u, v}) {
      if (area.sees(p, p)) {
        stops.push_back({p, p});
      }
    }
  }
  return stops;
}

void repair(const Problem& problem, const Area& area, Flown& flown, Swept& swept, double allowed) {
  constexpr int kRounds = 6;
  for (int round = 0; round < kRounds; ++round) {
    double left = swept.uncovered();
    if (left <= allowed) {
      return;
    }
    for (const std::vector<Point2>& gap : swept.gaps()) {
      if (left <= allowed) {
        break;
      }
      left -= cover_gap(problem, area, flown, swept, gap);
    }
  }
}
}  // namespace altiplan::cover
