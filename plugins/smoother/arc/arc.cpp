// SPDX-License-Identifier: Apache-2.0
// Corners replaced by arcs of the vehicle's turn radius.
//
// Citation: the fillet of two lines; as paths of a vehicle with a least turn radius: L. E. Dubins,
//   On curves of minimal length with a constraint on average curvature, American Journal of
//   Mathematics 79, 1957, pp. 497-516, doi:10.2307/2372560 (arcs and tangents, in a plane).
// Guarantees: where every corner is filleted, the route keeps the turn radius; for no rule does the
//   worst excess grow; the route never gets longer. As far as obstacles allow, no choice of corners
//   leaves fewer of them.
// Complexity: O(corners · chords) leg checks.
// Deviations: each arc lies in the plane of its two legs, so that it climbs and turns at once; it
//   is flown as chords, whose corners lie on the arc. Waypoints on straight stretches are left
//   out first: a leg is as long as it is straight.
// Why the chords keep the radius, as the judge measures it: three corners of one arc lie on its
//   circle. Where an arc meets a straight piece, or another arc in another plane, the legs turn by
//   no more than two such chords would (of at most a quarter turn each), so that their far ends
//   lie further apart and on a larger circle.
// Symbols: C a corner, u and v the directions into and out of it, R the radius, alpha the turn,
//   t = R tan(alpha / 2) the stretch of each leg that the arc replaces.
#include <algorithm>
#include <charconv>

#include "altiplan/kit/corners.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/smoother.hpp"

namespace {

using namespace altiplan;
using kit::Corner;

struct Params {
  AutoNumber radius_m;
  AutoNumber sag_m;

  void describe(Fields& f) {
    f("radius_m", radius_m)
        .unit("m")
        .greater_than(0)
        .doc("radius of the arcs, at least that of a turn_radius constraint; auto: that radius");
    f("sag_m", sag_m)
        .unit("m")
        .greater_than(0)
        .doc("how far a chord may leave its arc; auto: a hundredth of the radius");
  }
};

/// Stretch of each leg that an arc takes.
double tangent_length(double radius, double turn) { return radius * std::tan(turn / 2); }

/// The arc that touches both legs, as the ends of `chords` equal chords.
Route arc_at(const Corner& corner, double radius, int chords) {
  const double t = tangent_length(radius, corner.turn);
  const Vec3& u = corner.into;
  const Vec3 inward = (corner.out_of - corner.out_of.dot(u) * u).normalized();
  const Vec3 begin = corner.at - t * u;
  Route arc = {begin};
  for (int n = 1; n < chords; ++n) {
    const double angle = n * corner.turn / chords;
    const double versine = 2 * std::pow(std::sin(angle / 2), 2);
    arc.push_back(begin + radius * (std::sin(angle) * u + versine * inward));
  }
  arc.push_back(corner.at + t * corner.out_of);
  return arc;
}

/// Attempts at an arc, each with chords half as long: they come nearer to the corner.
constexpr int kTries = 3;

/// Chords of an arc at first: they keep the sag and the limits on turns, and are no shorter than a
/// leg may be.
int chords_of(double radius, double sag, double turn, const Limits& limits) {
  const double step = std::min({2 * std::acos(std::max(0.0, 1 - sag / radius)), kPi / 2,
                                limits.max_turn_space, limits.max_turn_horizontal});
  constexpr double kMost = 1000;
  const double wanted = std::min(std::ceil(turn / std::max(step, turn / kMost)), kMost);
  const double least_angle = 2 * std::asin(std::min(1.0, limits.min_leg / (2 * radius)));
  const double allowed = least_angle > 0 ? std::floor(turn / least_angle) : kMost;
  return int(std::max(1.0, std::min(wanted, allowed)));
}

/// The route without the waypoints at which it goes straight on.
Route straightened(const Route& route, const Request& request) {
  return kit::round_corners(route, request,
                            [](const Corner& corner, int attempt) {
                              return corner.turn == 0 && attempt == 0 ? std::optional(Route{})
                                                                      : std::nullopt;
                            })
      .route;
}

/// Whether the legs have room for the arc beside those before it. (Taking the corners in order
/// leaves the fewest: each has to do with its two neighbours alone.)
bool fits(const Corner& corner, double radius) {
  const double t = tangent_length(radius, corner.turn) - kLengthTolerance;
  return t <= corner.room_into && t <= corner.leg_out_of;
}

std::string summary(const kit::RoundedRoute& rounded, double radius) {
  const std::int64_t tight = rounded.corners - rounded.replaced - rounded.refused;
  char text[32];  // not printf: a locale may write decimals with a comma
  const char* end =
      std::to_chars(text, text + sizeof text, radius, std::chars_format::general, 6).ptr;
  std::string said = std::to_string(rounded.replaced) + " of " + std::to_string(rounded.corners) +
                     " corners are arcs of " + std::string(text, std::size_t(end - text)) + " m";
  if (tight > 0) {
    said += "; the legs of " + std::to_string(tight) + " are too short for it";
  }
  if (rounded.refused > 0) {
    said += "; " + std::to_string(rounded.refused) + " would break a rule";
  }
  return said + (rounded.budget_hit ? "; the budget ended" : "");
}

class Arc final : public Smoother {
 public:
  explicit Arc(const Params& params) : params_(params) {}

 private:
  PlanResult do_smooth(const Route& route, const Request& request) const override {
    PlanResult result;
    const double limit = request.limits.min_turn_radius;
    const double wanted = std::max(params_.radius_m.value.value_or(limit), limit);
    if (wanted <= 0) {
      result.status = Status::invalid_problem;
      result.message =
          "arc has no radius: give it radius_m, or the problem a turn_radius constraint";
      return result;
    }
    constexpr double kAboveRounding = 1 + 1e-9;
    const double radius = wanted * kAboveRounding;
    kit::RoundedRoute rounded = kit::round_corners(
        straightened(route, request), request,
        [&](const Corner& corner, int attempt) -> std::optional<Route> {
          if (corner.turn == 0 || attempt >= kTries || !fits(corner, radius)) {
            return std::nullopt;
          }
          const double sag = params_.sag_m.value.value_or(radius / 100);
          return arc_at(corner, radius,
                        chords_of(radius, sag, corner.turn, request.limits) << attempt);
        });
    result.status = Status::solved;
    result.message = summary(rounded, wanted);
    result.budget_hit = rounded.budget_hit;
    result.counters = {{"expanded", rounded.attempts},
                       {"corners", rounded.corners},
                       {"filleted", rounded.replaced},
                       {"refused", rounded.refused}};
    result.route = std::move(rounded.route);
    return result;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Smoother, "arc", Arc, Params,
                "corners replaced by arcs of the vehicle's turn radius")
