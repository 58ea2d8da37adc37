// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <tuple>

#include "altiplan/check.hpp"

namespace altiplan::kit {

/// What a route, or part of one, exceeds each rule by at worst. A rule is told by its name, its
/// limit and the side on which it was broken; one that gives no figures counts as 1.
class ALTIPLAN_API Excess {
 public:
  Excess() = default;
  explicit Excess(const std::vector<Violation>& violations) { add(violations); }
  void add(const std::vector<Violation>& violations);
  void add(const Excess& other);
  bool none() const { return worst_.empty(); }
  /// Whether no rule is exceeded by more than there, but for rounding.
  bool within(const Excess& other) const;

 private:
  using Rule = std::tuple<std::string, double, bool>;
  std::map<Rule, double> worst_;
};

/// A waypoint inside a route, whose legs do not run straight back.
struct ALTIPLAN_API Corner {
  Vec3 at;
  Vec3 into;          ///< direction of the leg before it, of length 1
  Vec3 out_of;        ///< of the leg after it
  double turn;        ///< radians, in space; 0 where the route goes straight on
  double leg_into;    ///< lengths of the two legs, metres
  double leg_out_of;  ///< metres
  double room_into;   ///< of the leg before it, what the curve of the corner before left free
  double turn_into;   ///< radians, in space; at the beginning of that, 0 at the route's
  bool last;          ///< the leg after it ends the route

  /// The longest stretches of both legs that leave half of each leg to the corner beyond, and all
  /// of it to none.
  double fair_reach() const;
};

/// By how much, as a share of it, the radius of a corner may shrink when its points are written
/// with the digits that autopilots keep (1e-7 degree, 1 cm), for legs of that length that turn by
/// `turn`; at most a twentieth. Makers of radii leave that margin.
ALTIPLAN_API double radius_margin(double leg, double turn);

/// The attempt-th choice (0, 1, …) of a curve in place of a corner: points from its leg before to
/// its leg after; none to leave the corner out; nothing when no choice is left.
using CurveOf = std::function<std::optional<Route>(const Corner&, int attempt)>;

struct RoundedRoute {
  Route route;
  std::int64_t attempts = 0;  ///< curves held to the rules; one iteration of the budget each
  std::int64_t corners = 0;   ///< waypoints at which the route turns
  std::int64_t replaced = 0;  ///< waypoints in whose place a curve stands
  std::int64_t refused = 0;   ///< waypoints for which there were curves, and none stands
  bool budget_hit = false;
};

/// Puts curves in place of a route's corners, from its start on. For no rule of the request does
/// the worst excess grow, neither on the whole route nor around the corner: of the choices the
/// first that keeps every rule there is taken, else the first that breaks none by more than the
/// legs of the corner do, else the corner stays. (A corner that stays beside a curve has a shorter
/// leg, which makes its own circle smaller. Where that breaks a rule, the curve goes.)
ALTIPLAN_API RoundedRoute round_corners(const Route& route, const Request& request,
                                        const CurveOf& curve_of);
}  // namespace altiplan::kit
