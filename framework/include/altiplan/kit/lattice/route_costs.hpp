// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "altiplan/request.hpp"

namespace altiplan::kit {

/// How the altitude of a route and its distance to threats enter its cost.
enum class Accumulate {
  length,  ///< as integrals along the route
  none,    ///< as values at the node reached, paper 002 eqs. (13) and (14)
};

struct CostWeights {
  double length = 1;
  double altitude = 0;
  double threat = 0;
  Accumulate accumulate = Accumulate::length;
  double unit_m = 1000;  ///< of the altitude and of distances to threats

  bool length_alone() const { return altitude == 0 && threat == 0; }
};

/// The cost g = w_L L + w_C C + w_T T of paper 002, eqs. (11) to (14), times the unit, so that it
/// is the length in metres if w_L is 1 and the other weights are 0. L is the length, C the
/// altitude, T = 10 sum 1 / (horizontal distance to a threat's centre), all in units.
///
/// To keep costs finite and not negative, C counts from the lowest position of the search where
/// that lies below sea, and a distance d to a centre counts as sqrt(d² + 1 m²).
///
/// Where the request has an objective, that is the cost, in place of all of these.
class RouteCosts {
 public:
  /// `lowest`: lower bound of z in the search.
  RouteCosts(const CostWeights& weights, const Request& request, double lowest)
      : request_(request), weights_(weights), base_(std::min(lowest, 0.0)) {
    if (request.objective) {
      return;
    }
    sums_ = !weights.length_alone() && weights.accumulate == Accumulate::length;
    at_places_ = !weights.length_alone() && weights.accumulate == Accumulate::none;
    if (weights.threat > 0) {
      for (const Threat& threat : request.world->threats()) {
        centres_.push_back(threat.centre);
      }
    }
    min_per_metre_ =
        weights.length + (sums_ ? weights.altitude * (lowest - base_) / weights.unit_m : 0);
  }

  /// Cost that a leg adds to the cost-to-come of its first end.
  double leg(const Vec3& a, const Vec3& b, double length) const {
    if (request_.objective) {
      return request_.objective->cost(Leg::straight(a, b), 0, request_);
    }
    const double metres = weights_.length * length;
    return sums_ ? metres + terms_along(a, b, length) : metres;
  }
  /// Cost that a node adds to its own evaluation, but not to that of later nodes.
  double at(const Vec3& p) const {
    if (!at_places_) {
      return 0;
    }
    double threat = 0;
    for (const Vec3& centre : centres_) {
      threat += 10 / distance((p - centre).head<2>().squaredNorm());
    }
    const double unit = weights_.unit_m;
    return weights_.altitude * (p.z() - base_) + weights_.threat * threat * unit * unit;
  }
  /// Lower bound of the cost per metre of any path.
  double min_per_metre() const { return min_per_metre_; }
  bool length_alone() const {
    return weights_.length_alone() && weights_.length == 1 && !request_.objective;
  }

 private:
  static constexpr double kGuard = 1;  // metres
  static double distance(double squared) { return std::sqrt(squared + kGuard * kGuard); }

  /// Integrals along the leg: of the altitude by its midpoint, of 1 / distance in closed form.
  double terms_along(const Vec3& a, const Vec3& b, double length) const {
    const double unit = weights_.unit_m;
    double terms = weights_.altitude * ((a.z() + b.z()) / 2 - base_) / unit * length;
    for (const Vec3& centre : centres_) {
      terms += weights_.threat * 10 * unit * over_distance(a - centre, b - centre, length);
    }
    return terms;
  }

  /// The integral of 1 / distance to the z axis along a leg.
  static double over_distance(const Vec3& a, const Vec3& b, double length) {
    const double run = (b - a).head<2>().norm();
    if (run < 1e-9 * length) {
      return length / distance(a.head<2>().squaredNorm());
    }
    // Horizontally along the leg's line, from its point nearest to the axis.
    const double from = a.head<2>().dot((b - a).head<2>()) / run;
    const double beside = distance(std::max(a.head<2>().squaredNorm() - from * from, 0.0));
    return (std::asinh((from + run) / beside) - std::asinh(from / beside)) * length / run;
  }

  const Request& request_;
  CostWeights weights_;
  double base_;
  bool sums_ = false;
  bool at_places_ = false;
  double min_per_metre_ = 1;
  std::vector<Vec3> centres_;
};
}  // namespace altiplan::kit
