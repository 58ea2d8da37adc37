// SPDX-License-Identifier: Apache-2.0
//
// T. Vincenty, Direct and Inverse Solutions of Geodesics on the Ellipsoid with Application of
// Nested Equations, Survey Review XXIII (176), 1975, on WGS 84: within a millimetre over the
// distances of airspace. Symbols as there.
#include <cmath>

#include "airspace_parts.hpp"
#include "altiplan/geometry.hpp"

namespace altiplan::formats {
namespace {

constexpr double kA = 6378137.0;
constexpr double kF = 1 / 298.257223563;
constexpr double kB = kA * (1 - kF);
constexpr int kRounds = 50;
constexpr double kConverged = 1e-13;

struct Series {
  explicit Series(double cos2_alpha) {
    const double u2 = cos2_alpha * (kA * kA - kB * kB) / (kB * kB);
    A = 1 + u2 / 16384 * (4096 + u2 * (-768 + u2 * (320 - 175 * u2)));
    B = u2 / 1024 * (256 + u2 * (-128 + u2 * (74 - 47 * u2)));
  }
  double delta_sigma(double sin_sigma, double cos_sigma, double cos_2sm) const {
    const double c2 = cos_2sm * cos_2sm;
    return B * sin_sigma *
           (cos_2sm + B / 4 *
                          (cos_sigma * (2 * c2 - 1) -
                           B / 6 * cos_2sm * (4 * sin_sigma * sin_sigma - 3) * (4 * c2 - 3)));
  }
  double A;
  double B;
};

/// L - λ
double longitude_excess(double sin_alpha, double cos2_alpha, double sigma, double sin_sigma,
                        double cos_sigma, double cos_2sm) {
  const double C = kF / 16 * cos2_alpha * (4 + kF * (4 - 3 * cos2_alpha));
  return (1 - C) * kF * sin_alpha *
         (sigma + C * sin_sigma * (cos_2sm + C * cos_sigma * (2 * cos_2sm * cos_2sm - 1)));
}
}  // namespace

Point2 geodesic_end(const Point2& from, double bearing_deg, double metres) {
  const double alpha1 = radians(bearing_deg);
  const double sin_alpha1 = std::sin(alpha1);
  const double cos_alpha1 = std::cos(alpha1);
  const double tan_u1 = (1 - kF) * std::tan(radians(from[1]));
  const double cos_u1 = 1 / std::sqrt(1 + tan_u1 * tan_u1);
  const double sin_u1 = tan_u1 * cos_u1;
  const double sigma1 = std::atan2(tan_u1, cos_alpha1);
  const double sin_alpha = cos_u1 * sin_alpha1;
  const double cos2_alpha = 1 - sin_alpha * sin_alpha;
  const Series series(cos2_alpha);
  const double first = metres / (kB * series.A);
  double sigma = first;
  double sin_sigma = 0;
  double cos_sigma = 1;
  double cos_2sm = 0;
  for (int n = 0; n < kRounds; ++n) {
    sin_sigma = std::sin(sigma);
    cos_sigma = std::cos(sigma);
    cos_2sm = std::cos(2 * sigma1 + sigma);
    const double next = first + series.delta_sigma(sin_sigma, cos_sigma, cos_2sm);
    const bool converged = std::abs(next - sigma) < kConverged;
    sigma = next;
    if (converged) {
      break;
    }
  }
  const double along = sin_u1 * sin_sigma - cos_u1 * cos_sigma * cos_alpha1;
  const double lat = std::atan2(sin_u1 * cos_sigma + cos_u1 * sin_sigma * cos_alpha1,
                                (1 - kF) * std::hypot(sin_alpha, along));
  const double lambda =
      std::atan2(sin_sigma * sin_alpha1, cos_u1 * cos_sigma - sin_u1 * sin_sigma * cos_alpha1);
  const double L =
      lambda - longitude_excess(sin_alpha, cos2_alpha, sigma, sin_sigma, cos_sigma, cos_2sm);
  return {from[0] + degrees(L), degrees(lat)};
}

GeodesicCourse geodesic_course(const Point2& from, const Point2& to) {
  const double u1 = std::atan((1 - kF) * std::tan(radians(from[1])));
  const double u2 = std::atan((1 - kF) * std::tan(radians(to[1])));
  const double L = radians(std::remainder(to[0] - from[0], 360));
  double lambda = L;
  for (int n = 0; n < kRounds; ++n) {
    const double east = std::cos(u2) * std::sin(lambda);
    const double north =
        std::cos(u1) * std::sin(u2) - std::sin(u1) * std::cos(u2) * std::cos(lambda);
    const double sin_sigma = std::hypot(east, north);
    if (sin_sigma == 0) {
      return {0, 0};
    }
    const double cos_sigma =
        std::sin(u1) * std::sin(u2) + std::cos(u1) * std::cos(u2) * std::cos(lambda);
    const double sigma = std::atan2(sin_sigma, cos_sigma);
    const double sin_alpha = std::cos(u1) * std::cos(u2) * std::sin(lambda) / sin_sigma;
    const double cos2_alpha = 1 - sin_alpha * sin_alpha;
    const double cos_2sm =
        cos2_alpha > 1e-12 ? cos_sigma - 2 * std::sin(u1) * std::sin(u2) / cos2_alpha : 0;
    const double next =
        L + longitude_excess(sin_alpha, cos2_alpha, sigma, sin_sigma, cos_sigma, cos_2sm);
    if (std::abs(next - lambda) < kConverged || n + 1 == kRounds) {
      const Series series(cos2_alpha);
      const double s = kB * series.A * (sigma - series.delta_sigma(sin_sigma, cos_sigma, cos_2sm));
      return {s, degrees(std::atan2(east, north))};
    }
    lambda = next;
  }
  return {0, 0};
}
}  // namespace altiplan::formats
