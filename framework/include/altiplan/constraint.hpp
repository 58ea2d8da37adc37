// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/limits.hpp"
#include "altiplan/route.hpp"

namespace altiplan {

struct Request;

/// A straight motion, with the point before it where there is one.
struct Leg {
  std::optional<Vec3> before;
  Vec3 from{0, 0, 0};
  Vec3 to{0, 0, 0};
};

/// A place where a route breaks a rule.
struct Violation {
  std::string constraint;  ///< plugin name of the rule
  std::size_t at = 0;      ///< index of the waypoint, or of the leg's first waypoint
  double value = 0;        ///< in the limit's unit (metres, degrees)
  double limit = 0;
  std::string message;
};

enum class AppliesTo { route, track, both };

/// A requirement on routes and tracks. (OMPL's Constraint is a manifold; ours is a rule that a
/// motion keeps or breaks.)
///
/// Laws:
///  1. Pure and const: any number of threads may ask.
///  2. tighten only ever makes a limit stricter.
///  3. admits depends on the leg alone, and is monotone under the constraint's own parameter.
///  4. violations is empty if and only if the route keeps the rule; it covers what tighten and
///     admits cannot say (the path-dependent rules).
class ALTIPLAN_API Constraint {
 public:
  virtual ~Constraint();
  AppliesTo applies_to() const { return do_applies_to(); }
  void tighten(Limits& limits, const Request& request) const { do_tighten(limits, request); }
  bool admits(const Leg& leg) const { return do_admits(leg); }
  std::vector<Violation> violations(const Route& route, const Request& request) const {
    return do_violations(route, request);
  }

 private:
  virtual AppliesTo do_applies_to() const;
  /// The request's world, start and goal are set; its limits are those so far.
  virtual void do_tighten(Limits& limits, const Request& request) const;
  virtual bool do_admits(const Leg& leg) const;
  virtual std::vector<Violation> do_violations(const Route& route, const Request& request) const;
};

/// A constraint under the name by which the user asked for it.
struct ALTIPLAN_API NamedConstraint {
  std::string name;
  std::shared_ptr<const Constraint> constraint;

  /// The constraint's answer; what it throws gets its name.
  bool admits(const Leg& leg) const;
};
}  // namespace altiplan
