// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "altiplan/params.hpp"
#include "altiplan/request.hpp"

namespace altiplan::kit {

/// How the numbers of an individual become a route.
enum class Encoding { cartesian, spherical, spherical_mirrored };

struct ALTIPLAN_API RouteSpaceParams {
  Encoding encoding = Encoding::cartesian;
  int waypoints = 5;
  double reach = 0.5;
  std::optional<std::array<double, 2>> above_ground_m;

  void describe(Fields& f);
};

/// Numbers of an individual, each in [0, 1].
using Position = std::vector<double>;

/// Routes of a fixed number of waypoints between start and goal as points of a unit cube.
///
/// cartesian: waypoint k lies in a box about the k-th of equally spaced places on the straight
/// line, `reach` times the distance of the ends to each side, cut to the volume. spherical: a step
/// from the waypoint before, by its length (up to twice the even one), its climb and its heading
/// (up to 45 degrees from that of the straight line); M. D. Phung, Q. P. Ha, 2021,
/// doi:10.1016/j.asoc.2021.107376. Each step ends within the volume and the heights.
/// spherical_mirrored: the same with sine and cosine of the heading exchanged, as in the authors'
/// program, which mirrors the headings about the diagonal.
class ALTIPLAN_API RouteSpace {
 public:
  /// The request must outlive this object. Throws ParameterError where heights above ground are
  /// asked for in a world without ground.
  RouteSpace(const Request& request, const RouteSpaceParams& params);

  /// Two for each waypoint in level flight, else three.
  std::size_t dimensions() const { return std::size_t(params_.waypoints) * (planar_ ? 2 : 3); }
  Polyline route(std::span<const double> x) const;

 private:
  Polyline cartesian(std::span<const double> x) const;
  Polyline spherical(std::span<const double> x) const;
  Vec3 above_sea(const Vec3& p) const;

  const Request& request_;
  RouteSpaceParams params_;
  bool planar_;
  std::array<double, 2> heights_;  ///< above ground, or the sea
};
}  // namespace altiplan::kit
