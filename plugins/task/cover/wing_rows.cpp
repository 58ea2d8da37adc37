// SPDX-License-Identifier: Apache-2.0
#include "wing_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "altiplan/kit/dubins/dubins.hpp"
#include "altiplan/kit/tour.hpp"

namespace altiplan::cover {
namespace {

constexpr int kAcross = 8;       // samples across half of a strip
constexpr double kShort = 1e-3;  // metres: no row

/// Ends of the rows on a line, moved out to where the strip about it leaves the outline, and
/// beyond.
std::array<bool, 2> reach_out(const WingProblem& problem, const Area& outline, double y,
                              double& from, double& to) {
  constexpr double kSame = 1e-6;
  const auto parts = outline.along_row(y);
  const auto begins = [&](double x, bool at_end) {
    return std::any_of(parts.begin(), parts.end(), [&](const std::pair<double, double>& part) {
      return std::abs((at_end ? part.second : part.first) - x) < kSame;
    });
  };
  const bool is_west_free = begins(from, false);
  const bool is_east_free = begins(to, true);
  const double west = from;
  const double east = to;
  for (int k = -kAcross; k <= kAcross; ++k) {
    const double beside = std::clamp(y + k * problem.spacing_m / 2 / kAcross,
                                     outline.min().y() + kSame, outline.max().y() - kSame);
    for (const auto& [first, last] : outline.along_row(beside)) {
      if (last > west && first < east) {
        from = is_west_free ? std::min(from, first) : from;
        to = is_east_free ? std::max(to, last) : to;
      }
    }
  }
  from -= is_west_free ? problem.beyond_m : 0;
  to += is_east_free ? problem.beyond_m : 0;
  return {is_west_free, is_east_free};
}

/// The fewest rows at even distances; those of a direction run east where all is turned by `angle`.
std::vector<WingRow> rows_of(const WingProblem& problem, double angle) {
  std::vector<WingRow> rows;
  for (const WingProblem::Field& field : problem.fields) {
    const Area area = field.area.turned(angle);
    const Area outline = field.outline.turned(angle);
    const double low = area.min().y();
    const double height = area.max().y() - low;
    const int count = std::max(1, int(std::ceil(height / problem.spacing_m - 1e-9)));
    for (int i = 0; i < count; ++i) {
      const double middle = low + (i + 0.5) * height / count;
      std::vector<std::pair<double, double>> of_strip;
      const auto add = [&](double y, double from, double to) {
        std::array<bool, 2> leads = reach_out(problem, outline, y, from, to);
        if (problem.beyond_m == 0) {
          leads = {false, false};
        }
        of_strip.emplace_back(from, to);
        rows.push_back(
            {{turned({from, y}, -angle), turned({to, y}, -angle)}, {leads[0], leads[1]}});
      };
      // In the middle of the strip; then in arms of the outline that no row passes, from there
      // outward.
      for (int k = 0; k <= 2 * kAcross; ++k) {
        const int step = k % 2 == 0 ? k / 2 : -(k + 1) / 2;
        const double y = middle + step * height / count / 2 / kAcross;
        const std::size_t known = of_strip.size();
        for (const auto& arm : outline.along_row(y)) {
          const bool is_passed = std::any_of(
              of_strip.begin(), of_strip.begin() + std::ptrdiff_t(known),
              [&](const auto& row) { return row.first < arm.second && row.second > arm.first; });
          for (const auto& [from, to] : area.along_row(y)) {
            if (!is_passed && to - from > kShort && from < arm.second && to > arm.first) {
              add(y, from, to);
            }
          }
        }
      }
    }
  }
  return rows;
}

/// Angles that turn a direction of rows east.
std::vector<double> directions(const WingProblem& problem) {
  constexpr std::size_t kMaxEdges = 16;
  constexpr int kOthers = 12;
  constexpr double kSame = 1e-3;
  std::vector<std::pair<double, double>> edges;  // length and angle
  for (const WingProblem::Field& field : problem.fields) {
    const Ring2& ring = field.outline.outline();
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const Point2 way = ring[i] - ring[j];
      edges.emplace_back(way.norm(), -std::atan2(way.y(), way.x()));
    }
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  edges.resize(std::min(edges.size(), kMaxEdges));
  for (int k = 0; k < kOthers; ++k) {
    edges.emplace_back(0, k * kPi / kOthers);
  }
  std::vector<double> angles;
  for (const auto& edge : edges) {
    if (std::none_of(angles.begin(), angles.end(), [&](double other) {
          return std::abs(std::remainder(edge.second - other, kPi)) < kSame;
        })) {
      angles.push_back(edge.second);
    }
  }
  return angles;
}

/// A row's ends are 2k and 2k + 1; the last piece leads from the goal to the start.
class Order {
 public:
  Order(const WingProblem& problem, std::vector<WingRow> rows)
      : problem_(problem), rows_(std::move(rows)) {
    has_ends_ = problem.start || problem.goal || !problem.closed;
    pieces_ = rows_.size() + (has_ends_ ? 1 : 0);
    for (std::size_t i = 0; i < 2 * pieces_; ++i) {
      for (std::size_t j = 0; j < 2 * pieces_; ++j) {
        costs_.push_back(cost(i, j));
      }
    }
  }

  std::size_t pieces() const { return pieces_; }
  const std::vector<double>& costs() const { return costs_; }

  std::vector<WingRow> flown(std::vector<int> entries) const {
    if (has_ends_) {
      const int last = int(rows_.size());
      std::rotate(
          entries.begin(),
          std::find_if(entries.begin(), entries.end(), [&](int e) { return e / 2 == last; }),
          entries.end());
      if (entries[0] % 2 == 1) {  // from the start to the goal: all the other way round
        std::reverse(entries.begin() + 1, entries.end());
        for (int& entry : entries) {
          entry ^= 1;
        }
      }
      entries.erase(entries.begin());
    }
    std::vector<WingRow> flown;
    for (const int entry : entries) {
      const WingRow& row = rows_[std::size_t(entry / 2)];
      flown.push_back(
          entry % 2 == 0 ? row : WingRow{{row.line.b, row.line.a}, {row.leads[1], row.leads[0]}});
    }
    return flown;
  }

 private:
  bool is_row(std::size_t end) const { return end / 2 < rows_.size(); }
  const Point2& at(std::size_t end) const {
    const Segment& line = rows_[end / 2].line;
    return end % 2 == 0 ? line.a : line.b;
  }
  /// With the course outwards.
  Pose leaving(std::size_t end) const {
    const Point2 way = at(end) - at(end ^ 1U);
    return {Vec3(at(end).x(), at(end).y(), 0), std::atan2(way.y(), way.x())};
  }
  double cost(std::size_t i, std::size_t j) const {
    if (is_row(i) && is_row(j)) {
      Pose into = leaving(j);
      into.heading += kPi;
      return kit::dubins_length(leaving(i), into, problem_.radius_m);
    }
    if (!is_row(i) && !is_row(j)) {
      return 0;
    }
    const std::size_t own = is_row(i) ? i : j;
    const std::optional<Point2>& place =
        (is_row(i) ? j : i) % 2 == 0 ? problem_.goal : problem_.start;
    return place ? (at(own) - *place).norm() : 0;
  }

  const WingProblem& problem_;
  std::vector<WingRow> rows_;
  bool has_ends_ = false;
  std::size_t pieces_ = 0;
  std::vector<double> costs_;
};

double metres(const std::vector<WingRow>& rows) {
  double sum = 0;
  for (const WingRow& row : rows) {
    sum += row.length();
  }
  return sum;
}
}  // namespace

WingRows wing_rows(const WingProblem& problem, int attempts, std::uint64_t seed,
                   const std::function<std::string(const WingRow&)>& refusal,
                   const std::function<bool(std::uint64_t)>& spent) {
  constexpr std::uint64_t kRounds = 2000;
  std::vector<std::pair<double, std::vector<WingRow>>> all;  // by metres, with a turn for each
  for (const double angle : directions(problem)) {
    std::vector<WingRow> rows = rows_of(problem, angle);
    const double estimate = metres(rows) + double(rows.size()) * kPi * problem.radius_m;
    if (!rows.empty()) {
      all.emplace_back(estimate, std::move(rows));
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  WingRows best;
  double shortest = kInfinity;
  for (std::size_t k = 0; k < all.size() && best.iterations < std::uint64_t(attempts); ++k) {
    if (spent(best.iterations)) {
      best.is_complete = false;
      break;
    }
    const std::vector<WingRow>& rows = all[k].second;
    std::string problem_of_row;
    for (std::size_t i = 0; i < rows.size() && problem_of_row.empty(); ++i) {
      problem_of_row = refusal(rows[i]);
    }
    if (!problem_of_row.empty()) {
      best.message = best.message.empty() ? problem_of_row : best.message;
      continue;
    }
    const Order order(problem, rows);
    std::vector<int> entries{0};
    double joins = 0;
    if (order.pieces() > 1) {
      kit::Tour tour(order.pieces(), order.costs());
      tour.construct();
      std::uint64_t rounds = 0;
      tour.improve(seed + k, [&] { return rounds++ == kRounds; });
      entries = tour.entries();
      joins = tour.cost();
    }
    ++best.iterations;
    if (metres(rows) + joins < shortest) {
      shortest = metres(rows) + joins;
      best.rows = order.flown(entries);
    }
  }
  return best;
}
}  // namespace altiplan::cover
