// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "altiplan/constraint.hpp"

namespace altiplan {

class Objective;

/// A limit on what adds up along a route: the cost by an objective of all its legs, and perhaps on
/// what must be left of it wherever the route is. Searches that keep it prune by the objective's
/// bound and by what must be left; the judge adds up every route and track itself.
class ALTIPLAN_API TotalLimit : public Constraint {
 public:
  /// `maximum` in the objective's unit.
  TotalLimit(std::shared_ptr<const Objective> of, double maximum);
  const Objective& of() const { return *of_; }
  double maximum() const { return maximum_; }
  /// What a route that has come to p must not have taken yet: what the way home takes from there.
  /// Default: 0. Infinite: no route may come there. May return any value that is not below it, of
  /// at most `enough`, once that is known to suffice.
  double left_at(const Vec3& p, const Request& request, double enough = 0) const {
    return do_left_at(p, request, enough);
  }
  /// Of a route of legs of any kind; empty if it keeps the limit, at each waypoint with what must
  /// be left there.
  std::vector<Violation> violations_of(const Route& route, const Request& request) const;

 private:
  virtual double do_left_at(const Vec3& p, const Request& request, double enough) const;
  bool do_admits_all() const override { return true; }
  /// Of a track, at whose points nothing stops: the legs alone.
  std::vector<Violation> do_violations(const Polyline& route,
                                       const Request& request) const override;

  std::shared_ptr<const Objective> of_;
  double maximum_;
};
}  // namespace altiplan
