// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <tuple>

#include "altiplan/check.hpp"

namespace altiplan::kit {

/// Worst excess of a route, or part of one, over each constraint. A constraint is identified by its
/// name, its limit and the side on which it was violated; one without figures counts as 1.
class ALTIPLAN_API Excess {
 public:
  Excess() = default;
  explicit Excess(const std::vector<Violation>& violations) { add(violations); }
  void add(const std::vector<Violation>& violations);
  void add(const Excess& other);
  bool none() const { return worst_.empty(); }
  /// True if no constraint is exceeded by more than in `other`, up to rounding.
  bool within(const Excess& other) const;

 private:
  using Rule = std::tuple<std::string, double, bool>;
  std::map<Rule, double> worst_;
};

/// A waypoint inside a route whose legs do not reverse.
struct ALTIPLAN_API Corner {
  Vec3 at;
  Vec3 into;          ///< unit direction of the leg before it
  Vec3 out_of;        ///< unit direction of the leg after it
  double turn;        ///< radians, in 3-D; 0 where the route goes straight on
  double leg_into;    ///< lengths of the two legs, metres
  double leg_out_of;  ///< metres
  double room_into;   ///< free length of the leg before it, after the curve of the previous corner
  double turn_into;   ///< radians, in 3-D, at the beginning of that free length; 0 at the route's
                      ///< start
  bool last;          ///< the leg after it ends the route

  /// Maximum reach along both legs that leaves half of each leg to the corner beyond, and all of it
  /// where there is none.
  double fair_reach() const;
};

/// Relative loss of a corner's radius when its points are written with the precision of autopilots
/// (1e-7 degree, 1 cm), for legs of that length that turn by `turn`; at most a twentieth. Code that
/// chooses radii keeps this margin.
ALTIPLAN_API double radius_margin(double leg, double turn);

/// Candidate number `attempt` (0, 1, …) for the curve of a corner: points from the leg before to
/// the leg after it; an empty route to cut the corner out; nullopt when no candidate is left.
using CurveOf = std::function<std::optional<Polyline>(const Corner&, int attempt)>;

struct RoundedRoute {
  Polyline route;
  std::int64_t attempts = 0;  ///< curves checked against the constraints; one iteration of the
                              ///< budget each
  std::int64_t corners = 0;   ///< waypoints at which the route turns
  std::int64_t replaced = 0;  ///< corners replaced by a curve
  std::int64_t refused = 0;   ///< corners with candidates, none of which was accepted
  bool budget_hit = false;
};

/// Replaces the corners of a route by curves, from its start on. The worst excess of no constraint
/// grows, neither on the whole route nor around the corner: the first candidate that satisfies
/// every constraint there is taken, else the first that violates none by more than the legs of the
/// corner do, else the corner stays. (A corner kept beside a curve has a shorter leg, and so a
/// smaller circle. Where that violates a constraint, the curve is dropped.)
ALTIPLAN_API RoundedRoute round_corners(const Polyline& route, const Request& request,
                                        const CurveOf& curve_of);
}  // namespace altiplan::kit
