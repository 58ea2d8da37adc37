// SPDX-License-Identifier: Apache-2.0
#include "sweep.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "altiplan/geometry.hpp"
#include "altiplan/kit/tour.hpp"
#include "pattern.hpp"

namespace altiplan::cover {
namespace {

constexpr std::uint64_t kRounds = 3000;  // perturbations of a tour, by attempt
constexpr double kSmallGap = 0.02;       // of the square of half a spacing

/// Pieces of a tour: lines, stops in pockets, and one that leads from the goal back to the start.
struct Pieces {
  std::vector<Segment> lines;
  std::size_t rows = 0;             ///< the first of the lines
  std::optional<std::size_t> ends;  ///< index of the piece from goal to start
  bool is_start_free = false;
  bool is_goal_free = false;

  Ring2 points() const {
    Ring2 all;
    for (const Segment& line : lines) {
      all.push_back(line.a);
      all.push_back(line.b);
    }
    return all;
  }
  bool is_free(std::size_t end) const {
    return ends && end / 2 == *ends && (end % 2 == 0 ? is_goal_free : is_start_free);
  }
};

class Attempt {
 public:
  Attempt(const Problem& problem, const Pattern& pattern)
      : problem_(problem),
        area_(problem.area.turned(pattern.angle)),
        swept_(area_, problem.half(), cell()) {
    pieces_.lines = pattern.lines;
    pieces_.rows = pattern.lines.size();
    add_ends(pattern.angle);
  }

  /// Nothing if it is spent before it has ended.
  std::optional<Flown> run(std::uint64_t seed, std::uint64_t rounds,
                           const std::function<bool(std::uint64_t)>& spent) {
    Swept rows = swept_;
    for (std::size_t i = 0; i < pieces_.rows; ++i) {
      rows.add(pieces_.lines[i]);
    }
    std::optional<Joins> joins(std::in_place, area_, problem_.time, pieces_.points());
    std::vector<double> costs = costs_of(*joins, rows);
    if (!pockets_.empty()) {  // no join passes them: they are flown to
      pieces_.lines.insert(pieces_.lines.end(), pockets_.begin(), pockets_.end());
      joins.emplace(area_, problem_.time, pieces_.points());
      costs = costs_of(*joins, rows);
    }
    kit::Tour tour(pieces_.lines.size(), std::move(costs));
    tour.construct();
    std::uint64_t round = 0;
    bool is_cut = false;
    tour.improve(seed, [&] {
      is_cut = is_cut || spent(round);
      return is_cut || ++round > rounds;
    });
    if (is_cut) {
      return std::nullopt;
    }
    Flown flown = as_legs(*joins, tour.entries());
    for (std::size_t i = 0; i < flown.legs(); ++i) {
      swept_.add(flown.leg(i));
    }
    repair(problem_, area_, flown, swept_, 0.3 * problem_.allowed());
    polish(problem_, area_, flown, swept_, 0.6 * problem_.allowed());
    flown.drop_repeats();
    return flown;
  }

 private:
  double cell() const {
    const Point2 size = area_.max() - area_.min();
    return std::max(problem_.spacing_m / 25, std::sqrt(size.x() * size.y() / 4e6));
  }

  /// Without a start or a goal an open tour begins or ends anywhere: joins with such an end cost
  /// nothing.
  void add_ends(double angle) {
    if (problem_.closed && !problem_.start && !problem_.goal) {
      return;
    }
    pieces_.is_start_free = !problem_.start && !problem_.closed;
    pieces_.is_goal_free = !problem_.goal && !problem_.closed;
    const Point2 any = pieces_.lines[0].a;
    const Point2 start = turned(problem_.start.value_or(problem_.goal.value_or(any)), angle);
    const Point2 goal = turned(problem_.goal.value_or(problem_.start.value_or(any)), angle);
    pieces_.ends = pieces_.lines.size();
    pieces_.lines.push_back(
        {pieces_.is_goal_free ? any : goal, pieces_.is_start_free ? any : start});
  }

  /// Seconds of the joins between ends, less what a stop would take where a join covers a gap that
  /// the rows leave. Gaps that no join covers, and no end sees, become pockets.
  std::vector<double> costs_of(const Joins& joins, const Swept& rows) {
    const std::size_t n = joins.size();
    std::vector<double> cost(n * n);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        const bool is_free = pieces_.is_free(i) || pieces_.is_free(j);
        cost[i * n + j] = is_free ? 0 : joins.time(int(i), int(j));
      }
    }
    pockets_.clear();
    for (const std::vector<Point2>& gap : rows.gaps()) {
      if (rows.square_metres(gap.size()) < kSmallGap * problem_.half() * problem_.half()) {
        break;
      }
      reward(joins, rows, gap, cost);
    }
    return cost;
  }

  void reward(const Joins& joins, const Swept& rows, const std::vector<Point2>& gap,
              std::vector<double>& cost) {
    Point2 centre(0, 0);
    for (const Point2& p : gap) {
      centre += p / double(gap.size());
    }
    const double far = 3 * problem_.spacing_m;
    std::vector<int> near;
    bool is_served = false;
    for (int i = 0; i < int(joins.size()); ++i) {
      if ((joins.point(i) - centre).norm() < far) {
        near.push_back(i);
        is_served = is_served || area_.sees(joins.point(i), centre);
      }
    }
    const double saved = 0.95 * problem_.time.of(problem_.half());
    for (const int i : near) {
      for (const int j : near) {
        if (j < i && joins.time(i, j) <= problem_.time.of(far) &&
            covers_most(joins, rows, i, j, gap)) {
          cost[std::size_t(i) * joins.size() + std::size_t(j)] -= saved;
          cost[std::size_t(j) * joins.size() + std::size_t(i)] -= saved;
          is_served = true;
        }
      }
    }
    if (!is_served && pieces_.lines.size() == pieces_.rows + (pieces_.ends ? 1 : 0)) {
      const std::vector<Segment> stops = stops_for(problem_, area_, rows, gap);
      pockets_.insert(pockets_.end(), stops.begin(), stops.begin() + (stops.empty() ? 0 : 1));
    }
  }

  static bool covers_most(const Joins& joins, const Swept& rows, int i, int j,
                          const std::vector<Point2>& gap) {
    Ring2 way{joins.point(i)};
    for (const Point2& corner : joins.corners(i, j)) {
      way.push_back(corner);
    }
    way.push_back(joins.point(j));
    std::size_t covered = 0;
    for (const Point2& p : gap) {
      for (std::size_t k = 1; k < way.size(); ++k) {
        if (rows.covers({way[k - 1], way[k]}, p)) {
          ++covered;
          break;
        }
      }
    }
    return double(covered) >= 0.9 * double(gap.size());
  }

  /// The tour's waypoints, from the start on if there is one.
  Flown as_legs(const Joins& joins, std::vector<int> entries) const {
    if (pieces_.ends) {
      const auto at = std::find_if(entries.begin(), entries.end(),
                                   [&](int end) { return std::size_t(end / 2) == *pieces_.ends; });
      std::rotate(entries.begin(), at, entries.end());
      if (entries[0] % 2 == 1) {  // entered at the start: it runs backwards
        std::reverse(entries.begin() + 1, entries.end());
        for (int& end : entries) {
          end ^= 1;
        }
      }
    }
    Flown flown;
    const auto go_to = [&](const Point2& p, bool along_row) {
      if (!flown.points.empty()) {
        flown.is_row.push_back(along_row);
      }
      flown.points.push_back(p);
    };
    for (std::size_t k = 0; k < entries.size(); ++k) {
      const int in = entries[k];
      const int out = in ^ 1;
      const int next = entries[(k + 1) % entries.size()];
      const bool is_ends = pieces_.ends && std::size_t(in / 2) == *pieces_.ends;
      if (k == 0 && !is_ends) {
        go_to(joins.point(in), false);
      }
      if (!is_ends) {
        go_to(joins.point(out), std::size_t(in / 2) < pieces_.rows);
      } else if (!pieces_.is_start_free) {
        go_to(joins.point(out), false);
      }
      if (pieces_.is_free(std::size_t(out))) {
        go_to(joins.point(next), false);
      } else if (!pieces_.is_free(std::size_t(next))) {
        for (const Point2& corner : joins.corners(out, next)) {
          go_to(corner, false);
        }
        go_to(joins.point(next), false);
      }
    }
    return flown;
  }

  const Problem& problem_;
  Area area_;
  Swept swept_;
  Pieces pieces_;
  std::vector<Segment> pockets_;
};

/// By finer samples than any choice has seen: repairs what is uncovered by them.
Swept finish(const Problem& problem, Flown& flown) {
  const Point2 size = problem.area.max() - problem.area.min();
  const double cell = std::max(problem.spacing_m / 60, std::sqrt(size.x() * size.y() / 16e6));
  Swept swept(problem.area, problem.half(), cell);
  for (std::size_t i = 0; i < flown.legs(); ++i) {
    swept.add(flown.leg(i));
  }
  repair(problem, problem.area, flown, swept, problem.allowed());
  flown.drop_repeats();
  flown.time_s = flown.seconds(problem.time);
  return swept;
}

/// Rows in any order, however joined, take at least this long.
double bound_of(const Problem& problem, const Flown& flown) {
  constexpr int kSteps = 100;
  Ring2 ends;
  double rows = 0;
  for (std::size_t i = 0; i < flown.legs(); ++i) {
    if (flown.is_row[i]) {
      ends.push_back(flown.points[i]);
      ends.push_back(flown.points[i + 1]);
      rows += problem.time.between(flown.points[i], flown.points[i + 1]);
    }
  }
  const std::size_t n = ends.size();
  std::vector<double> cost(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      cost[i * n + j] = i / 2 == j / 2 ? 0 : problem.time.between(ends[i], ends[j]);
    }
  }
  // An open tour is a closed one without its longest join at most.
  double longest = 0;
  if (!problem.closed || problem.goal) {
    longest = n == 0 ? 0 : *std::max_element(cost.begin(), cost.end());
  }
  return rows + kit::tour_bound(n / 2, cost, flown.time_s - rows, kSteps) - longest;
}
}  // namespace

namespace {
/// Takes a tour if it is faster once it is finished.
void take(const Problem& problem, Flown flown, Sweep& best) {
  if (flown.seconds(problem.time) >= best.flown.time_s) {
    return;
  }
  Swept swept = finish(problem, flown);
  if (flown.time_s >= best.flown.time_s) {
    return;
  }
  best.needed.assign(flown.legs(), 0);
  for (std::size_t k = 0; k < flown.legs(); ++k) {
    const Segment leg = flown.leg(k);
    const Point2 about[] = {leg.a, leg.b};
    best.needed[k] = swept.lost({&leg, 1}, {}, about, 0) > 0;
    if (!best.needed[k]) {  // what it shares with another join is that one's now
      swept.replace({&leg, 1}, {}, about);
    }
  }
  best.flown = std::move(flown);
}
}  // namespace

Sweep sweep(const Problem& problem, int attempts, std::uint64_t seed,
            const std::function<bool(std::uint64_t)>& spent) {
  Sweep best;
  Flown first;  // made at once; the others search for the order
  const std::vector<Pattern> tried = patterns(problem);
  for (int i = 0; i <= attempts; ++i) {
    const std::uint64_t rounds = i == 0 ? 1 : kRounds;
    const std::uint64_t done = best.iterations;
    const Pattern& pattern = tried[std::size_t(std::max(0, i - 1)) % tried.size()];
    if (pattern.lines.empty()) {
      continue;
    }
    std::optional<Flown> flown;
    if (!spent(done + rounds - 1)) {
      flown = Attempt(problem, pattern).run(seed + std::uint64_t(i), rounds, [&](auto round) {
        return spent(done + round);
      });
    }
    if (!flown) {
      best.is_complete = false;
      break;
    }
    best.iterations += rounds;
    for (Point2& p : flown->points) {
      p = turned(p, -pattern.angle);
    }
    if (i == 0) {
      first = *std::move(flown);
    } else {
      take(problem, *std::move(flown), best);
    }
  }
  if (!first.points.empty()) {
    take(problem, std::move(first), best);
  }
  if (!best.flown.points.empty()) {
    best.bound_s = std::min(best.flown.time_s, bound_of(problem, best.flown));
  }
  return best;
}
}  // namespace altiplan::cover
