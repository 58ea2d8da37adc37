// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/limits.hpp"
#include "altiplan/route.hpp"

namespace altiplan {

class World;
struct Request;

/// A straight motion, with the preceding point where there is one.
struct Motion {
  std::optional<Vec3> before;
  Vec3 from{0, 0, 0};
  Vec3 to{0, 0, 0};
  const World* world = nullptr;  ///< of the request; null: nothing is known of it
};

/// Maximum distance, metres, between a turn and the chords that constraints see of it.
inline constexpr double kChordTolerance = 0.01;

/// A violation of a constraint at one place of a route.
struct Violation {
  std::string constraint;  ///< plugin name of the constraint
  std::size_t at = 0;      ///< index of the waypoint, or of the leg's first waypoint
  double value = 0;        ///< in the limit's unit
  double limit = 0;
  std::string message;  ///< a sentence; whatever it names is data as well
  std::string layer{};  ///< id of the layer that it concerns; "" if of none, or of several
  std::string unit{};   ///< of value and limit: "m", "deg", "m/s"; "" where they are no figures

  bool operator==(const Violation&) const = default;
};

enum class AppliesTo { route, track, both };

/// A requirement on routes and tracks. (OMPL's Constraint is a manifold; ours is a condition that a
/// motion satisfies or violates.)
///
/// Contract:
///  1. Pure and const: callable from any number of threads.
///  2. tighten only ever makes a limit stricter.
///  3. admits depends on the leg, the point before it and the world alone. A stricter parameter
///     admits less. A leg through a part that is refused for its place is refused.
///  4. Legs are straight: a turn is given as chords at most kChordTolerance from it.
///  5. violations is empty if and only if the route satisfies the constraint; it covers what
///     tighten and admits cannot express (path-dependent constraints).
///  6. admits_all only if admits refuses nothing: the constraint is then not asked leg by leg.
class ALTIPLAN_API Constraint {
 public:
  virtual ~Constraint();
  AppliesTo applies_to() const { return do_applies_to(); }
  void tighten(Limits& limits, const Request& request) const { do_tighten(limits, request); }
  bool admits(const Motion& leg) const { return do_admits(leg); }
  std::vector<Violation> violations(const Polyline& route, const Request& request) const {
    return do_violations(route, request);
  }
  bool admits_all() const { return do_admits_all(); }

 private:
  virtual AppliesTo do_applies_to() const;
  /// The request has its world, start and goal; its limits are those tightened so far.
  virtual void do_tighten(Limits& limits, const Request& request) const;
  virtual bool do_admits(const Motion& leg) const;
  /// Default: false, which is never wrong. True makes a constraint that only tightens, or only has
  /// violations, cost nothing per leg.
  virtual bool do_admits_all() const;
  virtual std::vector<Violation> do_violations(const Polyline& route, const Request& request) const;
};

/// A constraint under the name that the user gave it.
struct ALTIPLAN_API NamedConstraint {
  std::string name;
  std::shared_ptr<const Constraint> constraint;
  bool admits_all = false;  ///< known to admit every leg: need not be asked

  /// The constraint's admits; exceptions are attributed to `name`.
  bool admits(const Motion& leg) const;
};
}  // namespace altiplan
