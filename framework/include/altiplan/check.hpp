// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/request.hpp"

namespace altiplan {

/// The judge's code: exact per leg, no sampling. Smoothers and planners use the same functions, so
/// the host accepts whatever they accept.
struct CheckResult {
  std::vector<Violation> violations;
  bool ok() const { return violations.empty(); }
};

/// Judges a route: ends, volume, level, every leg, every limit and constraint of the request, and
/// its distance in time from the moving obstacles that it is planned against.
ALTIPLAN_API CheckResult check(const Route& route, const Request& request);

/// True if the leg a–b, for a vehicle that reaches a by `before`, satisfies every constraint that
/// depends on the leg alone (all but route length and the path-dependent parts of constraints), in
/// each wind of one that changes.
ALTIPLAN_API bool leg_ok(const std::optional<Approach>& before, const Vec3& a, const Vec3& b,
                         const Request& request);

/// The same for a leg of any kind. Turns are judged by proof, not by samples: a chord within e of
/// its piece of the turn decides for the whole piece if it keeps or violates a limit by more than
/// e; else the piece is halved until e is below 1e-6 m, where doubt counts as a violation.
ALTIPLAN_API bool leg_ok(const std::optional<Approach>& before, const Leg& leg,
                         const Request& request);

/// True if the turn from the approach into the leg a–b satisfies the request's turn limits.
ALTIPLAN_API bool turn_ok(const Approach& before, const Vec3& a, const Vec3& b,
                          const Request& request);

/// The layer that the vehicle's body meets on a leg, or null; null without a body.
///
/// On a straight leg the attitude is constant. At its beginning the body turns from that of the
/// approach by the shortest rotation (both ways if it reverses); along a turn it yaws with it,
/// banked by atan(speed² / (g radius)), and rolls at its ends. A body whose heading nothing gives
/// (a first leg straight up) must fit at any. On a leg of no length nothing gives an attitude.
ALTIPLAN_API const Layer* body_meets(const std::optional<Approach>& before, const Leg& leg,
                                     const Request& request);

/// True if it meets none; at less cost far from obstacles.
ALTIPLAN_API bool body_ok(const std::optional<Approach>& before, const Leg& leg,
                          const Request& request);

/// True if routes are planned against moving obstacles: the time then matters.
ALTIPLAN_API bool avoids_moving(const Request& request);

/// The moving obstacle, of those that routes are planned against, that comes nearer to the vehicle
/// than allowed (limits.min_clearance, and the sphere around its body) on a leg that begins at
/// `time_s`, in the time of request.start; null if none does. Exact where hits is; turns are judged
/// by proof, as by leg_ok.
ALTIPLAN_API const MovingObstacle* meets_moving(const Leg& leg, double time_s,
                                                const Request& request);

/// Violations of the leg, one sentence each; empty if and only if leg_ok. `index` becomes `at`.
ALTIPLAN_API std::vector<Violation> leg_violations(const std::optional<Approach>& before,
                                                   const Leg& leg, const Request& request,
                                                   std::size_t index);
/// How a vehicle reaches a place, and when, in the time of request.start.
struct ALTIPLAN_API Arrival {
  std::optional<Approach> before;
  double time_s = 0;

  /// At the end of a leg from there: where the wind changes at the end of a turn, the heading
  /// through the air stays, and the track over the ground turns.
  Arrival onward(const Leg& leg, const Request& request) const;
};
/// The same, in the winds of the leg's time alone, of which a straight one may meet several.
ALTIPLAN_API std::vector<Violation> leg_violations(const Arrival& arrival, const Leg& leg,
                                                   const Request& request, std::size_t index);
inline std::vector<Violation> leg_violations(const std::optional<Approach>& before, const Vec3& a,
                                             const Vec3& b, const Request& request,
                                             std::size_t index) {
  return leg_violations(before, Leg::straight(a, b), request, index);
}

/// Why a point (start, goal, via) is infeasible in this problem, in words and figures; "" where it
/// is feasible.
ALTIPLAN_API std::string point_problem(const Vec3& p, const Request& request);
/// The same of a request's start and goal, which may be loiter circles.
ALTIPLAN_API std::string start_problem(const Request& request);
ALTIPLAN_API std::string goal_problem(const Request& request);

/// Adds the constraints that apply to `to` to the request, and tightens its limits by them.
ALTIPLAN_API void apply_constraints(Request& request, std::vector<NamedConstraint> constraints,
                                    AppliesTo to);
}  // namespace altiplan
