// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "altiplan/earth.hpp"

namespace altiplan {

/// A map projection provided by a layer (GDAL stays in the plugin that read the file).
/// Contract: 1. to_lonlat(to_local(p)) = p within 1e-6 m. 2. Thread-safe.
class ALTIPLAN_API Projection {
 public:
  virtual ~Projection();
  /// Longitude and latitude (WGS 84, degrees) to local east and north (metres).
  virtual std::array<double, 2> to_local(double lon, double lat) const = 0;
  virtual std::array<double, 2> to_lonlat(double x, double y) const = 0;
};

/// The local east-north-up frame of a world, and its georeference, if any.
class ALTIPLAN_API Frame {
 public:
  Frame() = default;

  /// Affine frame of a geographic elevation model: east = Δlon N(φ₀) cos φ₀, north = Δlat M(φ₀)
  /// with the WGS 84 radii of curvature at `middle_lat` (φ₀); (lon, lat) is the origin, degrees.
  static Frame geographic(double lon, double lat, double middle_lat);
  /// The same, whose positions are within 180 degrees of `middle_lon` rather than of the origin.
  static Frame geographic(double lon, double lat, double middle_lat, double middle_lon);
  /// Conformal, with lengths true about `middle`: the transverse Mercator projection whose central
  /// meridian and scale are that place's, poles and the 180th meridian included. A length is off by
  /// d² / (2 R²) at a distance d east or west of it: by 1e-6 at 9 km, 1e-4 at 90 km.
  static Frame local(const LonLat& middle, const LonLat& origin);
  static Frame local(const LonLat& middle) { return local(middle, middle); }
  static Frame projected(std::shared_ptr<const Projection> projection, std::string crs);

  bool has_position() const { return projection_ != nullptr; }
  /// Name of the coordinate system, "" without a position.
  const std::string& crs() const { return crs_; }
  /// Throws Error without a position.
  std::array<double, 2> to_local(double lon, double lat) const;
  std::array<double, 2> to_lonlat(double x, double y) const;
  /// Maximum relative error of a horizontal length within the box, against the WGS 84 ellipsoid
  /// (0.005 = half a per cent); 0 without a position, infinite where the projection is undefined.
  double scale_error(const Box& box) const;
  /// What an area covers: x of the result is longitude, which runs on beyond 180 degrees, y is
  /// latitude. Around a pole it covers all longitudes.
  Box degrees(const Box& area) const;

 private:
  std::shared_ptr<const Projection> projection_;
  std::string crs_;
};

/// A point as a user writes it: `at_m`, `at_lonlat` or `at_cell`, with its own height or a height
/// above the ground. (Origin, cell sizes (m) and counts belong to the grid.)
struct Point {
  enum class Form { none, metres, lonlat, cell };
  Form form = Form::none;
  /// Two or three numbers, in the form's units; metres for the third of lonlat.
  std::array<double, 3> at{0, 0, 0};
  bool has_height = false;
  std::optional<double> above_ground_m;
};
}  // namespace altiplan
