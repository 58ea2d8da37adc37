// SPDX-License-Identifier: Apache-2.0
// Corners replaced by arcs of the vehicle's turn radius.
//
// Citation: the fillet of two lines; as paths of a vehicle with a minimum turn radius: L. E.
//   Dubins, On curves of minimal length with a constraint on average curvature, American Journal of
//   Mathematics 79, 1957, pp. 497-516, doi:10.2307/2372560 (arcs and tangents, in a plane).
// Guarantees: if every corner is filleted, the route satisfies the turn radius, also when it is
//   written with the precision of autopilots; the largest violation of any constraint does not
//   grow; the route never gets longer.
// Complexity: O(corners · tangents) leg checks.
// Deviations: each arc lies in the plane of its two legs, so that it climbs and turns
//   simultaneously; it is written as equal tangents, whose own fillets are the arc itself: a
//   vehicle that rounds each waypoint with the radius flies the arc. Waypoints on straight
//   stretches are removed first, so that a leg spans the whole straight stretch.
// Symbols: C a corner, u and v the directions into and out of it, R the radius, alpha the turn,
//   t = R tan(alpha / 2) the stretch of each leg that the arc replaces, s = R tan(alpha / 2n) half
//   of each of its n - 1 tangents.
#include <algorithm>
#include <charconv>

#include "altiplan/kit/smoothing/corners.hpp"
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
        .doc("maximum distance of a waypoint outside its arc; auto: a hundredth of the radius");
  }
};

/// Length of each leg that an arc replaces.
double tangent_length(double radius, double turn) { return radius * std::tan(turn / 2); }

/// The arc that touches both legs, as the waypoints at which `turns` equal turns are made: the
/// vertices of its circle's circumscribed polygon.
Polyline arc_at(const Corner& corner, double radius, int turns) {
  const double t = tangent_length(radius, corner.turn);
  const double half = corner.turn / turns / 2;
  const Vec3& u = corner.into;
  const Vec3 inward = (corner.out_of - corner.out_of.dot(u) * u).normalized();
  const Vec3 begin = corner.at - t * u;
  Polyline arc;
  for (int n = 0; n < turns; ++n) {
    const double angle = (2 * n + 1) * half;
    const double outside = radius / std::cos(half);
    arc.push_back(begin + outside * std::sin(angle) * u +
                  (radius - outside * std::cos(angle)) * inward);
  }
  return arc;
}

/// Attempts at an arc, each with twice the turns for a closer approximation.
constexpr int kTries = 3;

/// Initial number of turns of an arc: they satisfy the sag and the turn limits, and the legs
/// between them are no shorter than the minimum leg.
int turns_of(double radius, double sag, double turn, const Limits& limits) {
  const double step = std::min({2 * std::acos(radius / (radius + sag)), kPi / 2,
                                limits.max_turn_space, limits.max_turn_horizontal});
  constexpr double kMax = 1000;
  const double wanted = std::min(std::ceil(turn / std::max(step, turn / kMax)), kMax);
  const double min_angle = 2 * std::atan(limits.min_leg / (2 * radius));
  const double allowed = min_angle > 0 ? std::floor(turn / min_angle) : kMax;
  return int(std::max(1.0, std::min(wanted, allowed)));
}

/// The route without the waypoints at which it goes straight on.
Polyline straightened(const Polyline& route, const Request& request) {
  return kit::round_corners(route, request,
                            [](const Corner& corner, int attempt) {
                              return corner.turn == 0 && attempt == 0 ? std::optional(Polyline{})
                                                                      : std::nullopt;
                            })
      .route;
}

/// True if the legs have enough length for the arc and those before it, each within its half of the
/// remaining leg. (Processing the corners in order leaves the fewest unfilleted: each depends only
/// on its two neighbours.)
bool fits(const Corner& corner, double radius, int turns) {
  const double s = tangent_length(radius, corner.turn / turns);
  const double taken = tangent_length(radius, corner.turn) - s - kLengthTolerance;
  const double before = tangent_length(radius, corner.turn_into);  // needed by the preceding arc
  return taken + 2 * std::max(s, before) <= corner.room_into && taken + 2 * s <= corner.leg_out_of;
}

std::string summary(const kit::RoundedRoute& rounded, double radius) {
  const std::int64_t tight = rounded.corners - rounded.replaced - rounded.refused;
  char text[32];  // not printf: some locales write decimals with a comma
  const char* end =
      std::to_chars(text, text + sizeof text, radius, std::chars_format::general, 6).ptr;
  std::string said = std::to_string(rounded.replaced) + " of " + std::to_string(rounded.corners) +
                     " corners are arcs of " + std::string(text, std::size_t(end - text)) + " m";
  if (tight > 0) {
    said += "; the legs of " + std::to_string(tight) + " are too short for it";
  }
  if (rounded.refused > 0) {
    said += "; " + std::to_string(rounded.refused) + " would violate a constraint";
  }
  return said + (rounded.budget_hit ? "; the budget was used up" : "");
}

class Arc final : public Smoother {
 public:
  explicit Arc(const Params& params) : params_(params) {}

 private:
  PlanResult do_smooth(const Polyline& route, const Request& request) const override {
    PlanResult result;
    const double limit = request.limits.min_turn_radius;
    const double wanted = std::max(params_.radius_m.value.value_or(limit), limit);
    if (wanted <= 0) {
      result.status = PlanStatus::invalid_problem;
      result.message =
          "arc has no radius: set radius_m, or give the problem a turn_radius constraint";
      return result;
    }
    const double sag = params_.sag_m.value.value_or(wanted / 100);
    kit::RoundedRoute rounded = kit::round_corners(
        straightened(route, request), request,
        [&](const Corner& corner, int attempt) -> std::optional<Polyline> {
          if (corner.turn == 0 || attempt >= kTries) {
            return std::nullopt;
          }
          const int turns = turns_of(wanted, sag, corner.turn, request.limits) << attempt;
          const double each = corner.turn / turns;
          const double radius =
              wanted * (1 + kit::radius_margin(2 * tangent_length(wanted, each), each));
          return fits(corner, radius, turns) ? std::optional(arc_at(corner, radius, turns))
                                             : std::nullopt;
        });
    result.status = PlanStatus::solved;
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
