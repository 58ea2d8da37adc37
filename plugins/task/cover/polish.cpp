// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "flown.hpp"

namespace altiplan::cover {
namespace {

/// Local moves of waypoints, each kept where it saves enough time for what it uncovers.
class Polish {
 public:
  Polish(const Problem& problem, const Area& area, Flown& flown, Swept& swept, double allowed)
      : problem_(problem), area_(area), flown_(flown), swept_(swept), allowed_(allowed) {}

  void run() {
    for (const double per_m2 : {60.0, 15.0, 4.0}) {  // seconds by square metre
      per_m2_ = per_m2;
      changed_.clear();
      for (int round = 0; round < 4 && (round == 0 || !changed_.empty()); ++round) {
        pass_over(round == 0);
      }
    }
  }

 private:
  const Point2& at(std::size_t i) const { return flown_.points[i]; }
  double length(std::size_t leg) const { return (at(leg + 1) - at(leg)).norm(); }
  /// A row keeps its line: its ends move along it alone.
  bool is_line(std::size_t leg) const {
    return flown_.is_row[leg] && length(leg) > 3 * problem_.spacing_m;
  }
  /// A long join is not swept again for a small move.
  bool is_far(std::size_t leg) const {
    return !flown_.is_row[leg] && length(leg) > 6 * problem_.spacing_m;
  }

  /// All waypoints, or those near what the last round changed.
  void pass_over(bool all) {
    const Ring2 before = std::exchange(changed_, {});
    const double near = 2 * problem_.spacing_m;
    for (std::size_t i = 1; i + 1 < flown_.points.size(); ++i) {
      const bool is_near = all || std::any_of(before.begin(), before.end(), [&](const Point2& p) {
                             return (p - at(i)).squaredNorm() < near * near;
                           });
      if (!is_near) {
        continue;
      }
      const Point2 p = at(i);
      if (drop(i)) {
        changed_.push_back(p);
        --i;
      } else if (merge(i) || shift(i)) {
        changed_.push_back(p);
      }
    }
  }

  bool drop(std::size_t i) {
    if (is_line(i - 1) || is_line(i)) {
      return false;
    }
    const bool is_of_row = flown_.is_row[i - 1] || flown_.is_row[i];
    return !(is_of_row && (is_far(i - 1) || is_far(i))) &&
           attempt(i, i, {}, {at(i - 1), at(i), at(i + 1)});
  }

  /// Two bends become one, where their outer legs meet.
  bool merge(std::size_t i) {
    if (i + 2 >= flown_.points.size() || flown_.is_row[i] || is_far(i)) {
      return false;
    }
    const Point2 d = at(i) - at(i - 1);
    const Point2 e = at(i + 1) - at(i + 2);
    const double cross = d.x() * e.y() - d.y() * e.x();
    if (std::abs(cross) < 1e-6 * d.norm() * e.norm()) {
      return false;
    }
    const Point2 f = at(i + 2) - at(i - 1);
    const double s = (f.x() * e.y() - f.y() * e.x()) / cross;
    const Point2 x = at(i - 1) + s * d;
    return s > 0 && (x - at(i)).norm() < 3 * problem_.spacing_m &&
           attempt(i, i + 1, {x}, {at(i), at(i + 1), x});
  }

  /// Towards a neighbour, both, or aside; the end of a row along it.
  bool shift(std::size_t i) {
    const bool from_line = is_line(i - 1);
    const bool to_line = is_line(i);
    if ((from_line && to_line) || (!from_line && !to_line && (is_far(i - 1) || is_far(i)))) {
      return false;
    }
    bool moved = false;
    for (const double by : {0.4, 0.15, 0.05}) {
      const auto towards = [&](const Point2& p) {
        const double away = (p - at(i)).norm();
        return away > 1e-9 ? Point2((p - at(i)) / away) : Point2(0, 0);
      };
      const Point2 back = towards(at(i - 1));
      const Point2 on = towards(at(i + 1));
      const Ring2 ways = from_line ? Ring2{back, -back}
                         : to_line ? Ring2{on, -on}
                                   : Ring2{back, on, back + on, back - on};
      for (const Point2& way : ways) {
        if (way.norm() < 1e-6) {
          continue;
        }
        const Point2 to = at(i) + by * problem_.half() * way.normalized();
        Ring2 about{at(i), to};
        if (!from_line) {
          about.push_back(at(i - 1));
        }
        if (!to_line) {
          about.push_back(at(i + 1));
        }
        if (attempt(i, i, {to}, about)) {
          moved = true;
          break;
        }
      }
    }
    return moved;
  }

  /// Others in place of the points i..j; what is covered changes near `about` alone.
  bool attempt(std::size_t i, std::size_t j, const Ring2& by, const Ring2& about) {
    std::vector<Segment> old;
    double saved = 0;
    for (std::size_t k = i - 1; k <= j; ++k) {
      old.push_back(flown_.leg(k));
      saved += problem_.time.between(at(k), at(k + 1));
    }
    std::vector<Segment> legs;
    Point2 from = at(i - 1);
    for (const Point2& p : by) {
      legs.push_back({from, p});
      from = p;
    }
    legs.push_back({from, at(j + 1)});
    for (const Segment& leg : legs) {
      saved -= problem_.time.between(leg.a, leg.b);
    }
    const bool is_clear = saved > 1e-6 && std::all_of(legs.begin(), legs.end(), [&](auto& leg) {
                            return area_.sees(leg.a, leg.b);
                          });
    const double enough = std::min(saved / per_m2_, std::max(0.0, allowed_ - swept_.uncovered()));
    if (!is_clear || swept_.lost(old, legs, about, enough) > enough) {
      return false;
    }
    swept_.replace(old, legs, about);
    flown_.replace(i, j, by);
    return true;
  }

  const Problem& problem_;
  const Area& area_;
  Flown& flown_;
  Swept& swept_;
  double allowed_;
  double per_m2_ = 1;
  Ring2 changed_;  ///< places of this round
};
}  // namespace

void polish(const Problem& problem, const Area& area, Flown& flown, Swept& swept, double allowed) {
  Polish(problem, area, flown, swept, allowed).run();
}
}  // namespace altiplan::cover
