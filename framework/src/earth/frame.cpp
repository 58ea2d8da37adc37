// SPDX-License-Identifier: Apache-2.0
#include "altiplan/frame.hpp"

#include <GeographicLib/TransverseMercator.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "altiplan/error.hpp"

namespace altiplan {
namespace {

/// Posts of a geographic model stay a regular grid: lon and lat are scaled, not projected.
class AffineProjection final : public Projection {
 public:
  AffineProjection(double lon, double lat, double middle_lat, double middle_lon)
      : lon_(lon), lat_(lat), middle_lon_(middle_lon), radii_(ground_radii(middle_lat)) {}

  std::array<double, 2> to_local(double lon, double lat) const override {
    return {radians(longitude_near(lon, middle_lon_) - lon_) * radii_.east,
            radians(lat - lat_) * radii_.north};
  }

  std::array<double, 2> to_lonlat(double x, double y) const override {
    return {longitude_near(lon_ + degrees(x / radii_.east), 0), lat_ + degrees(y / radii_.north)};
  }

 private:
  double lon_;
  double lat_;
  double middle_lon_;
  GroundRadii radii_;
};

/// C. F. F. Karney, Transverse Mercator with an accuracy of a few nanometers, Journal of Geodesy
/// 85, 2011. True along the meridian of the middle, which any pole lies on.
class LocalProjection final : public Projection {
 public:
  LocalProjection(const LonLat& middle, const LonLat& origin)
      : meridian_(middle[0]), origin_(on_map(origin[0], origin[1])) {}

  std::array<double, 2> to_local(double lon, double lat) const override {
    const auto [x, y] = on_map(lon, lat);
    return {x - origin_[0], y - origin_[1]};
  }

  std::array<double, 2> to_lonlat(double x, double y) const override {
    double lat = 0;
    double lon = 0;
    map().Reverse(meridian_, x + origin_[0], y + origin_[1], lat, lon);
    return {longitude_near(lon, 0), lat};
  }

 private:
  static const GeographicLib::TransverseMercator& map() {
    static const GeographicLib::TransverseMercator kMap(GeographicLib::Constants::WGS84_a(),
                                                        GeographicLib::Constants::WGS84_f(), 1);
    return kMap;
  }
  std::array<double, 2> on_map(double lon, double lat) const {
    std::array<double, 2> at{};
    map().Forward(meridian_, lat, lon, at[0], at[1]);
    return at;
  }

  double meridian_;
  std::array<double, 2> origin_;
};

std::string place_text(const LonLat& p) {
  char text[80];
  std::snprintf(text, sizeof text, "%.5f, %.5f", p[0], p[1]);
  return text;
}
}  // namespace

Projection::~Projection() = default;

Frame Frame::geographic(double lon, double lat, double middle_lat) {
  return geographic(lon, lat, middle_lat, lon);
}

Frame Frame::geographic(double lon, double lat, double middle_lat, double middle_lon) {
  return projected(std::make_shared<AffineProjection>(lon, lat, middle_lat, middle_lon),
                   "EPSG:4326, affine");
}

Frame Frame::local(const LonLat& middle, const LonLat& origin) {
  return projected(std::make_shared<LocalProjection>(middle, origin),
                   "transverse Mercator about " + place_text(middle));
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
  constexpr double kStep = 10;  // metres
  constexpr int kPoints = 8;
  double worst = 0;
  for (int i = 0; i <= kPoints; ++i) {
    for (int j = 0; j <= kPoints; ++j) {
      const double x = box.min.x() + (box.max.x() - box.min.x()) * i / kPoints;
      const double y = box.min.y() + (box.max.y() - box.min.y()) * j / kPoints;
      for (const auto& [dx, dy] : {std::pair(1.0, 0.0), {0.0, 1.0}, {0.6, 0.8}, {0.6, -0.8}}) {
        const double metres =
            geodesic_course(projection_->to_lonlat(x, y),
                            projection_->to_lonlat(x + kStep * dx, y + kStep * dy))
                .metres;
        const double error = std::abs(metres / kStep - 1);
        worst = std::isfinite(error) ? std::max(worst, error) : kInfinity;
      }
    }
  }
  return worst;
}

Box Frame::degrees(const Box& area) const {
  constexpr int kPoints = 8;
  Box range = Box::empty();
  const Vec3 size = area.max - area.min;
  for (int j = 0; j <= kPoints; ++j) {
    double before = range.is_empty() ? kInfinity : range.min.x();
    for (int i = 0; i <= kPoints; ++i) {
      const auto [lon, lat] =
          to_lonlat(area.min.x() + size.x() * i / kPoints, area.min.y() + size.y() * j / kPoints);
      // From one to the next: the area may span more than half of the Earth.
      before = before < kInfinity ? longitude_near(lon, before) : lon;
      range = range.with({before, lat, 0});
    }
  }
  for (const double pole : {-90.0, 90.0}) {
    if (std::abs(range.min.y() + range.max.y() - 2 * pole) > 90) {
      continue;
    }
    const auto [x, y] = to_local(0, pole);
    const auto [back, lat] = to_lonlat(x, y);
    if (x >= area.min.x() && x <= area.max.x() && y >= area.min.y() && y <= area.max.y() &&
        std::abs(lat - pole) < 1e-6) {
      range = range.with({-180, pole, 0}).with({180, pole, 0});
      range.min.x() = -180;
      range.max.x() = 180;
    }
  }
  return range;
}
}  // namespace altiplan
