// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "altiplan/environment.hpp"
#include "altiplan/height_field.hpp"
#include "dem.hpp"

namespace terrain {

/// An elevation model in the world's frame.
struct Placed {
  altiplan::HeightField field;
  altiplan::Frame frame;
  bool resampled = false;
  bool joined = false;  ///< to neighbouring ground
};

/// Where the world has a frame, or the scenario asks for one, the posts are brought into it;
/// otherwise the model's own becomes the world's. Posts that stay a grid along the frame's axes
/// are kept as they are; others are resampled (bilinear) on a grid of the same spacing, over the
/// greatest rectangle that the model covers from edge to edge.
///
/// Tiles often leave a post's spacing between the last post of one and the first of the next. Where
/// ground of the layers before ends within a spacing of a whole side, the model gets a row of posts
/// more there, with that ground's heights.
Placed place(Dem dem, const altiplan::Site& site, const Params& params);
}  // namespace terrain
