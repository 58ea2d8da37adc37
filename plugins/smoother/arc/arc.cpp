// SPDX-License-Identifier: Apache-2.0
// Corners replaced by turns of the vehicle's radius.
//
// Citation: the fillet of two lines; as paths of a vehicle with a minimum turn radius: L. E.
//   Dubins, On curves of minimal length with a constraint on average curvature, American Journal of
//   Mathematics 79, 1957, pp. 497-516, doi:10.2307/2372560 (arcs and tangents, in a plane).
// Guarantees: the largest violation of any constraint does not grow; between its ends a route whose
//   corners all became turns satisfies the turn radius; without wind it never gets longer.
// Complexity: O(corners) for each judgement of the route, of which there are at most as many as
//   corners.
// Deviations: a turn is horizontal, its height linear in time; in wind it is the trochoid that
//   leaves the first leg and joins the second one tangentially. Waypoints on straight stretches are
//   removed first, so that a leg spans the whole straight stretch.
// Symbols: C a corner, u and v the horizontal directions into and out of it, a and b the stretches
//   of both legs that the turn replaces: its displacement is a u + b v; without wind
//   a = b = R tan(turn / 2).
#include <algorithm>
#include <charconv>

#include "altiplan/kit/smoothing/corners.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/smoother.hpp"

namespace {

using namespace altiplan;
using kit::Corner;
using kit::Excess;

struct Params {
  AutoNumber radius_m;

  void describe(Fields& f) {
    f("radius_m", radius_m)
        .unit("m")
        .greater_than(0)
        .doc("radius of the turns, at least that of a turn_radius constraint; auto: that radius");
  }
};

/// The turn that replaces a corner, and the horizontal stretches of both legs that it takes.
struct Fillet {
  Leg turn;
  double into = 0;
  double out_of = 0;
};

/// The turn of a corner, however long its legs are; none if a leg has no heading, or if they lead
/// straight on or back.
std::optional<Fillet> fillet_of(const Vec3& before, const Vec3& corner, const Vec3& after,
                                double radius, const Request& request) {
  const Vec3 into = corner - before;
  const Vec3 out_of = after - corner;
  if (!has_heading(into) || !has_heading(out_of)) {
    return std::nullopt;
  }
  const Vec3 u = into / into.head<2>().norm();  // climbs
  const Vec3 v = out_of / out_of.head<2>().norm();
  const auto cross = [](const Vec3& p, const Vec3& q) { return p.x() * q.y() - p.y() * q.x(); };
  const auto from = request.heading_on(u, corner);
  const auto to = request.heading_on(v, corner);
  if (std::abs(cross(u, v)) <= kAngleTolerance || !from || !to) {
    return std::nullopt;
  }
  const double turn = std::remainder(*to - *from, 2 * kPi);
  if (radius * std::abs(turn) < kLengthTolerance) {
    return std::nullopt;  // a leg of no length
  }
  const Vec3 drift = radius * std::abs(turn) / request.air_speed() * request.wind.at(corner);
  const Vec3 across = Leg::turning({Vec3::Zero(), *from}, turn, radius, 0, drift).to;
  Fillet fillet{{}, cross(across, v) / cross(u, v), cross(u, across) / cross(u, v)};
  if (fillet.into <= 0 || fillet.out_of <= 0) {
    return std::nullopt;
  }
  const Vec3 begin = corner - fillet.into * u;
  const Vec3 end = corner + fillet.out_of * v;
  fillet.turn = Leg::turning({begin, *from}, turn, radius, end.z() - begin.z(), drift);
  fillet.turn.to = end;
  return fillet;
}

/// A polyline whose corners become turns, from its start on, wherever the legs are long enough.
class Filleting {
 public:
  Filleting(const Polyline& points, double radius, const Request& request) : points_(points) {
    fillets_.resize(points.size());
    double taken = 0;  // of the leg into the corner, by the turn before it
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const auto fillet = fillet_of(points[i - 1], points[i], points[i + 1], radius, request);
      const auto run = [&](std::size_t leg) {
        return (points[leg + 1] - points[leg]).head<2>().norm() + kLengthTolerance / 10;
      };
      if (fillet && taken + fillet->into <= run(i - 1) && fillet->out_of <= run(i)) {
        fillets_[i] = fillet;
      }
      taken = fillets_[i] ? fillets_[i]->out_of : 0;
    }
  }

  std::int64_t count() const {
    return std::count_if(fillets_.begin(), fillets_.end(), [](const auto& f) { return !!f; });
  }

  /// The route with its turns; `corners` are the points that each of its legs depends on: up to
  /// two.
  Route route(std::vector<std::array<std::size_t, 2>>& corners) const {
    Route route{points_.front()};
    corners.clear();
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const Vec3 to = fillets_[i] ? fillets_[i]->turn.from : points_[i];
      if (!fillets_[i] || (to - route.back()).norm() > kLengthTolerance) {
        route.push_back(to);
        corners.push_back({i - 1, i});
      }
      if (fillets_[i]) {
        Leg turn = fillets_[i]->turn;
        turn.from = route.back();
        route.push_back(turn);
        corners.push_back({i, i});
      }
    }
    return route;
  }

  /// Gives up the turns around a leg; false if there are none.
  bool give_up(const std::array<std::size_t, 2>& corners) {
    const bool any = fillets_[corners[0]] || fillets_[corners[1]];
    fillets_[corners[0]].reset();
    fillets_[corners[1]].reset();
    return any;
  }

 private:
  const Polyline& points_;
  std::vector<std::optional<Fillet>> fillets_;  ///< one for each point
};

/// The route without the waypoints at which it goes straight on.
Polyline straightened(const Polyline& route, const Request& request) {
  return kit::round_corners(route, request,
                            [](const Corner& corner, int attempt) {
                              return corner.turn == 0 && attempt == 0 ? std::optional(Polyline{})
                                                                      : std::nullopt;
                            })
      .route;
}

std::string metres(double value) {
  char text[32];  // not printf: some locales write decimals with a comma
  const char* end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6).ptr;
  return {text, std::size_t(end - text)};
}

class Arc final : public Smoother {
 public:
  explicit Arc(const Params& params) : params_(params) {}

 private:
  PlanResult do_smooth(const Polyline& route, const Request& request) const override {
    PlanResult result;
    const double limit = request.limits.min_turn_radius;
    const double radius = std::max(params_.radius_m.value.value_or(limit), limit);
    if (radius <= 0) {
      result.status = PlanStatus::invalid_problem;
      result.message =
          "arc has no radius: set radius_m, or give the problem a turn_radius constraint";
      return result;
    }
    const Polyline points = without_repeats(straightened(route, request));
    Filleting filleting(points, radius, request);
    const std::int64_t corners = std::max<std::int64_t>(std::int64_t(points.size()) - 2, 0);
    const std::int64_t fitting = filleting.count();
    result.status = PlanStatus::solved;
    result.route = judged(filleting, route, request, result);
    const std::int64_t left = filleting.count();
    result.message =
        std::to_string(left) + " of " + std::to_string(corners) + " corners are turns of " +
        metres(radius) + " m" +
        (fitting < corners
             ? "; the legs of " + std::to_string(corners - fitting) + " are too short for it"
             : "") +
        (left < fitting ? "; " + std::to_string(fitting - left) + " would violate a constraint"
                        : "") +
        (result.budget_hit ? "; the budget was used up" : "");
    result.counters.insert(result.counters.end(),
                           {{"corners", corners}, {"filleted", left}, {"refused", fitting - left}});
    return result;
  }

  /// Gives up turns until no constraint is exceeded by more than on the route before.
  static Route judged(Filleting& filleting, const Polyline& before, const Request& request,
                      PlanResult& result) {
    BudgetWatch watch(request.budget);
    std::int64_t judgements = 0;
    std::vector<std::array<std::size_t, 2>> corners;
    const Excess allowed(check(before, request).violations);
    while (filleting.count() > 0 && !(result.budget_hit = watch.spent(std::uint64_t(judgements)))) {
      ++judgements;
      Route route = filleting.route(corners);
      const std::vector<Violation> violations = check(route, request).violations;
      if (Excess(violations).within(allowed)) {
        result.counters = {{"expanded", judgements}};
        return route;
      }
      bool given_up = false;
      for (const Violation& violation : violations) {
        if (violation.at < corners.size() && !Excess({violation}).within(allowed)) {
          // A corner that stays is judged with the leg after it, and has a shorter leg before it.
          given_up = filleting.give_up(corners[violation.at]) ||
                     (violation.at > 0 && filleting.give_up(corners[violation.at - 1])) || given_up;
        }
      }
      if (!given_up) {
        break;  // a constraint on the whole route
      }
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      filleting.give_up(corners[i]);
    }
    result.counters = {{"expanded", judgements}};
    return before;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Smoother, "arc", Arc, Params, "corners replaced by turns of the vehicle's radius")
