// SPDX-License-Identifier: Apache-2.0
// Corners rounded by a cubic B-spline.
//
// Citation: C. de Boor: A Practical Guide to Splines, Springer, 1978; applied to thinned grid
//   routes: paper 002 (fusion of constrained A*, smoothing and potential field).
// Guarantees: the largest violation of any constraint does not grow; the route never gets longer. A
//   corner is rounded if one of the reaches tried satisfies every constraint.
// Complexity: O(corners · tries · samples) leg checks.
// Deviations: the control polygon is the route with four more points around each corner, so that
//   the curve lies on the legs except for a stretch of known length at each corner, its reach.
//   There the curve is checked leg by leg; a corner that fails is retried with a smaller reach, and
//   finally left. The radii of a curve grow with its reach and so do its cuts: under a limit of the
//   turn radius the smallest reach that satisfies it is tried last, and nothing below.
// Symbols: C a corner, u and v the directions into and out of it, d the spacing of control points.
#include <algorithm>

#include "altiplan/kit/smoothing/corners.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/smoother.hpp"
#include "spline.hpp"

namespace {

using namespace altiplan;

struct Params {
  AutoNumber reach_m;
  int samples = 4;
  int tries = 5;

  void describe(Fields& f) {
    f("reach_m", reach_m)
        .unit("m")
        .greater_than(0)
        .doc(
            "largest distance from a waypoint at which the curve leaves the legs; auto: up to "
            "half a leg");
    f("samples", samples).range(1, 100).doc("legs for each of the four pieces of a corner's curve");
    f("tries", tries).range(1, 30).doc("attempts at a corner, each with half the reach");
  }
};

/// The spline of the control points C - 2du, C - du, C, C + dv, C + 2dv: it begins and ends on the
/// legs, in their directions.
Polyline curve_at(const Vec3& c, const Vec3& u, const Vec3& v, double d, int samples) {
  const bspline::CubicSpline spline({c - 2 * d * u, c - d * u, c, c + d * v, c + 2 * d * v});
  Polyline curve = {spline.at(0, 0)};
  for (std::size_t piece = 0; piece < spline.pieces(); ++piece) {
    for (int n = 1; n <= samples; ++n) {
      curve.push_back(spline.at(piece, double(n) / samples));
    }
  }
  return curve;
}

/// The smallest reach at which every corner of the curve has the radius, with the margin that the
/// precision of autopilots requires. (The curve leaves its legs in their direction, so that nothing
/// bends where it begins and ends.)
double reach_for(double radius, const kit::Corner& corner, int samples) {
  const Polyline curve = curve_at(Vec3::Zero(), corner.into, corner.out_of, 0.5, samples);
  double minimum = kInfinity;
  double tightest = 0;  // leg and turn of the tightest corner
  double turn = 0;
  for (std::size_t i = 0; i + 2 < curve.size(); ++i) {
    const Vec3 in = curve[i + 1] - curve[i];
    const Vec3 out = curve[i + 2] - curve[i + 1];
    if (const double its = fillet_radius(in, out); its < minimum) {
      minimum = its;
      tightest = std::min(in.norm(), out.norm());
      turn = turn_angle_in_space(in, out);
    }
  }
  const double reach = radius / minimum;
  return reach * (1 + kit::radius_margin(reach * tightest, turn));
}

class BSpline final : public Smoother {
 public:
  explicit BSpline(const Params& params) : params_(params) {}

 private:
  PlanResult do_smooth(const Polyline& route, const Request& request) const override {
    const double radius = request.limits.min_turn_radius;
    kit::RoundedRoute rounded = kit::round_corners(
        route, request,
        [&](const kit::Corner& corner, int attempt) { return curve_of(corner, attempt, radius); });
    PlanResult result;
    result.status = PlanStatus::solved;
    result.route = std::move(rounded.route);
    result.budget_hit = rounded.budget_hit;
    result.message = std::to_string(rounded.replaced) + " of " + std::to_string(route.size() - 2) +
                     " waypoints rounded";
    result.counters = {{"expanded", rounded.attempts}, {"rounded", rounded.replaced}};
    return result;
  }

  std::optional<Polyline> curve_of(const kit::Corner& corner, int attempt, double radius) const {
    if (corner.turn == 0) {
      return std::nullopt;
    }
    const double needed = radius > 0 ? reach_for(radius, corner, params_.samples) : 0;
    const std::optional<double> reach = reach_of(corner, attempt, needed);
    if (!reach) {
      return std::nullopt;
    }
    return curve_at(corner.at, corner.into, corner.out_of, *reach / 2, params_.samples);
  }

  /// The widest reach, halved per attempt while it exceeds what the turn radius needs; then what it
  /// needs. If halves of the legs are too short for that: their full free length.
  std::optional<double> reach_of(const kit::Corner& corner, int attempt, double needed) const {
    const double maximum = params_.reach_m.value.value_or(kInfinity);
    const double widest = std::min(corner.fair_reach(), maximum);
    if (needed > widest) {
      const double free = std::min(
          {corner.room_into, corner.last ? corner.leg_out_of : corner.leg_out_of / 2, maximum});
      return attempt == 0 ? std::optional(needed <= free ? needed : widest) : std::nullopt;
    }
    const auto halved = [&](int times) { return std::ldexp(widest, -times); };
    if (attempt < params_.tries && halved(attempt) > needed) {
      return halved(attempt);
    }
    const bool before = attempt == 0 || (attempt <= params_.tries && halved(attempt - 1) > needed);
    return needed > 0 && before ? std::optional(needed) : std::nullopt;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Smoother, "bspline", BSpline, Params,
                "corners rounded by a cubic B-spline whose every leg is checked")
