// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/kit/dubins/steering.hpp"

namespace altiplan::shortcut {

/// The radius to turn with: the least that the limits allow, without one the smallest of the route.
inline double turn_radius(const Route& route, const Request& request) {
  if (request.limits.min_turn_radius > 0) {
    return request.limits.min_turn_radius;
  }
  double minimum = kInfinity;
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Leg leg = route.leg(i);
    minimum = leg.turns() ? std::min(minimum, leg.radius) : minimum;
  }
  return minimum;
}

/// Shortens one route with turns: stretches of it become Dubins paths between the poses at their
/// ends. Lengths are those of the route, in wind times by the airspeed.
class TurnShortening {
 public:
  TurnShortening(const Route& route, const Request& request, double waypoint_share, double min_gain)
      : request_(request),
        steering_(request, turn_radius(route, request)),
        random_(request.random.sub("shortcut")),
        waypoint_share_(waypoint_share),
        min_gain_(min_gain) {
    for (std::size_t i = 0; i < route.leg_count(); ++i) {
      pi_.push_back(route.leg(i));
    }
    measure();
  }

  /// Samples two points and tries the path between them; returns true if it was taken.
  bool shortcut() {
    Place a = draw();
    Place b = draw();
    if (b.from_start < a.from_start) {
      std::swap(a, b);
    }
    const double replaced = b.from_start - a.from_start;
    if (a.leg == b.leg || replaced <= min_gain_ * total()) {
      return false;
    }
    const auto from = pose(a);
    const auto to = pose(b);
    if (!from || !to || replaced - min_length(*from, *to) <= min_gain_ * total()) {
      return false;
    }
    const auto path = steering_.path(*from, *to);
    if (!path) {
      return false;
    }
    // The path, what is left of the two legs that are cut, and the leg whose approach changes.
    std::vector<Leg> shorter(pi_.begin(), pi_.begin() + std::ptrdiff_t(a.leg));
    const std::size_t first = shorter.size();
    const auto is_leg = [](double metres) { return metres > kLengthTolerance / 10; };
    if (is_leg(a.from_start - from_start_[a.leg])) {
      shorter.push_back(pi_[a.leg].piece(0, a.part));
    }
    shorter.insert(shorter.end(), path->legs.begin(), path->legs.end());
    if (is_leg(from_start_[b.leg + 1] - b.from_start)) {
      shorter.push_back(pi_[b.leg].piece(b.part, 1));
    }
    const std::size_t last = shorter.size();
    shorter.insert(shorter.end(), pi_.begin() + std::ptrdiff_t(b.leg) + 1, pi_.end());
    if (total() - total_of(shorter) <= min_gain_ * total() || !are_kept(shorter, first, last)) {
      return false;
    }
    pi_ = std::move(shorter);
    measure();
    return true;
  }

  bool is_done() const { return pi_.size() < 2 || !std::isfinite(total()); }
  Route route() const { return kit::route_of(pi_, pi_.front().from, request_); }
  std::int64_t legs_checked() const { return legs_checked_; }

 private:
  struct Place {
    std::size_t leg;
    double part;        ///< fraction of the leg
    double from_start;  ///< metres along the route
  };

  double metres(const Leg& leg) const {
    if (steering_.is_calm()) {
      return leg.length();
    }
    return leg.turns() ? leg.air_length()
                       : flight_time(leg.from, leg.to, request_.air_speed(), request_.wind) *
                             request_.air_speed();
  }
  double total() const { return from_start_.back(); }
  double total_of(const std::vector<Leg>& legs) const {
    double sum = 0;
    for (const Leg& leg : legs) {
      sum += metres(leg);
    }
    return sum;
  }
  double min_length(const Pose& from, const Pose& to) const {
    const double length = steering_.min_length(from, to);
    return steering_.is_calm() ? std::hypot(length, to.position.z() - from.position.z()) : length;
  }

  void measure() {
    from_start_.assign(1, 0.0);
    for (const Leg& leg : pi_) {
      from_start_.push_back(from_start_.back() + metres(leg));
    }
  }

  Place draw() {
    const double at = random_.uniform(0, total());
    const bool to_waypoint = random_.uniform() < waypoint_share_;
    const auto end = std::upper_bound(from_start_.begin() + 1, from_start_.end() - 1, at);
    const auto leg = std::size_t(end - from_start_.begin()) - 1;
    const double part =
        std::clamp((at - from_start_[leg]) / (from_start_[leg + 1] - from_start_[leg]), 0.0, 1.0);
    if (to_waypoint) {
      return part < 0.5 ? Place{leg, 0, from_start_[leg]} : Place{leg, 1, from_start_[leg + 1]};
    }
    return {leg, part, at};
  }

  /// The pose of the vehicle there; none on a leg without a heading, or that it cannot fly.
  std::optional<Pose> pose(const Place& place) const {
    const Leg& leg = pi_[place.leg];
    if (leg.turns()) {
      return steering_.pose_on(leg, place.part, leg.heading + place.part * leg.turn);
    }
    const Vec3 at = leg.at(place.part);
    const Vec3 course = leg.to - leg.from;
    const auto heading = has_heading(course) ? request_.heading_on(course, at) : std::nullopt;
    return heading ? std::optional(Pose{at, *heading}) : std::nullopt;
  }

  /// Checks the legs `first` to `last`.
  bool are_kept(const std::vector<Leg>& legs, std::size_t first, std::size_t last) {
    std::optional<Approach> before = request_.before_start(legs.front().from);
    for (std::size_t i = 0; i < std::min(last + 1, legs.size()); ++i) {
      if (i >= first) {
        ++legs_checked_;
        if (!leg_ok(before, legs[i], request_)) {
          return false;
        }
      }
      before = onward(before, legs[i]);
    }
    return true;
  }

  std::vector<Leg> pi_;
  const Request& request_;
  kit::Steering steering_;
  RandomStream random_;
  double waypoint_share_;
  double min_gain_;
  std::vector<double> from_start_;  ///< of each waypoint, metres along the route
  std::int64_t legs_checked_ = 0;
};
}  // namespace altiplan::shortcut
