// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "altiplan/environment.hpp"
#include "altiplan/formats/polygon.hpp"
#include "altiplan/shape.hpp"

namespace altiplan::zones {

/// The parts of a prism within the horizontal bounds of a box and beyond them.
struct Parts {
  std::vector<Prism> within;
  std::vector<Prism> beyond;
};
/// All of it is beyond if it cannot be cut into polygons that do not touch themselves.
Parts split(const Prism& prism, const Box& box);

/// Cuts shapes at the horizontal bounds of a world; heights are unchanged.
class Clip {
 public:
  /// Throws ParameterError("clip", …) if the world has no horizontal bounds. What lies within
  /// `beyond` metres of them counts as within.
  explicit Clip(const Site& site, double beyond = 0);

  /// The parts of the shape within the bounds: none if it lies outside, possibly several pieces of
  /// a prism. A cylinder that intersects the bounds stays whole.
  std::vector<Shape> cut(const Shape& shape);
  /// Counts a zone that lies where the frame does not reach.
  void drop() { ++dropped_; }
  /// Number of zones dropped and cut.
  std::string note() const;
  /// Of zones none of which lies within the bounds: what their corners (longitude, latitude) cover.
  /// "" if one does.
  std::string why_none(const std::vector<formats::Point2>& corners) const;

 private:
  Box bounds_;
  std::size_t dropped_ = 0;
  std::size_t kept_ = 0;
  std::size_t cut_ = 0;  ///< of those kept
};

/// Bounds of all ground before this layer.
Box ground_area(const World& before);
/// "longitude 8.1 to 8.3 and latitude 47 to 47.2"
std::string extent_text(const std::vector<formats::Point2>& corners);

/// Throws Error if zones far from the world's ground (of a world without ground: its volume) would
/// lie over it if latitude stood first in their file.
void expect_longitude_first(const Site& site, const std::vector<formats::Point2>& corners);
}  // namespace altiplan::zones
