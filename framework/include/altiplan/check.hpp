// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/request.hpp"

namespace altiplan {

/// The judge's code: exact per leg, no sampling. Smoothers and planners use the same functions, so
/// what they accept the host accepts.
struct CheckResult {
  std::vector<Violation> violations;
  bool ok() const { return violations.empty(); }
};

/// Judges a route: ends, volume, level, every leg, every limit and constraint of the request.
ALTIPLAN_API CheckResult check(const Route& route, const Request& request);

/// Whether the leg a–b, for a vehicle that comes to a by `before`, keeps every constraint that
/// depends on the leg alone (all but route length and the constraints' path-dependent parts).
ALTIPLAN_API bool leg_ok(const std::optional<Approach>& before, const Vec3& a, const Vec3& b,
                         const Request& request);

/// Whether the turn from the approach into the leg a–b keeps the request's limits on turns.
ALTIPLAN_API bool turn_ok(const Approach& before, const Vec3& a, const Vec3& b,
                          const Request& request);

/// What is wrong with the leg, a sentence each; empty if and only if leg_ok. `index` becomes `at`.
ALTIPLAN_API std::vector<Violation> leg_violations(const std::optional<Approach>& before,
                                                   const Vec3& a, const Vec3& b,
                                                   const Request& request, std::size_t index);

/// What makes a point (start, goal, via) impossible in this problem, in words with the figures;
/// empty when nothing does.
ALTIPLAN_API std::string point_problem(const Vec3& p, const Request& request);

/// The limits after every constraint that applies has had its say, and those constraints.
ALTIPLAN_API void apply_constraints(Request& request, std::vector<NamedConstraint> constraints,
                                    AppliesTo to);
}  // namespace altiplan
