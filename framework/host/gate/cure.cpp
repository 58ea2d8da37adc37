// SPDX-License-Identifier: Apache-2.0
#include "host/gate/cure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace altiplan::host {
namespace {

constexpr int kMost = 10'000;  ///< steps
constexpr double kStep = 0.1;  ///< metres
constexpr int kDirections = 16;

/// Waypoints first to last moved together in a direction.
class Trial {
 public:
  Trial(const Polyline& points, std::size_t first, std::size_t last, const Vec3& direction,
        const Request& request)
      : before_(points),
        points_(points),
        first_(first),
        last_(last),
        direction_(direction),
        request_(request) {}

  /// The legs from `first_leg` to `last_leg` alone are judged.
  bool is_valid(int steps, std::size_t first_leg, std::size_t last_leg) {
    for (std::size_t i = first_; i <= last_; ++i) {
      points_[i] = before_[i] + steps * kStep * direction_;
    }
    std::optional<Approach> before = request_.before_start(points_.front());
    for (std::size_t i = 0; i <= last_leg; ++i) {
      if (i >= first_leg && !leg_ok(before, points_[i], points_[i + 1], request_)) {
        return false;
      }
      if (points_[i] != points_[i + 1]) {
        before = onward(before, points_[i]);
      }
    }
    return true;
  }

  /// The least number of steps, found by doubling and halving; 0: none below `enough`.
  int least(std::size_t first_leg, std::size_t last_leg, int most = kMost) {
    int enough = 1;
    while (!is_valid(enough, first_leg, last_leg)) {
      enough *= 2;
      if (enough > most) {
        return 0;
      }
    }
    int few = enough / 2;
    while (enough - few > 1) {
      const int middle = (few + enough) / 2;
      (is_valid(middle, first_leg, last_leg) ? enough : few) = middle;
    }
    return enough;
  }

 private:
  const Polyline& before_;
  Polyline points_;
  std::size_t first_;
  std::size_t last_;
  Vec3 direction_;
  const Request& request_;
};

struct Change {
  std::size_t first;
  std::size_t last;
  Vec3 by;
};

/// The least change of the leg's ends, one of them or both, along one of the directions; with both,
/// the leg alone need be valid.
template <class Directions>
std::optional<Change> least_change(const Polyline& points, std::size_t leg, bool both,
                                   const Directions& directions, const Request& request) {
  std::optional<Change> best;
  int least = kMost;
  for (const std::size_t waypoint : {leg, leg + 1}) {
    const std::size_t first = both ? leg : waypoint;
    const std::size_t last = both ? leg + 1 : waypoint;
    const std::size_t first_leg = both ? leg : std::max<std::size_t>(waypoint, 1) - 1;
    const std::size_t last_leg = both ? leg : std::min(waypoint, points.size() - 2);
    for (const Vec3& direction : directions) {
      Trial trial(points, first, last, direction, request);
      const int steps = trial.least(first_leg, last_leg, least);
      if (steps != 0 && (!best || steps < least)) {
        best = Change{first, last, steps * kStep * direction};
        least = steps;
      }
    }
    if (both) {
      break;
    }
  }
  return best;
}

std::array<Vec3, 2> up_and_down() { return {Vec3(0, 0, 1), Vec3(0, 0, -1)}; }

std::array<Vec3, kDirections> around() {
  std::array<Vec3, kDirections> directions;
  for (int n = 0; n < kDirections; ++n) {
    const double bearing = 2 * kPi * n / kDirections;
    directions[std::size_t(n)] = {std::sin(bearing), std::cos(bearing), 0};
  }
  return directions;
}

std::optional<Change> of_one_waypoint(const Polyline& points, std::size_t leg,
                                      const Request& request) {
  const auto by_height = least_change(points, leg, false, up_and_down(), request);
  return by_height ? by_height : least_change(points, leg, false, around(), request);
}
}  // namespace

std::optional<Cure> cure(const Route& route, const Violation& violation, const Request& request) {
  if (!route.is_straight() || violation.at >= route.leg_count()) {
    return std::nullopt;
  }
  const auto change = of_one_waypoint(route.waypoints(), violation.at, request);
  return change ? std::optional(Cure{change->first, change->by}) : std::nullopt;
}

std::string in_words(const Cure& cure, const std::string& item) {
  constexpr std::array kNames{"north", "north-east", "east", "south-east",
                              "south", "south-west", "west", "north-west"};
  char metres[32];
  std::snprintf(metres, sizeof metres, "%.1f m", cure.by.norm());
  if (cure.by.z() != 0) {
    return (cure.by.z() > 0 ? "raise " : "lower ") + item + " by " + metres;
  }
  const double bearing = degrees(std::atan2(cure.by.x(), cure.by.y()));
  const int whole = int(std::lround(bearing + 360)) % 360;
  std::string toward = " toward " + std::to_string(whole) + "°";
  if (whole % 45 == 0) {
    toward = std::string(" to the ") + kNames[std::size_t(whole / 45)];
  }
  return "move " + item + " by " + metres + toward;
}

std::optional<Route> cured(const Route& route, const Request& request) {
  if (!route.is_straight()) {
    return std::nullopt;
  }
  Polyline points = route.waypoints();
  const auto first_violated = [&] {
    std::optional<Approach> before = request.before_start(points.front());
    std::size_t leg = 0;
    while (leg + 1 < points.size() && leg_ok(before, points[leg], points[leg + 1], request)) {
      if (points[leg] != points[leg + 1]) {
        before = onward(before, points[leg]);
      }
      ++leg;
    }
    return leg;
  };
  const std::size_t most_rounds = 20 * points.size();
  for (std::size_t round = 0; round < most_rounds; ++round) {
    const std::size_t leg = first_violated();
    if (leg + 1 >= points.size()) {
      return Route(std::move(points));
    }
    auto change = least_change(points, leg, false, up_and_down(), request);
    if (!change) {
      change = least_change(points, leg, true, up_and_down(), request);
    }
    if (!change) {
      change = least_change(points, leg, false, around(), request);
    }
    if (!change) {
      return std::nullopt;
    }
    for (std::size_t i = change->first; i <= change->last; ++i) {
      points[i] += change->by;
    }
  }
  return std::nullopt;
}
}  // namespace altiplan::host
