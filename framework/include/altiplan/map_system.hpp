// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>

#include "altiplan/api.hpp"

/// \file The coordinate systems of files, by PROJ, and heights above sea level.
namespace altiplan {

/// Height of the geoid, which is sea level, above the ellipsoid of WGS 84, metres: of EGM96 by the
/// grid of 15' that PROJ's data hold. A height above the ellipsoid less this is one above sea
/// level. Throws Error if the grid is not installed.
ALTIPLAN_API double geoid_height(double lon, double lat);

/// A coordinate system, horizontal and of heights, whose axes are x east (or longitude), y, z up.
/// Its library is loaded by the first.
class ALTIPLAN_API MapSystem {
 public:
  /// From "EPSG:2263", or the URN or address of the OGC for one. Throws Error if it is none.
  explicit MapSystem(const std::string& definition);
  ~MapSystem();
  MapSystem(MapSystem&&) noexcept;
  MapSystem& operator=(MapSystem&&) noexcept;

  const std::string& name() const;
  /// Metres of a unit of x and y; 0 for degrees.
  double unit_m() const;
  /// "heights in US survey foot, above the ellipsoid: brought to sea level by EGM96"
  std::string heights() const;
  /// Longitude and latitude (WGS 84, degrees) and metres above sea level. Throws Error where the
  /// system is undefined. One thread at a time.
  std::array<double, 3> to_wgs84(const std::array<double, 3>& p) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace altiplan
