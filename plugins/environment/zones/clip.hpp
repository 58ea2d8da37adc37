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
  /// Throws ParameterError("clip", …) if the world has no horizontal bounds.
  explicit Clip(const Site& site);

  /// The parts of the shape within the bounds: none if it lies outside, possibly several pieces of
  /// a prism. A cylinder that intersects the bounds stays whole.
  std::vector<Shape> cut(const Shape& shape);
  /// Counts a zone that lies where the frame does not reach.
  void drop() { ++dropped_; }
  /// Number of zones dropped and cut.
  std::string note() const;
  /// Of zones none of which lies within the bounds: what their corners (longitude, latitude) cover,
  /// and whether they would lie within if latitude stood first in their file. "" if one does.
  std::string why_none(const Frame& frame, const std::vector<formats::Point2>& corners) const;

 private:
  Box bounds_;
  std::size_t dropped_ = 0;
  std::size_t kept_ = 0;
  std::size_t cut_ = 0;  ///< of those kept
};
}  // namespace altiplan::zones
