// SPDX-License-Identifier: Apache-2.0
#include "flights.hpp"

#include <algorithm>

namespace altiplan::cover {
namespace {

constexpr double kNotFlown = 1e300;
constexpr int kMaxFlights = 50;

/// Flights of a tour that is cut from one of its waypoints on.
class Cuts {
 public:
  Cuts(const Problem& problem, const Sweep& tour, const Joins& joins, double capacity_s)
      : tour_(tour), joins_(joins), capacity_s_(capacity_s), n_(tour.needed.size()) {
    for (std::size_t i = 0; i < n_; ++i) {
      leg_s_.push_back(problem.time.between(tour.flown.points[i], tour.flown.points[i + 1]));
    }
  }

  /// Least seconds of all flights from waypoint `home` on, at most `count` of them: by dynamic
  /// programming over the waypoint at which each flight turns back.
  double plan(std::size_t home, int count) {
    home_ = home;
    best_.assign(std::size_t(count) + 1, std::vector<double>(n_ + 1, kNotFlown));
    from_.assign(std::size_t(count) + 1, std::vector<std::size_t>(n_ + 1, 0));
    best_[0][0] = 0;
    double least = kNotFlown;
    for (std::size_t m = 0; m < std::size_t(count); ++m) {
      for (std::size_t done = 0; done < n_; ++done) {
        if (best_[m][done] < kNotFlown) {
          fly_on(m, done);
        }
      }
      if (best_[m + 1][n_] < least) {
        least = best_[m + 1][n_];
        flights_ = m + 1;
      }
    }
    return least;
  }

  /// The flights of the last plan.
  std::vector<Flight> made() const {
    std::vector<Flight> all;
    std::size_t end = n_;
    for (std::size_t m = flights_; m > 0; --m) {
      const std::size_t done = from_[m][end];
      const std::size_t first = next_needed(done);
      std::size_t last = end;
      while (!tour_.needed[at(last - 1)]) {
        --last;
      }
      Flight& flight = all.emplace_back();
      flight.points.push_back(point(0));
      go(flight, home_, at(first));
      for (std::size_t i = first; i < last; ++i) {
        flight.points.push_back(point(i + 1));
        flight.needed.push_back(tour_.needed[at(i)]);
      }
      go(flight, at(last), home_);
      end = done;
    }
    std::reverse(all.begin(), all.end());
    return all;
  }

 private:
  /// Index in the tour of the i-th waypoint, or leg, from home.
  std::size_t at(std::size_t i) const { return (home_ + i) % n_; }
  const Point2& point(std::size_t i) const { return joins_.point(int(at(i))); }
  std::size_t next_needed(std::size_t i) const {
    while (i < n_ && !tour_.needed[at(i)]) {
      ++i;
    }
    return i;
  }

  /// Flights from home to what is next, along the tour, and back.
  void fly_on(std::size_t m, std::size_t done) {
    const std::size_t first = next_needed(done);
    double seconds = joins_.time(int(home_), int(at(first)));
    for (std::size_t end = first + 1; end <= n_; ++end) {
      seconds += leg_s_[at(end - 1)];
      if (seconds > capacity_s_) {
        return;
      }
      if (!tour_.needed[at(end - 1)]) {
        continue;
      }
      const double whole = seconds + joins_.time(int(at(end)), int(home_));
      const bool is_all = next_needed(end) == n_;
      const std::size_t reached = is_all ? n_ : end;
      if (whole <= capacity_s_ && best_[m][done] + whole < best_[m + 1][reached]) {
        best_[m + 1][reached] = best_[m][done] + whole;
        from_[m + 1][reached] = done;
      }
    }
  }

  void go(Flight& flight, std::size_t from, std::size_t to) const {
    Ring2 way = joins_.corners(int(from), int(to));
    way.push_back(joins_.point(int(to)));
    for (const Point2& p : way) {
      if ((p - flight.points.back()).norm() > 1e-9) {
        flight.points.push_back(p);
        flight.needed.push_back(0);
      }
    }
  }

  const Sweep& tour_;
  const Joins& joins_;
  double capacity_s_;
  std::size_t n_;
  std::vector<double> leg_s_;
  std::size_t home_ = 0;
  std::size_t flights_ = 0;
  std::vector<std::vector<double>> best_;       ///< by flights and waypoints done
  std::vector<std::vector<std::size_t>> from_;  ///< waypoints done before the last flight
};
}  // namespace

std::vector<Flight> flights_of(const Problem& problem, const Sweep& tour, double capacity_s) {
  Ring2 waypoints = tour.flown.points;
  waypoints.pop_back();  // the first again
  const Joins joins(problem.area, problem.time, waypoints);
  Cuts cuts(problem, tour, joins, capacity_s);
  const int fewest = std::max(1, int(tour.flown.time_s / capacity_s));
  for (int count = fewest; count <= kMaxFlights; ++count) {
    double least = kNotFlown;
    std::size_t home = 0;
    for (std::size_t i = 0; i < (problem.start ? 1 : waypoints.size()); ++i) {
      const double seconds = cuts.plan(i, count);
      if (seconds < least) {
        least = seconds;
        home = i;
      }
    }
    if (least < kNotFlown) {
      cuts.plan(home, count);
      return cuts.made();
    }
  }
  return {};
}
}  // namespace altiplan::cover
