// SPDX-License-Identifier: Apache-2.0
#include "pattern.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/geometry.hpp"

namespace altiplan::cover {
namespace {

/// Rows whose parts cost least, each with a turn, at most a spacing apart: by dynamic programming
/// over positions a sixtieth of the spacing apart.
std::vector<double> cheapest_rows(const Problem& problem, const Area& area) {
  const double low = area.min().y();
  const double high = area.max().y();
  const int count = std::max(1, int(std::ceil((high - low) / (problem.spacing_m / 60))));
  const double by = (high - low) / count;
  const int reach = int(std::floor(problem.spacing_m / by + 1e-9));
  const int border = int(std::floor(problem.half() / by + 1e-9));
  std::vector<double> total(std::size_t(count) + 1, 1e300);
  std::vector<int> from(std::size_t(count) + 1, -1);
  for (int i = 0; i <= count; ++i) {
    double own = 0;
    for (const auto& [west, east] : area.along_row(low + by * i)) {
      own += problem.time.of(east - west) + problem.time.of(problem.spacing_m);
    }
    double& least = total[std::size_t(i)];
    least = i <= border ? own : least;
    for (int j = std::max(0, i - reach); j < i; ++j) {
      if (total[std::size_t(j)] + own < least) {
        least = total[std::size_t(j)] + own;
        from[std::size_t(i)] = j;
      }
    }
  }
  int best = std::max(0, count - border);
  for (int i = best; i <= count; ++i) {
    best = total[std::size_t(i)] < total[std::size_t(best)] ? i : best;
  }
  std::vector<double> rows;
  for (int i = best; i >= 0; i = from[std::size_t(i)]) {
    rows.push_back(low + by * i);
  }
  std::reverse(rows.begin(), rows.end());
  return rows;
}

/// The fewest rows at even distances; `phase` in [0, 1] moves them as far as coverage allows.
std::vector<double> even_rows(const Problem& problem, const Area& area, double phase) {
  const double low = area.min().y();
  const double height = area.max().y() - low;
  const int count = std::max(1, int(std::ceil(height / problem.spacing_m - 1e-9)));
  const double overlap = count * problem.spacing_m - height;
  std::vector<double> rows;
  for (int i = 0; i < count; ++i) {
    rows.push_back(low + problem.half() - phase * overlap + i * problem.spacing_m);
  }
  rows.front() = std::max(rows.front(), low);
  rows.back() = std::min(rows.back(), area.max().y());
  return rows;
}

/// The same with as much overlap between all rows.
std::vector<double> overlapping_rows(const Problem& problem, const Area& area) {
  const double low = area.min().y();
  const double height = area.max().y() - low;
  const int count = std::max(1, int(std::ceil(height / problem.spacing_m - 1e-9)));
  std::vector<double> rows;
  for (int i = 0; i < count; ++i) {
    rows.push_back(count == 1
                       ? low + height / 2
                       : low + problem.half() + i * (height - problem.spacing_m) / (count - 1));
  }
  return rows;
}

void lay(const Problem& problem, const Area& area, const std::vector<double>& rows,
         Pattern& pattern) {
  const double half = problem.half();
  double west = area.min().x();
  double east = area.max().x();
  if (pattern.column != 0) {
    const double x = pattern.column < 0 ? west + half : east - half;
    (pattern.column < 0 ? west : east) = x - pattern.column * half;
    const Area across = area.turned(-kPi / 2);  // (x, y) to (y, -x)
    for (const auto& [from, to] : across.along_row(-x)) {
      pattern.lines.push_back({{x, from}, {x, to}});
    }
  }
  for (const double y : rows) {
    for (const auto& [from, to] : area.along_row(y)) {
      const double first = std::max(from, west);
      const double last = std::min(to, east);
      if (last - first > 0.1 * half) {
        pattern.lines.push_back({{first, y}, {last, y}});
      }
    }
  }
}

/// Lines, a turn for each, and about half of the gaps, which no join passes.
double estimate(const Problem& problem, const Area& area, Swept swept, const Pattern& pattern) {
  const double half = problem.half();
  double sum = 0;
  for (const Segment& line : pattern.lines) {
    swept.add(line);
    sum += problem.time.between(line.a, line.b) + problem.time.of(problem.spacing_m);
  }
  for (const std::vector<Point2>& gap : swept.gaps()) {
    const double size = swept.square_metres(gap.size());
    sum += size < 0.02 * half * half ? 0 : 0.6 * problem.time.of(half) + size / problem.spacing_m;
  }
  if (pattern.column == 0 && problem.closed) {
    sum += 0.5 * problem.time.of(area.max().y() - area.min().y());  // some way back
  }
  return sum;
}
}  // namespace

std::vector<Pattern> patterns(const Problem& problem) {
  std::vector<Pattern> all;
  for (const double angle : {0.0, kPi / 2}) {
    const Area area = problem.area.turned(angle);
    const Point2 size = area.max() - area.min();
    const double cell = std::max(problem.spacing_m / 12, std::sqrt(size.x() * size.y() / 1e6));
    const Swept swept(area, problem.half(), cell);
    std::vector<std::vector<double>> systems{cheapest_rows(problem, area),
                                             overlapping_rows(problem, area)};
    for (const double phase : {0.0, 0.33, 0.67, 1.0}) {
      systems.push_back(even_rows(problem, area, phase));
    }
    for (const std::vector<double>& rows : systems) {
      for (const int column : {0, -1, 1}) {
        Pattern& pattern = all.emplace_back();
        pattern.angle = angle;
        pattern.column = column;
        lay(problem, area, rows, pattern);
        pattern.estimate_s = estimate(problem, area, swept, pattern);
      }
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Pattern& a, const Pattern& b) { return a.estimate_s < b.estimate_s; });
  return all;
}
}  // namespace altiplan::cover
