// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// What a layer that blocks for reasons of several kinds is too: the judge asks it, and puts the
/// answer beside the layer's name.
class ALTIPLAN_API WhatBlocks {
 public:
  virtual ~WhatBlocks();
  /// What of the layer comes as near as that to the leg, in a few words ("unknown space, treated as
  /// blocked"); "" where the layer's name says enough.
  std::string what_blocks(const Vec3& a, const Vec3& b, double distance) const {
    return do_what_blocks(a, b, distance);
  }

 private:
  virtual std::string do_what_blocks(const Vec3& a, const Vec3& b, double distance) const = 0;
};
}  // namespace altiplan
