// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "altiplan/constraint.hpp"
#include "altiplan/wind.hpp"

namespace altiplan::host {

/// The route still to be flown, parametrised by distance along it (m).
class FlightPath {
 public:
  /// Turns as chords. A wait is kept until the path changes: whoever then flies has left the plan.
  explicit FlightPath(const Route& route) {
    std::vector<std::pair<std::size_t, double>> waits;  // after so many points
    points_.assign(1, route.front());
    for (std::size_t i = 0; i < route.leg_count(); ++i) {
      const Leg leg = route.leg(i);
      for (const Vec3& p : leg.chords(kChordTolerance)) {
        if (p != points_.back()) {
          points_.push_back(p);
        }
      }
      if (leg.waits()) {
        waits.emplace_back(points_.size() - 1, leg.hold_s);
      }
    }
    measure();
    for (const auto& [point, seconds] : waits) {
      waits_.push_back({along_[point], seconds});
    }
  }

  double length() const { return along_.back(); }
  /// Horizontal distance along the path to position s.
  double level(double s) const {
    const std::size_t i = leg(s);
    return level_[i] + (at(s) - points_[i]).head<2>().norm();
  }
  Vec3 at(double s) const {
    const std::size_t i = leg(s);
    if (i + 1 == points_.size()) {
      return points_.back();
    }
    const double share = (s - along_[i]) / (along_[i + 1] - along_[i]);
    return share <= 0 ? points_[i] : Vec3(points_[i] + share * (points_[i + 1] - points_[i]));
  }
  /// The seconds still to wait at s.
  double wait_at(double s) const {
    double seconds = 0;
    for (const Wait& wait : waits_) {
      seconds += wait.s == s ? wait.seconds : 0;
    }
    return seconds;
  }
  /// The vehicle has waited at s for so many of them.
  void waited(double s, double seconds) {
    for (Wait& wait : waits_) {
      const double done = wait.s == s ? std::min(wait.seconds, seconds) : 0;
      wait.seconds -= done;
      seconds -= done;
    }
  }
  /// The first waypoint after s; the last if there is none.
  const Vec3& next_waypoint(double s) const { return points_[next(s)]; }
  double end_of_leg(double s) const { return along_[next(s)]; }
  void append_waypoints_after(double s, std::vector<Vec3>& to) const {
    to.insert(to.end(), points_.begin() + std::ptrdiff_t(next(s)), points_.end());
  }

  /// Calls `call` with both ends of each piece of leg between s0 and s1.
  template <class Call>
  void for_each_leg(double s0, double s1, const Call& call) const {
    s1 = std::min(s1, length());
    while (s0 < s1) {
      const double end = std::min(end_of_leg(s0), s1);
      call(at(s0), end == along_[next(s0)] ? next_waypoint(s0) : at(end));
      s0 = end;
    }
  }

  /// The position between s0 and s1 at which the path is nearest to p.
  double nearest(const Vec3& p, double s0, double s1) const {
    double best = s0;
    double min_distance = kInfinity;
    double s = s0;
    for_each_leg(s0, s1, [&](const Vec3& a, const Vec3& b) {
      const Vec3 way = b - a;
      const double run = way.norm();
      const double share = run > 0 ? std::clamp((p - a).dot(way) / (run * run), 0.0, 1.0) : 0;
      const double distance = (a + share * way - p).norm();
      if (distance < min_distance) {
        min_distance = distance;
        best = s + share * run;
      }
      s += run;
    });
    return std::min(best, length());
  }

  /// The same in plan view.
  double nearest_level(Vec3 p, double s0, double s1) const {
    double best = s0;
    double min_distance = kInfinity;
    double s = s0;
    for_each_leg(s0, s1, [&](const Vec3& a, const Vec3& b) {
      const Vec3 way = b - a;
      const double run = way.head<2>().squaredNorm();
      const double share =
          run > 0 ? std::clamp((p - a).head<2>().dot(way.head<2>()) / run, 0.0, 1.0) : 0;
      const double distance = (a + share * way - p).head<2>().norm();
      if (distance < min_distance) {
        min_distance = distance;
        best = s + share * way.norm();
      }
      s += way.norm();
    });
    return std::min(best, length());
  }

  /// The first position from s on that lies at that horizontal distance from p, or farther; the end
  /// if there is none.
  double first_beyond(double distance, const Vec3& p, double s) const {
    const auto is_beyond = [&](double at_s) { return (at(at_s) - p).head<2>().norm() >= distance; };
    while (s < length() && !is_beyond(s)) {
      double near = s;
      s = end_of_leg(s);
      if (!is_beyond(s)) {
        continue;
      }
      while (s - near > kLengthTolerance) {
        const double middle = (near + s) / 2;
        (is_beyond(middle) ? s : near) = middle;
      }
      break;
    }
    return s;
  }

  /// Direction of the first leg from s on that has a heading; east if there is none.
  Vec3 course_at(double s) const {
    Vec3 course(1, 0, 0);
    bool found = false;
    for_each_leg(s, length(), [&](const Vec3& a, const Vec3& b) {
      if (!found && has_heading(b - a)) {
        course = b - a;
        found = true;
      }
    });
    return course;
  }
  /// Direction of the last leg with a heading, of horizontal length 1.
  const Vec3& end_direction() const { return end_direction_; }
  /// The points of the path, and one between each two borders of the wind that it crosses.
  Polyline places_across(const Wind& wind) const {
    Polyline places{points_.front()};
    for (std::size_t i = 1; i < points_.size(); ++i) {
      double begin = 0;
      std::vector<double> ends = wind.crossings(points_[i - 1], points_[i]);
      ends.push_back(1);
      for (const double end : ends) {
        places.push_back(points_[i - 1] + (begin + end) / 2 * (points_[i] - points_[i - 1]));
        begin = end;
      }
      places.push_back(points_[i]);
    }
    return places;
  }

  /// Goes from p straight to position s, then along the path.
  void rejoin(const Vec3& p, double s) {
    Polyline route{p, at(s)};
    if (s < length()) {
      append_waypoints_after(s, route);
    }
    points_ = without_repeats(route);
    measure();
  }
  /// Restarts the path at p, in place of position s, with another end.
  void move_end(const Vec3& p, double s, const Vec3& goal) {
    Polyline route{p};
    append_waypoints_after(s, route);
    route.back() = goal;
    points_ = without_repeats(route);
    measure();
  }

 private:
  struct Wait {
    double s;
    double seconds;
  };

  void measure() {
    along_.assign(1, 0);
    level_.assign(1, 0);
    waits_.clear();
    end_direction_ = {1, 0, 0};
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      const Vec3 way = points_[i + 1] - points_[i];
      const double run = way.head<2>().norm();
      along_.push_back(along_.back() + way.norm());
      level_.push_back(level_.back() + run);
      end_direction_ = has_heading(way) ? Vec3(way / run) : end_direction_;
    }
  }
  std::size_t next(double s) const {
    const auto after = std::upper_bound(along_.begin(), along_.end(), s);
    return after == along_.end() ? points_.size() - 1 : std::size_t(after - along_.begin());
  }
  /// Index of the waypoint at which the leg at s begins; the last one beyond the end.
  std::size_t leg(double s) const {
    const auto after = std::upper_bound(along_.begin(), along_.end(), s);
    return after == along_.begin() ? 0 : std::size_t(after - along_.begin()) - 1;
  }

  Polyline points_;
  std::vector<double> along_;
  std::vector<double> level_;  ///< the same in plan view
  std::vector<Wait> waits_;
  Vec3 end_direction_{1, 0, 0};
};
}  // namespace altiplan::host
