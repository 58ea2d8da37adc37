// SPDX-License-Identifier: Apache-2.0
#include "flights.hpp"

#include <algorithm>
#include <optional>

namespace altiplan::cover {
namespace {

constexpr double kNotFlown = 1e300;
constexpr int kMaxFlights = 50;

/// Fastest ways between waypoints of a tour and home, one of them. Of several areas home is the
/// first, and an area is entered and left where it is nearest to that.
class Ways {
 public:
  Ways(const Tour& tour, const LegTime& time) : tour_(tour), time_(time) {
    for (std::size_t i = 0; i < tour.points.size() - 1; ++i) {
      const Area* area = tour.within[i];
      std::size_t k = 0;
      while (k < areas_.size() && areas_[k] != area) {
        ++k;
      }
      if (k == areas_.size()) {
        areas_.push_back(area);
        points_.push_back({area != nullptr ? area->nearest(tour.points[0]) : tour.points[0]});
      }
      group_.push_back(k);
      local_.push_back(int(points_[k].size()));
      points_[k].push_back(tour.points[i]);
    }
    for (std::size_t k = 0; k < areas_.size(); ++k) {
      joins_.push_back(areas_[k] != nullptr
                           ? std::optional<Joins>(std::in_place, *areas_[k], time, points_[k])
                           : std::nullopt);
    }
  }

  /// Seconds between home and each waypoint.
  std::vector<double> times(std::size_t home) const {
    std::vector<double> all;
    for (std::size_t i = 0; i < group_.size(); ++i) {
      const std::optional<Joins>& joins = joins_[group_[i]];
      all.push_back(!joins ? 0 : joins->time(gate(home, i), local_[i]) + beyond(home, i));
    }
    return all;
  }

  /// Points between home and a waypoint.
  Ring2 between(std::size_t home, std::size_t i) const {
    if (!joins_[group_[i]]) {
      return {};
    }
    Ring2 all = joins_[group_[i]]->corners(gate(home, i), local_[i]);
    if (group_[i] != group_[home]) {
      all.insert(all.begin(), points_[group_[i]][0]);
    }
    return all;
  }

 private:
  /// Where a way from home is first within the waypoint's area.
  int gate(std::size_t home, std::size_t i) const {
    return group_[i] == group_[home] ? local_[home] : 0;
  }
  double beyond(std::size_t home, std::size_t i) const {
    return group_[i] == group_[home] ? 0 : time_.between(tour_.points[home], points_[group_[i]][0]);
  }

  const Tour& tour_;
  LegTime time_;
  std::vector<const Area*> areas_;
  std::vector<Ring2> points_;  ///< by area: its gate, then its waypoints
  std::vector<std::optional<Joins>> joins_;
  std::vector<std::size_t> group_;  ///< by waypoint: index of its area
  std::vector<int> local_;          ///< by waypoint: index among those of its area
};

/// Flights of a tour that is cut from one of its waypoints on.
class Cuts {
 public:
  Cuts(const Tour& tour, const LegTime& time, double capacity_s)
      : tour_(tour), ways_(tour, time), capacity_s_(capacity_s), n_(tour.needed.size()) {
    for (std::size_t i = 0; i < n_; ++i) {
      leg_s_.push_back(time.between(tour.points[i], tour.points[i + 1]));
    }
  }

  /// Least seconds of all flights from waypoint `home` on, at most `count` of them: by dynamic
  /// programming over the waypoint at which each flight turns back.
  double plan(std::size_t home, int count) {
    home_ = home;
    home_s_ = ways_.times(home);
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
      for (const Point2& p : ways_.between(home_, at(first))) {
        flight.go_to(p, 0);
      }
      flight.go_to(point(first), 0);
      for (std::size_t i = first; i < last; ++i) {
        flight.go_to(point(i + 1), tour_.needed[at(i)]);
      }
      Ring2 back = ways_.between(home_, at(last));
      std::reverse(back.begin(), back.end());
      back.push_back(point(0));
      for (const Point2& p : back) {
        flight.go_to(p, 0);
      }
      end = done;
    }
    std::reverse(all.begin(), all.end());
    return all;
  }

 private:
  /// Index in the tour of the i-th waypoint, or leg, from home.
  std::size_t at(std::size_t i) const { return (home_ + i) % n_; }
  const Point2& point(std::size_t i) const { return tour_.points[at(i)]; }
  std::size_t next_needed(std::size_t i) const {
    while (i < n_ && !tour_.needed[at(i)]) {
      ++i;
    }
    return i;
  }

  /// Flights from home to what is next, along the tour, and back.
  void fly_on(std::size_t m, std::size_t done) {
    const std::size_t first = next_needed(done);
    double seconds = home_s_[at(first)];
    for (std::size_t end = first + 1; end <= n_; ++end) {
      seconds += leg_s_[at(end - 1)];
      if (seconds > capacity_s_) {
        return;
      }
      if (!tour_.needed[at(end - 1)]) {
        continue;
      }
      const double whole = seconds + home_s_[at(end)];
      const bool is_all = next_needed(end) == n_;
      const std::size_t reached = is_all ? n_ : end;
      if (whole <= capacity_s_ && best_[m][done] + whole < best_[m + 1][reached]) {
        best_[m + 1][reached] = best_[m][done] + whole;
        from_[m + 1][reached] = done;
      }
    }
  }

  const Tour& tour_;
  Ways ways_;
  double capacity_s_;
  std::size_t n_;
  std::vector<double> leg_s_;
  std::size_t home_ = 0;
  std::vector<double> home_s_;  ///< between home and each waypoint
  std::size_t flights_ = 0;
  std::vector<std::vector<double>> best_;       ///< by flights and waypoints done
  std::vector<std::vector<std::size_t>> from_;  ///< waypoints done before the last flight
};
}  // namespace

void Flight::go_to(const Point2& p, char is_needed) {
  if (points.empty()) {
    points.push_back(p);
  } else if ((p - points.back()).norm() > 1e-9) {
    points.push_back(p);
    needed.push_back(is_needed);
  }
}

double Tour::seconds(const LegTime& time) const {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    sum += time.between(points[i - 1], points[i]);
  }
  return sum;
}

std::vector<Flight> flights_of(const Tour& tour, const LegTime& time, bool is_free,
                               double capacity_s) {
  Cuts cuts(tour, time, capacity_s);
  const int fewest = std::max(1, int(tour.seconds(time) / capacity_s));
  for (int count = fewest; count <= kMaxFlights; ++count) {
    double least = kNotFlown;
    std::size_t home = 0;
    for (std::size_t i = 0; i < (is_free ? tour.needed.size() : 1); ++i) {
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
