// SPDX-License-Identifier: Apache-2.0
#include "host/gate/cure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace altiplan::host {
namespace {

constexpr double kStep = 0.1;      ///< metres
constexpr int kMaxSteps = 10'000;  ///< steps
/// Steps between tries, or an eighth of those made: what is valid for less than that may be missed.
constexpr int kStride = 20;
constexpr int kDirections = 16;

std::optional<Approach> after(const std::optional<Approach>& before, const Vec3& a, const Vec3& b) {
  return a == b ? before : onward(before, a);
}

/// A route with the heights of some waypoints bound to the ground, or the last one's to the height
/// of the waypoint before it.
struct Subject {
  Polyline points;
  const Bonds& bonds;
  const Request& request;
  std::vector<std::optional<Approach>> before;  ///< each leg

  Subject(const Polyline& route, const Bonds& their_bonds, const Request& their_request)
      : points(route),
        bonds(their_bonds),
        request(their_request),
        before{request.before_start(points.front())} {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      before.push_back(after(before[i], points[i], points[i + 1]));
    }
  }

  /// The first violated leg from `leg` on, whose approach is known; the number of legs if none is.
  std::size_t first_violated(std::size_t leg) {
    if (leg == 0) {
      before[0] = request.before_start(points.front());
    }
    while (leg + 1 < points.size() && leg_ok(before[leg], points[leg], points[leg + 1], request)) {
      before[leg + 1] = after(before[leg], points[leg], points[leg + 1]);
      ++leg;
    }
    return leg;
  }

  /// True for a waypoint that only moves with another, in height.
  bool is_led(std::size_t i) const { return bonds.last_is_led && i + 1 == points.size(); }

  /// The last waypoint that moves with this one.
  std::size_t last_with(std::size_t i) const { return is_led(i + 1) ? i + 1 : i; }

  /// A waypoint moved by so much.
  Vec3 moved(std::size_t i, const Vec3& by) const {
    if (is_led(i)) {
      return points[i] + Vec3(0, 0, by.z());
    }
    Vec3 p = points[i] + by;
    if (i < bonds.follows_ground.size() && bonds.follows_ground[i]) {
      const World& world = *request.world;
      const auto left = world.ground(points[i].x(), points[i].y());
      const auto reached = world.ground(p.x(), p.y());
      p.z() += left && reached ? *reached - *left : 0;
    }
    return p;
  }
};

/// Waypoints first to last moved together in a direction; the legs from `first_leg` to `last_leg`
/// are judged.
class Trial {
 public:
  Trial(const Subject& subject, std::size_t first, std::size_t last, std::size_t first_leg,
        std::size_t last_leg, const Vec3& direction)
      : subject_(subject),
        first_(first),
        last_(last),
        first_leg_(first_leg),
        direction_(direction),
        points_(subject.points.begin() + std::ptrdiff_t(first_leg),
                subject.points.begin() + std::ptrdiff_t(last_leg + 2)) {}

  bool is_valid(int steps) {
    for (std::size_t i = first_; i <= last_; ++i) {
      points_[i - first_leg_] = subject_.moved(i, steps * kStep * direction_);
    }
    std::optional<Approach> before =
        first_ == 0 ? subject_.request.before_start(points_.front()) : subject_.before[first_leg_];
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      if (!leg_ok(before, points_[i], points_[i + 1], subject_.request)) {
        return false;
      }
      before = after(before, points_[i], points_[i + 1]);
    }
    return true;
  }

  /// The minimum number of steps, found by strides and halving; 0: none up to `max_steps`.
  int min_steps(int max_steps) {
    int few = 0;
    int enough = 1;
    while (!is_valid(enough)) {
      few = enough;
      enough += std::max(std::min(enough, kStride), enough / 8);
      if (enough > max_steps) {
        return 0;
      }
    }
    while (enough - few > 1) {
      const int middle = (few + enough) / 2;
      (is_valid(middle) ? enough : few) = middle;
    }
    return enough;
  }

 private:
  const Subject& subject_;
  std::size_t first_;
  std::size_t last_;
  std::size_t first_leg_;
  Vec3 direction_;
  Polyline points_;
};

struct Change {
  std::size_t first;
  std::size_t last;
  Vec3 by;
};

/// The least change of the leg's ends, one of them or both, along one of the directions; with both,
/// the leg alone need be valid.
template <class Directions>
std::optional<Change> min_change(const Subject& subject, std::size_t leg, bool both,
                                 const Directions& directions) {
  std::optional<Change> best;
  int min_steps = kMaxSteps;
  for (const std::size_t waypoint : {leg, leg + 1}) {
    if (subject.is_led(waypoint)) {
      continue;
    }
    const std::size_t first = both ? leg : waypoint;
    const std::size_t last = subject.last_with(both ? leg + 1 : waypoint);
    const std::size_t first_leg = both ? leg : std::max<std::size_t>(waypoint, 1) - 1;
    const std::size_t last_leg = both ? leg : std::min(waypoint, subject.points.size() - 2);
    for (const Vec3& direction : directions) {
      Trial trial(subject, first, last, first_leg, last_leg, direction);
      const int steps = trial.min_steps(min_steps);
      if (steps != 0 && (!best || steps < min_steps)) {
        best = Change{first, last, steps * kStep * direction};
        min_steps = steps;
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

std::optional<Change> of_one_waypoint(const Subject& subject, std::size_t leg) {
  const auto by_height = min_change(subject, leg, false, up_and_down());
  return by_height ? by_height : min_change(subject, leg, false, around());
}
}  // namespace

std::optional<Cure> cure(const Route& route, const Violation& violation, const Request& request,
                         const Bonds& bonds) {
  if (!route.is_straight() || violation.at >= route.leg_count()) {
    return std::nullopt;
  }
  const Subject subject(route.waypoints(), bonds, request);
  const auto change = of_one_waypoint(subject, violation.at);
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

std::optional<Route> cured(const Route& route, const Request& request, const Bonds& bonds) {
  if (!route.is_straight()) {
    return std::nullopt;
  }
  Subject subject(route.waypoints(), bonds, request);
  Polyline& points = subject.points;
  const std::size_t max_rounds = 20 * points.size();
  std::size_t leg = 0;
  for (std::size_t round = 0; round < max_rounds; ++round) {
    leg = subject.first_violated(leg);
    if (leg + 1 >= points.size()) {
      return Route(std::move(points));
    }
    auto change = min_change(subject, leg, false, up_and_down());
    if (!change) {
      change = min_change(subject, leg, true, up_and_down());
    }
    if (!change) {
      change = min_change(subject, leg, false, around());
    }
    if (!change) {
      return std::nullopt;
    }
    for (std::size_t i = change->first; i <= change->last; ++i) {
      points[i] = subject.moved(i, change->by);
    }
    leg = std::max<std::size_t>(change->first, 1) - 1;
  }
  return std::nullopt;
}
}  // namespace altiplan::host
