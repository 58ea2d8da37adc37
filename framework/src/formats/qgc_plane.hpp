// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "qgc_survey_rule.hpp"

/// \file The planes and spheres on which the ground station lays its lines.
namespace altiplan::formats::qgc {

inline constexpr double kDegree = std::numbers::pi / 180;

// The ground station's own Earths, which its items are made on.
inline constexpr double kPlaneSphere = 6371000;
inline constexpr double kStepSphere = 6371007.2;
inline constexpr double kAxis = 6378137;
inline constexpr double kSquareEccentricity = 6.69437999014e-3;

/// East and north of an origin, metres.
struct East {
  double x = 0;
  double y = 0;
};
struct Place {
  double lat = 0;  ///< degrees
  double lon = 0;
};

/// Lays places on a plane about the first corner, and back.
class Plane {
 public:
  Plane(const Place& origin, SurveyPlane kind) : kind_(kind), origin_(origin) {
    sin_ = std::sin(origin.lat * kDegree);
    cos_ = std::cos(origin.lat * kDegree);
  }

  East lay(const Place& p) const {
    return kind_ == SurveyPlane::sphere ? on_sphere(p) : on_tangent(p);
  }
  Place back(const East& p) const {
    return kind_ == SurveyPlane::sphere ? from_sphere(p) : from_tangent(p);
  }

 private:
  /// Azimuthal equidistant.
  East on_sphere(const Place& p) const {
    const double lat = p.lat * kDegree;
    const double by = (p.lon - origin_.lon) * kDegree;
    const double cosine = sin_ * std::sin(lat) + cos_ * std::cos(lat) * std::cos(by);
    const double c = std::acos(std::min(1.0, cosine));
    const double k = std::abs(c) < 1e-15 ? 1 : c / std::sin(c);
    return {k * std::cos(lat) * std::sin(by) * kPlaneSphere,
            k * (cos_ * std::sin(lat) - sin_ * std::cos(lat) * std::cos(by)) * kPlaneSphere};
  }
  Place from_sphere(const East& p) const {
    const double north = p.y / kPlaneSphere;
    const double east = p.x / kPlaneSphere;
    const double c = std::hypot(north, east);
    if (c < 1e-15) {
      return origin_;
    }
    const double lat = std::asin(std::cos(c) * sin_ + north * std::sin(c) * cos_ / c);
    const double by =
        std::atan2(east * std::sin(c), c * cos_ * std::cos(c) - north * sin_ * std::sin(c));
    return {lat / kDegree, origin_.lon + by / kDegree};
  }

  static std::array<double, 3> centric(const Place& p) {
    const double s = std::sin(p.lat * kDegree);
    const double c = std::cos(p.lat * kDegree);
    const double n = kAxis / std::sqrt(1 - kSquareEccentricity * s * s);
    return {n * c * std::cos(p.lon * kDegree), n * c * std::sin(p.lon * kDegree),
            n * (1 - kSquareEccentricity) * s};
  }
  East on_tangent(const Place& p) const {
    const auto a = centric(origin_);
    const auto b = centric(p);
    const double dx = b[0] - a[0];
    const double dy = b[1] - a[1];
    const double dz = b[2] - a[2];
    const double sl = std::sin(origin_.lon * kDegree);
    const double cl = std::cos(origin_.lon * kDegree);
    return {-sl * dx + cl * dy, -sin_ * cl * dx - sin_ * sl * dy + cos_ * dz};
  }
  Place from_tangent(const East& p) const {
    const auto a = centric(origin_);
    const double sl = std::sin(origin_.lon * kDegree);
    const double cl = std::cos(origin_.lon * kDegree);
    const double x = a[0] - sl * p.x - sin_ * cl * p.y;
    const double y = a[1] + cl * p.x - sin_ * sl * p.y;
    const double z = a[2] + cos_ * p.y;
    const double r = std::hypot(x, y);
    double lat = std::atan2(z, r * (1 - kSquareEccentricity));
    for (int i = 0; i < 6; ++i) {  // converges by a factor of 150 each time
      const double s = std::sin(lat);
      const double n = kAxis / std::sqrt(1 - kSquareEccentricity * s * s);
      lat = std::atan2(z + kSquareEccentricity * n * s, r);
    }
    return {lat / kDegree, std::atan2(y, x) / kDegree};
  }

  SurveyPlane kind_;
  Place origin_;
  double sin_ = 0;
  double cos_ = 1;
};

inline double distance(const Place& a, const Place& b) {
  const double dlat = (b.lat - a.lat) * kDegree;
  const double dlon = (b.lon - a.lon) * kDegree;
  const double h = std::pow(std::sin(dlat / 2), 2) + std::cos(a.lat * kDegree) *
                                                         std::cos(b.lat * kDegree) *
                                                         std::pow(std::sin(dlon / 2), 2);
  return 2 * kStepSphere * std::atan2(std::sqrt(h), std::sqrt(1 - h));
}

inline double azimuth(const Place& a, const Place& b) {
  const double by = (b.lon - a.lon) * kDegree;
  return std::atan2(std::sin(by) * std::cos(b.lat * kDegree),
                    std::cos(a.lat * kDegree) * std::sin(b.lat * kDegree) -
                        std::sin(a.lat * kDegree) * std::cos(b.lat * kDegree) * std::cos(by));
}

inline Place away(const Place& from, double metres, double azimuth) {
  const double arc = metres / kStepSphere;
  const double lat = std::asin(std::sin(from.lat * kDegree) * std::cos(arc) +
                               std::cos(from.lat * kDegree) * std::sin(arc) * std::cos(azimuth));
  const double by = std::atan2(std::sin(azimuth) * std::sin(arc) * std::cos(from.lat * kDegree),
                               std::cos(arc) - std::sin(from.lat * kDegree) * std::sin(lat));
  return {lat / kDegree, from.lon + by / kDegree};
}
}  // namespace altiplan::formats::qgc
