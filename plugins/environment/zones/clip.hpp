// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "altiplan/environment.hpp"
#include "altiplan/shape.hpp"

namespace altiplan::zones {

/// Cuts shapes at the sides of a world; heights are let be.
class Clip {
 public:
  /// Throws ParameterError("clip", …) where nothing bounds the world to a side.
  explicit Clip(const Site& site);

  /// The parts of the shape within the bounds: none outside, a prism maybe in several pieces. A
  /// cylinder that reaches in stays whole.
  std::vector<Shape> cut(const Shape& shape);
  /// What was dropped and cut.
  std::string note() const;

 private:
  Box bounds_;
  std::size_t dropped_ = 0;
  std::size_t cut_ = 0;
};
}  // namespace altiplan::zones
