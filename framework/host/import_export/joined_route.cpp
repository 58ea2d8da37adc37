// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/joined_route.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace altiplan::host {
namespace {

using Until = formats::MissionCircle::Until;

/// Difference of two heights this small is a rounding error of the file, metres.
constexpr double kSameHeight = 0.02;
/// Difference of two headings this small is a rounding error of the file.
constexpr double kSameHeading = radians(1);
/// A waypoint this near to the tangent point of a circle stands for it, metres.
constexpr double kSameEntry = 0.1;
/// A circle that would need more is left as soon as its heading allows: the judge refuses it.
constexpr double kMaxTurn = 200 * kPi;

/// In [0, 2 pi).
double full_turn(double angle) {
  const double turn = std::fmod(angle, 2 * kPi);
  return turn < 0 ? turn + 2 * kPi : turn;
}

double signed_radius(const MissionPlace& place) {
  return place.circle ? place.circle->sense * place.circle->radius_m : 0;
}

/// Heading of the common tangent of two circles, with signed radii as above (0: a point); none if
/// one lies within the other.
std::optional<double> tangent(const Vec3& from, double from_radius, const Vec3& to,
                              double to_radius) {
  const Vec3 between = to - from;
  const double distance = between.head<2>().norm();
  const double offset = to_radius - from_radius;
  if (distance < kLengthTolerance || std::abs(offset) > distance) {
    return std::nullopt;
  }
  return std::atan2(between.y(), between.x()) - std::asin(offset / distance);
}

/// The point of a circle at which it is flown with a heading.
Vec3 point_at(const Vec3& centre, double radius, double heading) {
  return centre + radius * Vec3(std::sin(heading), -std::cos(heading), 0);
}

bool lies_on(const Vec3& point, const MissionPlace& circle) {
  const double off = (point - circle.at).head<2>().norm() - circle.circle->radius_m;
  return std::abs(off) < kOnCircle;
}

class Joining {
 public:
  Joining(const std::vector<MissionPlace>& places, std::optional<double> heading,
          const Limits& limits)
      : places_(places), heading_(heading), limits_(limits) {
    drop_rounded_entry();
  }

  JoinedRoute joined() {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (!places_[i].circle) {
        straight_to(places_[i].at);
      } else if (!around(i)) {
        ++result_.unjoined;
        straight_to(places_[i].at);
      }
      result_.places.resize(result_.route.size(), i + (i >= dropped_ ? 1 : 0));
    }
    return std::move(result_);
  }

 private:
  /// A waypoint where the route enters its last circle is rounded: its tangent is exact.
  void drop_rounded_entry() {
    const std::size_t count = places_.size();
    if (count < 3 || !places_.back().circle || places_[count - 2].circle) {
      return;
    }
    const MissionPlace& before = places_[count - 3];
    const MissionPlace& last = places_.back();
    if (!before.circle && lies_on(before.at, last)) {
      return;
    }
    const double radius = signed_radius(last);
    const auto entry = tangent(before.at, signed_radius(before), last.at, radius);
    if (entry && (point_at(last.at, radius, *entry) - places_[count - 2].at).norm() < kSameEntry) {
      places_.erase(places_.end() - 2);
      dropped_ = count - 2;
    }
  }

  void straight_to(const Vec3& to) {
    Route& route = result_.route;
    if (!route.empty() && has_heading(to - route.back())) {
      const Vec3 leg = to - route.back();
      heading_ = std::atan2(leg.y(), leg.x());
    }
    route.push_back(to);
  }

  /// Enters circle i, and leaves it for the next place; false if it cannot be joined.
  bool around(std::size_t i) {
    const MissionPlace& place = places_[i];
    if (result_.route.empty()) {
      return begin_on(i);
    }
    const Vec3 before = result_.route.back();
    const double radius = signed_radius(place);
    const bool is_on = lies_on(before, place);
    const auto entry = is_on ? heading_on(before, place) : tangent(before, 0, place.at, radius);
    const bool ends = i + 1 == places_.size() || place.circle->until == Until::forever;
    // The centre moves with the rounding of the entry, so that all joints are tangential.
    const Vec3 centre = is_on && entry ? point_at(before, -radius, *entry) : place.at;
    const auto exit = ends ? entry : exit_of(i, centre);
    const bool turns_back = is_on && ends && entry && heading_ && std::cos(*heading_ - *entry) < 0;
    if (!entry || !exit || turns_back) {
      return false;
    }
    if (!is_on) {
      Vec3 to = point_at(place.at, radius, *entry);
      to.z() = place.circle->until == Until::altitude ? before.z() : place.at.z();
      straight_to(to);
    }
    if (!ends) {
      turn(place, *entry, *exit);
    } else if (std::abs(before.z() - place.at.z()) > kSameHeight && is_on) {
      straight_to({before.x(), before.y(), place.at.z()});  // a step, for the judge to refuse
    }
    ++result_.circles;
    return true;
  }

  /// A route that begins on a circle begins where it leaves it.
  bool begin_on(std::size_t i) {
    const auto exit = i + 1 < places_.size() ? exit_of(i, places_[i].at) : std::nullopt;
    if (!exit) {
      return false;
    }
    Vec3 from = point_at(places_[i].at, signed_radius(places_[i]), *exit);
    from.z() = places_[i].at.z();
    straight_to(from);
    heading_ = exit;
    ++result_.circles;
    return true;
  }

  /// Heading at a point of the circle: that of the leg that led there, unless it differs.
  double heading_on(const Vec3& point, const MissionPlace& place) const {
    const Vec3 outwards = point - place.at;
    const double along = std::atan2(outwards.y(), outwards.x()) + place.circle->sense * kPi / 2;
    const bool is_same =
        heading_ && std::abs(std::remainder(*heading_ - along, 2 * kPi)) < kSameHeading;
    return is_same ? *heading_ : along;
  }

  std::optional<double> exit_of(std::size_t i, const Vec3& centre) const {
    return tangent(centre, signed_radius(places_[i]), places_[i + 1].at,
                   signed_radius(places_[i + 1]));
  }

  void turn(const MissionPlace& place, double entry, double exit) {
    const formats::MissionCircle& circle = *place.circle;
    const double climb = place.at.z() - result_.route.back().z();
    const double first = full_turn(circle.sense * (exit - entry));
    const double min_turn = circle.until == Until::turns ? 2 * kPi * circle.turns
                                                         : min_climb_turn(climb, circle.radius_m);
    // More circles than a leg may have are the same circle.
    const double max_circles = std::floor((kMaxTurn - first) / (2 * kPi));
    const double circles =
        std::min(std::ceil((min_turn - kExitTolerance - first) / (2 * kPi)), max_circles);
    const double angle = first + 2 * kPi * circles;
    heading_ = exit;
    if (angle <= 0) {  // it has the heading of the exit when it enters
      return;
    }
    Leg leg =
        Leg::turning({result_.route.back(), entry}, circle.sense * angle, circle.radius_m, climb);
    leg.to.z() = place.at.z();
    result_.route.push_back(leg);
  }

  double min_climb_turn(double climb, double radius) const {
    const double limit = climb < 0 ? limits_.max_descent() : limits_.max_climb;
    const double needed = std::abs(climb) / std::tan(limit) / radius;
    return needed > 0 && needed < kMaxTurn ? needed : 0;
  }

  std::vector<MissionPlace> places_;
  std::size_t dropped_ = std::numeric_limits<std::size_t>::max();  ///< index of the place left out
  std::optional<double> heading_;  ///< on reaching the end of the route so far
  const Limits& limits_;
  JoinedRoute result_;
};
}  // namespace

JoinedRoute joined_route(const std::vector<MissionPlace>& places, std::optional<double> heading,
                         const Limits& limits) {
  return Joining(places, heading, limits).joined();
}
}  // namespace altiplan::host
