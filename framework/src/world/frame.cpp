// SPDX-License-Identifier: Apache-2.0
#include "altiplan/frame.hpp"

#include <algorithm>
#include <utility>

#include "altiplan/error.hpp"

namespace altiplan {
namespace {

// WGS 84.
constexpr double kSemiMajor = 6378137.0;
constexpr double kFlattening = 1 / 298.257223563;
constexpr double kEccentricity2 = kFlattening * (2 - kFlattening);

struct Radii {
  double east;   ///< metres per radian of longitude: N cos φ
  double north;  ///< metres per radian of latitude: M
};

Radii radii_at(double lat) {
  const double s = std::sin(radians(lat));
  const double w2 = 1 - kEccentricity2 * s * s;
  const double n = kSemiMajor / std::sqrt(w2);
  return {n * std::cos(radians(lat)), n * (1 - kEccentricity2) / w2};
}

/// Posts of a geographic model stay a regular grid: lon and lat are scaled, not projected.
class AffineProjection final : public Projection {
 public:
  AffineProjection(double lon, double lat, double middle_lat)
      : lon_(lon), lat_(lat), radii_(radii_at(middle_lat)) {}

  std::array<double, 2> to_local(double lon, double lat) const override {
    double east = lon - lon_;
    east -= 360 * std::round(east / 360);  // the shorter direction across the antimeridian
    return {radians(east) * radii_.east, radians(lat - lat_) * radii_.north};
  }

  std::array<double, 2> to_lonlat(double x, double y) const override {
    double lon = lon_ + degrees(x / radii_.east);
    lon -= 360 * std::round(lon / 360);
    return {lon, lat_ + degrees(y / radii_.north)};
  }

 private:
  double lon_;
  double lat_;
  Radii radii_;
};
}  // namespace

Projection::~Projection() = default;

Frame Frame::geographic(double lon, double lat, double middle_lat) {
  return projected(std::make_shared<AffineProjection>(lon, lat, middle_lat), "EPSG:4326, affine");
}

Frame Frame::projected(std::shared_ptr<const Projection> projection, std::string crs) {
  Frame frame;
  frame.projection_ = std::move(projection);
  frame.crs_ = std::move(crs);
  return frame;
}

namespace {
constexpr const char* kNoPosition =
    "the world has no geographic position: add a layer that has one (terrain, zones from GeoJSON), "
    "or give points as at_m";
}

std::array<double, 2> Frame::to_local(double lon, double lat) const {
  if (!has_position()) {
    throw Error(kNoPosition);
  }
  return projection_->to_local(lon, lat);
}

std::array<double, 2> Frame::to_lonlat(double x, double y) const {
  if (!has_position()) {
    throw Error(kNoPosition);
  }
  return projection_->to_lonlat(x, y);
}

double Frame::scale_error(const Box& box) const {
  if (!has_position() || !std::isfinite(box.min.x() + box.max.x() + box.min.y() + box.max.y())) {
    return 0;
  }
  constexpr double kStep = 1;  // metres
  constexpr int kPoints = 8;
  double worst = 0;
  for (int i = 0; i <= kPoints; ++i) {
    for (int j = 0; j <= kPoints; ++j) {
      const double x = box.min.x() + (box.max.x() - box.min.x()) * i / kPoints;
      const double y = box.min.y() + (box.max.y() - box.min.y()) * j / kPoints;
      const auto from = projection_->to_lonlat(x, y);
      for (const auto& [dx, dy] : {std::pair(kStep, 0.0), std::pair(0.0, kStep)}) {
        const auto to = projection_->to_lonlat(x + dx, y + dy);
        const Radii radii = radii_at(from[1]);
        const double lon = to[0] - from[0];
        const double east = radians(lon - 360 * std::round(lon / 360)) * radii.east;
        const double north = radians(to[1] - from[1]) * radii.north;
        worst = std::max(worst, std::abs(std::hypot(east, north) / kStep - 1));
      }
    }
  }
  return worst;
}
}  // namespace altiplan
