// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/request.hpp"

namespace altiplan::reference {

/// Exhaustive search in space and time over the cells of a box, which shares nothing with SIPP but
/// the problem: it propagates *sets of times* at which the vehicle can be at a cell, unions of
/// intervals, until none grows. When a leg may be flown comes of the judge's own separation, which
/// is convex in the time of departure (a point and a convex obstacle in uniform motion): its
/// minimum by ternary search, its level sets by bisection. No safe interval keeps one arrival
/// alone, and no order of expansion or estimate is involved.
class TimedReach {
 public:
  using Interval = std::pair<double, double>;
  using Times = std::vector<Interval>;  ///< disjoint, ascending

  /// Cell c of `counts` lies at low + cell_m * c; `horizon_s` must be later than anything moves
  /// through the box.
  TimedReach(const Request& request, const Cell& counts, const Vec3& low, double cell_m,
             double horizon_s)
      : request_(request), counts_(counts), low_(low), cell_m_(cell_m), horizon_s_(horizon_s) {}

  /// The earliest arrival; nothing if the goal cannot be reached before the horizon.
  std::optional<double> earliest(const Cell& start, const Cell& goal) {
    std::vector<Times> at(std::size_t(counts_[0] * counts_[1] * counts_[2]));
    std::vector<Cell> queue;
    grow(at[id(start)], {{0.0, 0.0}}, start);
    queue.push_back(start);
    while (!queue.empty()) {
      const Cell c = queue.back();
      queue.pop_back();
      each_neighbour(c, [&](const Cell& n) {
        if (grow(at[id(n)], moved(c, n, at[id(c)]), n)) {
          queue.push_back(n);
        }
      });
    }
    const Times& found = at[id(goal)];
    return found.empty() ? std::nullopt : std::optional(found.front().first);
  }

 private:
  std::size_t id(const Cell& c) const {
    return std::size_t((c[2] * counts_[1] + c[1]) * counts_[0] + c[0]);
  }
  Vec3 place(const Cell& c) const { return low_ + cell_m_ * Vec3(c[0], c[1], c[2]); }
  double duration(const Cell& a, const Cell& b) const {
    const Vec3 way = place(b) - place(a);
    const Vehicle& vehicle = request_.vehicle;
    if (!std::isfinite(vehicle.climb_mps)) {
      return way.norm() / vehicle.speed_mps;
    }
    return std::max({way.head<2>().norm() / vehicle.speed_mps, way.z() / vehicle.climb_mps,
                     -way.z() / vehicle.sink_mps});
  }

  template <class Use>
  void each_neighbour(const Cell& c, const Use& use) const {
    for (int n = 0; n < 27; ++n) {
      const Cell o{c[0] + n % 3 - 1, c[1] + n / 3 % 3 - 1, c[2] + n / 9 - 1};
      bool inside = o != c;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        inside = inside && o[axis] >= 0 && o[axis] < counts_[axis];
      }
      if (inside && leg_ok(std::nullopt, place(c), place(o), request_)) {
        use(o);
      }
    }
  }

  /// The open interval of departures on which the judge's distance is below what is required.
  std::optional<Interval> unsafe(const MovingObstacle& obstacle, const Vec3& a, const Vec3& b,
                                 double seconds) const {
    const double needed = std::max(request_.limits.min_clearance, request_.vehicle.reach_m());
    const auto distance = [&](double t) { return separation(obstacle, a, t, b, t + seconds); };
    double low = -horizon_s_;
    double high = 2 * horizon_s_;
    const double first = low;
    const double last = high;
    while (high - low > 1e-9 && distance((low + high) / 2) >= needed) {
      const double third = (high - low) / 3;
      (distance(low + third) <= distance(high - third) ? high : low) =
          distance(low + third) <= distance(high - third) ? high - third : low + third;
    }
    const double inside = (low + high) / 2;
    if (distance(inside) >= needed) {
      return std::nullopt;
    }
    const auto border = [&](double far) {
      double near = inside;
      if (distance(far) < needed) {
        return far;
      }
      for (int i = 0; i < 70; ++i) {
        const double middle = (near + far) / 2;
        (distance(middle) < needed ? near : far) = middle;
      }
      return far;
    };
    return Interval{border(first), border(last)};
  }

  /// The times of [0, horizon] outside the unsafe intervals of a leg, or of a stay (a == b).
  const Times& free_times(const Cell& a, const Cell& b) {
    Times& free = free_[{id(a), id(b)}];
    if (free.empty()) {
      std::vector<Interval> unsafe_times;
      for (const MovingObstacle& obstacle : request_.world->moving()) {
        if (const auto times = unsafe(obstacle, place(a), place(b), duration(a, b))) {
          unsafe_times.push_back(*times);
        }
      }
      std::sort(unsafe_times.begin(), unsafe_times.end());
      double from = 0;
      for (const Interval& times : unsafe_times) {
        if (times.first >= from) {
          free.push_back({from, times.first});
        }
        from = std::max(from, times.second);
      }
      if (from <= horizon_s_) {
        free.push_back({from, horizon_s_});
      }
      if (free.empty()) {
        free.push_back({1, 0});  // none: known, and empty
      }
    }
    return free;
  }

  Times moved(const Cell& a, const Cell& b, const Times& there) {
    Times arrivals;
    for (const Interval& free : free_times(a, b)) {
      for (const Interval& times : there) {
        const double first = std::max(free.first, times.first);
        const double last = std::min(free.second, times.second);
        if (first <= last) {
          arrivals.push_back({first + duration(a, b), last + duration(a, b)});
        }
      }
    }
    return arrivals;
  }

  /// Adds the arrivals, each with the waits that may follow it; true if the set has grown.
  bool grow(Times& at, const Times& arrivals, const Cell& c) {
    Times all = at;
    for (const Interval& arrival : arrivals) {
      for (const Interval& free : free_times(c, c)) {
        const double first = std::max(free.first, arrival.first);
        if (first <= std::min(free.second, arrival.second) + kSame) {
          all.push_back({first, free.second});
        }
      }
    }
    std::sort(all.begin(), all.end());
    Times joined;
    for (const Interval& each : all) {
      if (!joined.empty() && each.first <= joined.back().second) {
        joined.back().second = std::max(joined.back().second, each.second);
      } else {
        joined.push_back(each);
      }
    }
    bool has_grown = joined.size() != at.size();
    for (std::size_t i = 0; !has_grown && i < at.size(); ++i) {
      has_grown = joined[i].first < at[i].first - kSame || joined[i].second > at[i].second + kSame;
    }
    at = has_grown ? joined : at;
    return has_grown;
  }

  static constexpr double kSame = 1e-9;  // seconds

  const Request& request_;
  Cell counts_;
  Vec3 low_;
  double cell_m_;
  double horizon_s_;
  std::map<std::pair<std::size_t, std::size_t>, Times> free_;
};
}  // namespace altiplan::reference
