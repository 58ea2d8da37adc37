// SPDX-License-Identifier: Apache-2.0
//
// The rule of EU 2019/947, UAS.OPEN.010: at most 120 m from the closest point of the surface of the
// earth. design.md has the proof by which a leg is decided.
#include <cmath>
#include <cstdio>

#include "altiplan/constraint.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/request.hpp"
#include "nearest_ground.hpp"

namespace {
using namespace altiplan;
using ground_distance::nearest_ground;
using ground_distance::NearGround;
using ground_distance::off_the_ground;

struct Params {
  double max_m = 120;
  AppliesTo applies_to = AppliesTo::both;

  void describe(Fields& f) {
    f("max_m", max_m)
        .unit("m")
        .greater_than(0)
        .at_most(100000)
        .required()
        .doc("maximum distance, in any direction, between the route and the nearest ground");
    f("applies_to", applies_to,
      {{"both", AppliesTo::both}, {"route", AppliesTo::route}, {"track", AppliesTo::track}})
        .doc(
            "what it restricts: a smaller value for the route than for the track leaves a margin "
            "for the flight");
  }
};

/// A place of a leg, and the ground near it.
struct Place {
  Vec3 at;
  NearGround near;
};

/// Decides a leg piece by piece.
class LegProof {
 public:
  LegProof(const World& world, double limit) : world_(world), limit_(limit) {}

  bool keeps(const Vec3& a, const Vec3& b) {
    if (is_low(a, b)) {
      return true;
    }
    const Place from = place(a);
    const Place to = place(b);
    return !is_too_far(from) && !is_too_far(to) && keeps_piece(from, to);
  }
  /// A place that is too far, if the leg has one.
  const Vec3& refused_at() const { return refused_at_; }

 private:
  /// Metres; pieces below it differ by less from a place that keeps the limit.
  static constexpr double kShortest = 4e-7;

  Place place(const Vec3& p) const { return {p, nearest_ground(world_, p, limit_)}; }

  /// The ground straight below is near enough.
  bool is_low(const Vec3& a, const Vec3& b) const {
    return world_.ground_gap_max(a, b) <= limit_ && world_.ground_below(a, b);
  }

  bool is_too_far(const Place& place) {
    refused_at_ = place.at;
    return place.near.at_least > limit_;
  }

  bool keeps_piece(const Place& from, const Place& to) {
    if (shares_ground(from, to) || is_low(from.at, to.at) || follows_ground(from, to)) {
      return true;
    }
    if ((to.at - from.at).norm() < kShortest) {
      return std::min(from.near.at_most, to.near.at_most) <= limit_;
    }
    const Place middle = place((from.at + to.at) / 2);
    return !is_too_far(middle) && keeps_piece(from, middle) && keeps_piece(middle, to);
  }

  /// One point of the ground is near enough to both ends, hence to all between them.
  bool shares_ground(const Place& from, const Place& to) const {
    const double length = (to.at - from.at).norm();
    return std::min(from.near.at_most, to.near.at_most) + length <= limit_ ||
           (is_near(from.at, from.near.point) && is_near(to.at, from.near.point)) ||
           (is_near(from.at, to.near.point) && is_near(to.at, to.near.point));
  }
  bool is_near(const Vec3& p, const Vec3& ground) const { return (p - ground).norm() <= limit_; }

  /// The line between the points of the ground that are near the ends is near enough, and lies near
  /// enough to the ground.
  bool follows_ground(const Place& from, const Place& to) const {
    const double apart =
        std::max((from.at - from.near.point).norm(), (to.at - to.near.point).norm());
    return from.near.ground != nullptr && from.near.ground == to.near.ground && apart <= limit_ &&
           apart + off_the_ground(*from.near.ground, from.near.point, to.near.point) <= limit_;
  }

  const World& world_;
  double limit_;
  Vec3 refused_at_{0, 0, 0};
};

class GroundDistance final : public Constraint {
 public:
  explicit GroundDistance(const Params& params)
      : params_(params), limit_(params.max_m + kLengthTolerance / 2) {}

 private:
  AppliesTo do_applies_to() const override { return params_.applies_to; }
  bool do_admits(const Motion& leg) const override {
    return leg.world != nullptr && is_finite(leg.from) && is_finite(leg.to) &&
           LegProof(*leg.world, limit_).keeps(leg.from, leg.to);
  }

  /// do_admits refuses legs; this adds where, and by how much: of one place per refused leg, the
  /// farthest.
  std::vector<Violation> do_violations(const Polyline& route,
                                       const Request& request) const override {
    Violation worst;
    for (std::size_t i = 0; i + 1 < route.size(); ++i) {
      LegProof proof(*request.world, limit_);
      if (proof.keeps(route[i], route[i + 1])) {
        continue;
      }
      const Vec3& at = proof.refused_at();
      const double away = distance(*request.world, at);
      if (away > std::max(worst.value, limit_) && away < kInfinity) {
        worst = {"", i, away, params_.max_m, sentence(at, away), "", "m"};
      }
    }
    return worst.message.empty() ? std::vector<Violation>{} : std::vector{worst};
  }

  static double distance(const World& world, const Vec3& p) {
    constexpr double kFarthest = 1e5;  // metres
    const double some = nearest_ground(world, p, kFarthest).at_most;
    return some < kInfinity ? nearest_ground(world, p, some - kLengthTolerance).at_most : some;
  }

  std::string sentence(const Vec3& at, double away) const {
    char text[200];
    std::snprintf(text, sizeof text,
                  "at (%.1f, %.1f, %.1f) the route is %.2f m from the nearest ground; at most %.2f "
                  "m are permitted",
                  at.x(), at.y(), at.z(), away, params_.max_m);
    return text;
  }

  Params params_;
  double limit_;  ///< within the tolerance of the judge, with that of the proof
};
}  // namespace

ALTIPLAN_PLUGIN(Constraint, "ground_distance", GroundDistance, Params,
                "Keeps the route within a distance of the nearest ground, in any direction")
