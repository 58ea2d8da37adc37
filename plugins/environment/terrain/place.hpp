// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/environment.hpp"
#include "dem.hpp"

namespace terrain {

/// Positions of an elevation model's posts in the world's frame.
struct Layout {
  altiplan::Frame frame;
  std::array<double, 2> origin;
  std::array<double, 2> spacing;
  int columns = 0;
  int rows = 0;
  bool resampled = false;  ///< the posts are not the model's own
};

/// If the world has a frame, or the scenario requests one, the posts are transformed into it;
/// otherwise the model's own becomes the world's. Posts that remain a grid along the frame's axes
/// are kept unchanged; others are resampled (bilinear) on a grid of the same spacing, over the
/// largest rectangle that the model covers from edge to edge.
Layout layout_of(const Dem& dem, const altiplan::Site& site, const Params& params);

/// Heights at the layout's posts, from those of the whole model.
std::vector<float> resample(const Dem& dem, const Layout& layout, const std::vector<float>& own);
}  // namespace terrain
