// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// Second interface of a layer that blocks for several kinds of reason: the judge adds its answer
/// to the layer's name.
class ALTIPLAN_API WhatBlocks {
 public:
  virtual ~WhatBlocks();
  /// What in the layer lies within `distance` metres of the leg, in a few words ("unknown space,
  /// treated as blocked"); "" where the layer's name is enough.
  std::string what_blocks(const Vec3& a, const Vec3& b, double distance) const {
    return do_what_blocks(a, b, distance);
  }

 private:
  virtual std::string do_what_blocks(const Vec3& a, const Vec3& b, double distance) const = 0;
};
}  // namespace altiplan
