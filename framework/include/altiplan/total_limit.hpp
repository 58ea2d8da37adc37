// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "altiplan/constraint.hpp"

namespace altiplan {

class Objective;

/// A limit on what adds up along a route: the cost by an objective of all its legs. Searches that
/// keep it prune by the objective's bound (astar); the judge adds up every route and track itself.
class ALTIPLAN_API TotalLimit : public Constraint {
 public:
  /// `maximum` in the objective's unit.
  TotalLimit(std::shared_ptr<const Objective> of, double maximum);
  const Objective& of() const { return *of_; }
  double maximum() const { return maximum_; }
  /// Of a route of legs of any kind; empty if it keeps the limit.
  std::vector<Violation> violations_of(const Route& route, const Request& request) const;

 private:
  std::vector<Violation> violations_of(double total) const;
  bool do_admits_all() const override { return true; }
  /// Of a track, at whose points nothing stops: the legs alone.
  std::vector<Violation> do_violations(const Polyline& route,
                                       const Request& request) const override;

  std::shared_ptr<const Objective> of_;
  double maximum_;
};
}  // namespace altiplan
