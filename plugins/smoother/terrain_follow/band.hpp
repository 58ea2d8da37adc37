// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/request.hpp"

namespace terrain_follow {

/// A route seen from above: positions by the horizontal distance s from its start.
class Plan {
 public:
  /// The route must not be vertical.
  explicit Plan(const altiplan::Polyline& route);
  /// Horizontal length of a route.
  static double span(const altiplan::Polyline& route);

  double length() const { return along_.back(); }
  /// Where the plan turns, with both ends; waypoints stay there.
  const std::vector<double>& corners() const { return corners_; }
  altiplan::Vec3 at(double s, double z) const;
  /// Height of the route; where it is vertical, of the end of that.
  double route_height(double s) const;

 private:
  struct Share {
    std::size_t leg;
    double share;
  };
  Share share_at(double s) const;

  altiplan::Polyline points_;  ///< no two at one position
  std::vector<double> along_;
  std::vector<double> corners_;
};

/// The heights that are permitted at one position: those connected by permitted heights to the
/// route's, or to the permitted height that is nearest to it. Up to 1e-5 m too wide.
struct Column {
  double s = 0;
  double low = altiplan::kInfinity;  ///< above `high`: none was found
  double high = -altiplan::kInfinity;
};

/// Asks the request what is permitted at a place, whatever leg leads there.
class Band {
 public:
  Band(const altiplan::Request& request, const Plan& plan, const altiplan::Polyline& route);

  Column column(double s) const;
  /// True if all places of the leg are permitted.
  bool permits(const altiplan::Vec3& a, const altiplan::Vec3& b) const;

 private:
  double farthest(double s, double from, double to) const;
  bool find_height(double s, double& z) const;

  const Plan& plan_;
  altiplan::Request places_;  ///< the request without what depends on legs
};
}  // namespace terrain_follow
