// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/written_route.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan::host {
namespace {

using Until = formats::MissionCircle::Until;

/// ArduPilot leaves a circle at once if the next waypoint is nearer to its centre than 1.05 radii.
constexpr double kNextBeyond = 1.1;
/// Maximum difference of a turn from the one that is read back, metres.
constexpr double kSameTurn = 1e-4;
/// Heights that differ by less are one, metres.
constexpr double kLevel = 1e-3;

/// The centre of an arc, at the height of its end.
Vec3 centre_of(const Leg& arc) {
  const double side = arc.turn > 0 ? arc.radius : -arc.radius;
  const Vec3 centre = arc.from + side * Vec3(-std::sin(arc.heading), std::cos(arc.heading), 0);
  return {centre.x(), centre.y(), arc.to.z()};
}

/// The arc as a circle that is left along a tangent. Full circles are counted at one height only:
/// PX4 has no such command, and a climb ends at an altitude.
MissionPlace circle_of(const Leg& arc) {
  formats::MissionCircle circle;
  circle.radius_m = arc.radius;
  circle.sense = arc.turn > 0 ? 1 : -1;
  const double turns = std::floor((std::abs(arc.turn) + 1e-9) / (2 * kPi));
  if (turns > 0 && std::abs(arc.to.z() - arc.from.z()) < kLevel) {
    circle.until = Until::turns;
    circle.turns = turns;
  }
  return {centre_of(arc), circle};
}

/// The corners of equal pieces of a turn, all within `tolerance` of it.
Polyline corners_of(const Leg& turn, double tolerance) {
  constexpr double kMaxPiece = kPi / 6;
  double count =
      std::ceil(std::max(std::abs(turn.turn) / kMaxPiece, std::sqrt(turn.sagitta() / tolerance)));
  for (;; ++count) {
    Polyline corners;
    double off = 0;
    for (double i = 0; i < count && off <= tolerance; ++i) {
      const Leg piece = turn.piece(i / count, (i + 1) / count);
      corners.push_back(corner_of(piece));
      off = (corners.back() - piece.at(0.5)).norm();
    }
    if (off <= tolerance) {
      return corners;
    }
  }
}

class Writing {
 public:
  Writing(const Route& route, const ArcForm& form, const std::vector<std::size_t>& via,
          const Request& request)
      : route_(route), form_(form), request_(request), via_(via) {}

  WrittenRoute written() {
    add(route_.front(), false, 0);
    for (std::size_t i = 0; i < route_.leg_count(); ++i) {
      const Leg leg = route_.leg(i);
      if (leg.waits()) {
        result_.places.back().hold_s += leg.hold_s;
      } else if (!leg.turns()) {
        add(leg.to, is_joint(i + 1), double(i + 1));
      } else if (form_.loiters && is_loiter(i)) {
        result_.places.push_back(circle_of(leg));
        result_.places.back().along = double(i + 1);
        kept_.push_back(true);
        ++result_.loiters;
      } else {
        add_points(leg, i);
        add(leg.to, is_joint(i + 1), double(i + 1));
      }
    }
    drop_joints();
    if (form_.loiters) {
      add_loiters_of_ends();
    }
    return std::move(result_);
  }

 private:
  void add(const Vec3& point, bool is_joint, double along) {
    result_.places.push_back({point, {}, 0, along});
    kept_.push_back(!is_joint);
  }

  void add_points(const Leg& turn, std::size_t i) {
    // Beside heights at the joints, which add to it at a right angle.
    const Polyline corners = corners_of(turn, 0.8 * form_.tolerance);
    for (const Vec3& corner : corners) {
      const auto n = double(&corner - corners.data());
      add(corner, false, double(i) + (n + 0.5) / double(corners.size()));
    }
    ++result_.turns;
    result_.points += corners.size();
  }

  bool is_via(std::size_t waypoint) const {
    return std::find(via_.begin(), via_.end(), waypoint) != via_.end();
  }

  /// True for a waypoint within the route that only joins points of a turn to another leg.
  bool is_joint(std::size_t waypoint) const {
    if (waypoint == 0 || waypoint >= route_.leg_count() || is_via(waypoint)) {
      return false;
    }
    const Leg before = route_.leg(waypoint - 1);
    const Leg after = route_.leg(waypoint);
    const bool enters_circle = form_.loiters && after.turns() && is_loiter(waypoint);
    return (before.turns() || after.turns()) && !enters_circle &&
           turn_angle_horizontal(before.rate(1), after.rate(0)) < kSameTurn;
  }

  /// True if the leg is an arc that an autopilot, and joined_route, flies in the same way when
  /// given its circle: one that leads to a straight leg, and turns by more than the tolerance of
  /// the exit's heading.
  bool is_loiter(std::size_t i) const {
    const Leg arc = route_.leg(i);
    if (arc.kind() != Leg::Kind::arc || i + 1 >= route_.leg_count() || is_via(i + 1) ||
        route_.leg(i + 1).turns()) {
      return false;
    }
    const double fraction = std::fmod(std::abs(arc.turn), 2 * kPi);
    const MissionPlace circle = circle_of(arc);
    const Vec3 next = route_[i + 2];
    if ((fraction < kExitTolerance && circle.circle->until == Until::altitude) ||
        fraction > 2 * kPi - kExitTolerance || !is_beyond(next, circle)) {
      return false;
    }
    const Route read =
        joined_route({{arc.from}, circle, {next}}, arc.heading, request_.limits).route;
    return read.leg_count() == 2 && read.leg(0).turns() &&
           std::abs(read.leg(0).turn - arc.turn) * arc.radius < kSameTurn &&
           (read.leg(0).to - arc.to).norm() < kSameTurn;
  }

  /// Drops the joints between two kept places that lie on the leg between them.
  void drop_joints() {
    constexpr double kShare = 0.6;  // of the tolerance: see add_points
    const std::vector<MissionPlace> all = std::move(result_.places);
    result_.places.clear();
    for (std::size_t i = 0; i < all.size();) {
      result_.places.push_back(all[i]);
      std::size_t next = i + 1;
      bool are_on_leg = !all[i].circle;
      while (next < all.size() && !kept_[next]) {
        ++next;
      }
      for (std::size_t joint = i + 1; joint < next && are_on_leg; ++joint) {
        are_on_leg =
            next < all.size() && !all[next].circle &&
            point_leg_distance(all[joint].at, all[i].at, all[next].at) <= kShare * form_.tolerance;
      }
      i = are_on_leg ? next : i + 1;
    }
  }

  /// The start's circle is left along a straight leg; the goal's may be joined in any way.
  void add_loiters_of_ends() {
    std::vector<MissionPlace>& places = result_.places;
    if (const auto& goal = request_.goal.loiter) {
      places.push_back(loiter_of(*goal, request_.goal.position, Until::forever));
      ++result_.loiters;
    }
    if (const auto& start = request_.start.loiter) {
      const MissionPlace circle = loiter_of(*start, request_.start.position, Until::altitude);
      if (places.size() > 1 && !route_.leg(0).turns() && !places[1].circle &&
          is_beyond(places[1].at, circle)) {
        places.front() = circle;
        ++result_.loiters;
      }
    }
  }

  static MissionPlace loiter_of(const Loiter& loiter, const Vec3& centre, Until until) {
    return {centre, formats::MissionCircle{until, loiter.radius, loiter.sense, 0}};
  }

  static bool is_beyond(const Vec3& next, const MissionPlace& circle) {
    return (next - circle.at).head<2>().norm() >= kNextBeyond * circle.circle->radius_m;
  }

  const Route& route_;
  const ArcForm& form_;
  const Request& request_;
  const std::vector<std::size_t>& via_;
  WrittenRoute result_;
  std::vector<bool> kept_;  ///< one for each place; false: a joint
};
}  // namespace

Vec3 corner_of(const Leg& piece) {
  const Vec3 in = piece.rate(0);
  const Vec3 out = piece.rate(1);
  const Vec3 chord = piece.to - piece.from;
  const double sine = in.x() * out.y() - in.y() * out.x();
  const double share = sine == 0 ? 0.5 : (chord.x() * out.y() - chord.y() * out.x()) / sine;
  Vec3 corner = piece.from + share * in;
  corner.z() = (piece.from.z() + piece.to.z()) / 2;
  return corner;
}

WrittenRoute written_route(const Route& route, const ArcForm& form,
                           const std::vector<std::size_t>& via, const Request& request) {
  return Writing(route, form, via, request).written();
}
}  // namespace altiplan::host
