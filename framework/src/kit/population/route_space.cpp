// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/population/route_space.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"

namespace altiplan::kit {

void RouteSpaceParams::describe(Fields& f) {
  f("encoding", encoding,
    {{"cartesian", Encoding::cartesian},
     {"spherical", Encoding::spherical},
     {"spherical_mirrored", Encoding::spherical_mirrored}})
      .doc(
          "waypoints by their coordinates (cartesian), or each from the one before by length, "
          "climb "
          "and heading of the leg (spherical); spherical_mirrored exchanges sine and cosine of the "
          "heading, as the published program does");
  f("waypoints", waypoints).range(1, 1000).doc("number of waypoints between start and goal");
  f("reach", reach)
      .greater_than(0)
      .at_most(1e6)
      .doc(
          "cartesian: how far a waypoint may lie to each side of its place on the straight line, "
          "in "
          "distances of start and goal");
  f("above_ground_m", above_ground_m)
      .unit("m")
      .doc("minimum and maximum height of waypoints above ground; default: anywhere in the volume");
  f.check(!above_ground_m || (*above_ground_m)[0] <= (*above_ground_m)[1],
          "above_ground_m: expected the lower height first");
}

RouteSpace::RouteSpace(const Request& request, const RouteSpaceParams& params)
    : request_(request),
      params_(params),
      planar_(request.level_m.has_value()),
      heights_(params.above_ground_m.value_or(
          std::array<double, 2>{request.volume.min.z(), request.volume.max.z()})) {
  if (params.above_ground_m && !request.world->has_ground()) {
    throw ParameterError("above_ground_m", "the world has no ground");
  }
}

Polyline RouteSpace::route(std::span<const double> x) const {
  Polyline inner = params_.encoding == Encoding::cartesian ? cartesian(x) : spherical(x);
  for (Vec3& p : inner) {
    p = above_sea(p);
  }
  inner.insert(inner.begin(), request_.start.position);
  inner.push_back(request_.goal.position);
  return inner;
}

/// Of a point whose height is above ground, if such heights are asked for.
Vec3 RouteSpace::above_sea(const Vec3& p) const {
  if (planar_) {
    return {p.x(), p.y(), *request_.level_m};
  }
  const double ground =
      params_.above_ground_m ? request_.world->ground(p.x(), p.y()).value_or(0) : 0;
  return {p.x(), p.y(), ground + p.z()};
}

Polyline RouteSpace::cartesian(std::span<const double> x) const {
  const Vec3& from = request_.start.position;
  const Vec3& to = request_.goal.position;
  const double reach = params_.reach * (to - from).norm();
  Polyline points;
  for (int k = 0; k < params_.waypoints; ++k) {
    const Vec3 place = from + (k + 1.0) / (params_.waypoints + 1) * (to - from);
    Vec3 low = (place - Vec3::Constant(reach)).cwiseMax(request_.volume.min);
    Vec3 high = (place + Vec3::Constant(reach)).cwiseMin(request_.volume.max);
    if (params_.above_ground_m) {
      low.z() = heights_[0];
      high.z() = heights_[1];
    }
    const double* u = x.data() + std::size_t(k) * (planar_ ? 2 : 3);
    points.push_back(low + Vec3(u[0], u[1], planar_ ? 0 : u[2]).cwiseProduct(high - low));
  }
  return points;
}

Polyline RouteSpace::spherical(std::span<const double> x) const {
  const auto height = [&](const Vec3& p) {
    return params_.above_ground_m ? p.z() - request_.world->ground(p.x(), p.y()).value_or(0)
                                  : p.z();
  };
  const Vec3& from = request_.start.position;
  const Vec3& to = request_.goal.position;
  const Vec3 across(to.x() - from.x(), to.y() - from.y(), planar_ ? 0 : height(to) - height(from));
  const double r_max = 2 * across.norm() / params_.waypoints;
  const double phi_0 = std::atan2(across.y(), across.x());
  constexpr double kAngle = kPi / 4;
  const Box& volume = request_.volume;
  Vec3 at(from.x(), from.y(), height(from));
  Polyline points;
  for (int k = 0; k < params_.waypoints; ++k) {
    const double* u = x.data() + std::size_t(k) * (planar_ ? 2 : 3);
    const double r = u[0] * r_max;
    const double phi = phi_0 + (2 * u[1] - 1) * kAngle;
    const double psi = planar_ ? 0 : (2 * u[2] - 1) * kAngle;
    Vec3 heading(std::cos(phi), std::sin(phi), 0);
    if (params_.encoding == Encoding::spherical_mirrored) {
      std::swap(heading.x(), heading.y());
    }
    at += r * (std::cos(psi) * heading + Vec3(0, 0, std::sin(psi)));
    at = {std::clamp(at.x(), volume.min.x(), volume.max.x()),
          std::clamp(at.y(), volume.min.y(), volume.max.y()),
          std::clamp(at.z(), heights_[0], heights_[1])};
    points.push_back(at);
  }
  return points;
}
}  // namespace altiplan::kit
