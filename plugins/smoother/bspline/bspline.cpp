// SPDX-License-Identifier: Apache-2.0
// Corners rounded by a cubic B-spline.
//
// Citation: C. de Boor: A Practical Guide to Splines, Springer, 1978; its use on thinned grid
//   routes: paper 002 (fusion of constrained A*, smoothing and potential field).
// Guarantees: every rule that the route kept is kept; the route never gets longer.
// Complexity: O(corners · tries · samples) leg checks.
// Deviations: the control polygon is the route with four more points around each corner, so that
//   the curve lies on the legs but for a stretch of known length at each corner. There the curve
//   is judged leg by leg; a corner that does not pass is tried nearer and nearer, and then left.
// Symbols: C a corner, u and v the directions into and out of it, d the spacing of control points.
#include <algorithm>

#include "altiplan/check.hpp"
#include "altiplan/kit/spline.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/smoother.hpp"

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
        .doc("the curve leaves the legs at most this far from a waypoint; auto: up to half a leg");
    f("samples", samples).range(1, 100).doc("legs for each of the four pieces of a corner's curve");
    f("tries", tries).range(1, 30).doc("attempts at a corner, each with half the reach");
  }
};

/// Appends the spline of the control points C - 2du, C - du, C, C + dv, C + 2dv: it begins and ends
/// on the legs, in their directions.
void append_curve(Route& out, const Vec3& c, const Vec3& u, const Vec3& v, double d, int samples) {
  const kit::CubicSpline curve({c - 2 * d * u, c - d * u, c, c + d * v, c + 2 * d * v});
  for (std::size_t piece = 0; piece < curve.pieces(); ++piece) {
    for (int n = piece == 0 ? 0 : 1; n <= samples; ++n) {
      const Vec3 p = curve.at(piece, double(n) / samples);
      if ((p - out.back()).norm() > kLengthTolerance) {  // the curve before may end here
        out.push_back(p);
      }
    }
  }
}

/// Whether the points of `out` from `first` on, and the two legs of the route beyond (its waypoints
/// from `next` on), keep the rules of legs.
bool sound(const Route& out, std::size_t first, const Route& route, std::size_t next,
           const Request& request) {
  Route part(out.begin() + std::ptrdiff_t(first) - 1, out.end());
  for (std::size_t i = next; i < std::min(next + 2, route.size()); ++i) {
    part.push_back(route[i]);
  }
  std::optional<Vec3> before = first >= 2 ? std::optional(out[first - 2]) : request.before_start();
  for (std::size_t i = 0; i + 1 < part.size(); ++i) {
    if (!leg_ok(before, part[i], part[i + 1], request)) {
      return false;
    }
    before = part[i];
  }
  return true;
}

class BSpline final : public Smoother {
 public:
  explicit BSpline(const Params& params) : params_(params) {}

 private:
  PlanResult do_smooth(const Route& route, const Request& request) const override {
    const Route clean = without_repeats(route);
    PlanResult result;
    result.status = Status::solved;
    BudgetWatch watch(request.budget);
    std::uint64_t attempts = 0;
    std::int64_t rounded = 0;
    // The points of `out`, then the waypoints still to come, are sound after every corner.
    Route out = {clean.front()};
    for (std::size_t i = 1; i + 1 < clean.size(); ++i) {
      const Vec3 into = clean[i] - clean[i - 1];
      const Vec3 from = clean[i + 1] - clean[i];
      double reach =
          std::min({into.norm() / 2, from.norm() / 2, params_.reach_m.value.value_or(kInfinity)});
      const bool corner = turn_angle_in_space(into, from) > kAngleTolerance;
      Route curved;
      for (int attempt = 0; corner && attempt < params_.tries && curved.empty(); ++attempt) {
        if (watch.spent(attempts)) {
          result.budget_hit = true;
          break;
        }
        ++attempts;
        curved = out;
        append_curve(curved, clean[i], into.normalized(), from.normalized(), reach / 2,
                     params_.samples);
        if (!sound(curved, out.size(), clean, i + 1, request)) {
          curved.clear();
        }
        reach /= 2;
      }
      rounded += !curved.empty();
      if (curved.empty()) {
        out.push_back(clean[i]);
      } else {
        out = std::move(curved);
      }
    }
    out.push_back(clean.back());
    // Rules of whole routes have the last word.
    if (check(out, request).violations.size() > check(route, request).violations.size()) {
      out = route;
      rounded = 0;
    }
    result.route = std::move(out);
    result.message =
        std::to_string(rounded) + " of " + std::to_string(route.size() - 2) + " waypoints rounded";
    result.counters = {{"expanded", std::int64_t(attempts)}, {"rounded", rounded}};
    return result;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Smoother, "bspline", BSpline, Params,
                "corners rounded by a cubic B-spline whose every leg is judged")
