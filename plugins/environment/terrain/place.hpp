// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/environment.hpp"
#include "dem.hpp"

namespace terrain {

/// Where an elevation model's posts stand in the world's frame.
struct Layout {
  altiplan::Frame frame;
  std::array<double, 2> origin;
  std::array<double, 2> spacing;
  int columns = 0;
  int rows = 0;
  bool resampled = false;  ///< the posts are others than the model's
};

/// Where the world has a frame, or the scenario asks for one, the posts are brought into it;
/// otherwise the model's own becomes the world's. Posts that stay a grid along the frame's axes
/// are kept as they are; others are resampled (bilinear) on a grid of the same spacing, over the
/// greatest rectangle that the model covers from edge to edge.
Layout layout_of(const Dem& dem, const altiplan::Site& site, const Params& params);

/// Heights at the layout's posts, from those of the whole model.
std::vector<float> resample(const Dem& dem, const Layout& layout, const std::vector<float>& own);
}  // namespace terrain
