// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

#include "altiplan/leg.hpp"

namespace altiplan {

/// Points joined by straight legs.
using Polyline = std::vector<Vec3>;

/// Waypoints joined by legs. Legs are straight unless appended as turns or waits: a polyline is a
/// route as it is. The waypoints are read like a vector's elements.
class ALTIPLAN_API Route {
 public:
  Route() = default;
  Route(Polyline waypoints) : waypoints_(std::move(waypoints)) {}  // NOLINT(*-explicit-*)
  Route(std::initializer_list<Vec3> waypoints) : waypoints_(waypoints) {}

  const Polyline& waypoints() const { return waypoints_; }
  std::size_t size() const { return waypoints_.size(); }
  bool empty() const { return waypoints_.empty(); }
  const Vec3& operator[](std::size_t i) const { return waypoints_[i]; }
  const Vec3& front() const { return waypoints_.front(); }
  const Vec3& back() const { return waypoints_.back(); }
  const Vec3& at(std::size_t i) const { return waypoints_.at(i); }
  auto begin() const { return waypoints_.begin(); }
  auto end() const { return waypoints_.end(); }

  /// Makes all legs straight, and returns the waypoints to edit.
  Polyline& edit() {
    legs_.clear();
    return waypoints_;
  }
  /// Appends a straight leg, or the first waypoint.
  void push_back(const Vec3& to);
  /// Appends a leg that begins at the last waypoint; the first leg brings the first waypoint too.
  void push_back(const Leg& leg);

  /// Appends a route that begins where this one ends; an empty one takes it whole.
  void append(const Route& next);
  /// The legs between two waypoints.
  Route part(std::size_t first, std::size_t last) const;

  /// True if the waypoints say all: no leg turns or waits.
  bool is_straight() const { return legs_.empty(); }
  /// True if the vehicle waits somewhere.
  bool waits() const;
  std::size_t leg_count() const { return empty() ? 0 : size() - 1; }
  /// The leg from waypoint i to the next one.
  Leg leg(std::size_t i) const {
    return is_straight() ? Leg::straight(waypoints_[i], waypoints_[i + 1]) : legs_[i];
  }
  /// The route as straight legs: turns are replaced by chords at most `tolerance` metres from them.
  Polyline chords(double tolerance) const;

  bool operator==(const Route&) const = default;

 private:
  Polyline waypoints_;
  std::vector<Leg> legs_;  ///< every leg of a route that turns or waits; else empty
};

/// Sum of leg lengths, metres.
ALTIPLAN_API double length(const Polyline& points);
ALTIPLAN_API double length(const Route& route);
/// The points without consecutive repetitions.
ALTIPLAN_API Polyline without_repeats(const Polyline& points);
/// The route without straight legs of length zero that do not wait.
ALTIPLAN_API Route without_repeats(const Route& route);

/// Where a vehicle comes from, and its heading, on reaching the first point of a leg. Legs without
/// a heading preserve the last one: a vehicle that climbs on the spot keeps its heading.
struct ALTIPLAN_API Approach {
  Vec3 from{0, 0, 0};
  Vec3 heading{0, 0, 0};  ///< horizontal direction of any length, on reaching `from`; zero where
                          ///< there is none yet
  bool turning = false;   ///< along a turn: `from` then lies on its tangent at the end

  Approach(const Vec3& point, const Vec3& before = Vec3::Zero())  // NOLINT(*-explicit-*)
      : from(point), heading(before) {}

  /// Heading on arrival at `here`; zero where there is none.
  Vec3 heading_at(const Vec3& here) const {
    const Vec3 leg = here - from;
    return has_heading(leg) ? Vec3(leg.x(), leg.y(), 0) : heading;
  }
};

/// The approach to the end of the next leg of a vehicle that reached `here` by `before`.
inline Approach onward(const std::optional<Approach>& before, const Vec3& here) {
  return {here, before ? before->heading_at(here) : Vec3::Zero()};
}

/// The same after a leg of any kind. A repeated point, and a turn shorter than kLengthTolerance,
/// leave the approach what it was: no number of them hides a corner.
ALTIPLAN_API std::optional<Approach> onward(std::optional<Approach> before, const Leg& leg);

/// Horizontal turn at `here` toward `next`, in [0, pi]; 0 where there is no heading to turn from or
/// to. A vehicle that turns on the spot does so on legs without a heading.
ALTIPLAN_API double horizontal_turn(const Approach& before, const Vec3& here, const Vec3& next,
                                    bool turns_on_the_spot);
/// Fillet radius of the corner at `here`; 0 where the heading changes over a leg without a heading
/// and the vehicle does not turn on the spot.
ALTIPLAN_API double corner_radius(const Approach& before, const Vec3& here, const Vec3& next,
                                  bool turns_on_the_spot);

/// The approach to point number `to` of a vehicle that reached the first point by `before`.
/// Repeated points are skipped.
ALTIPLAN_API std::optional<Approach> approach(const Polyline& points, std::size_t to,
                                              const std::optional<Approach>& before);
}  // namespace altiplan
