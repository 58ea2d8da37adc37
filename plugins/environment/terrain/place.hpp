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
  Part needed;             ///< of the model's own posts, if these are resampled
};

/// How far from a mission the ground is of interest, metres.
inline constexpr double kReach = 20'000;
/// What is so near to one of the positions, horizontally, in the frame; all of it without
/// positions.
altiplan::Box reach_of(const altiplan::Frame& frame, const std::vector<altiplan::LonLat>& about,
                       double metres);

/// If the world has a frame, or the scenario requests one, the posts are transformed into it;
/// otherwise the model's own becomes the world's, unless lengths in it are wrong by more than half
/// a per cent. Then its axes are scaled to be true in the middle; and where that leaves them wrong
/// elsewhere, the frame is a conformal one about the middle (Frame::local). About the positions of
/// a mission, which alone count then, the axes are always scaled. A site whose `frame_crs` is "own"
/// only looks at a model, in its own axes as they are. Posts that remain a grid along the frame's
/// axes are kept unchanged; others are resampled (bilinear) on a grid of the same spacing, over a
/// rectangle that the model covers: 20 km about a mission, else as large as possible.
Layout layout_of(const Dem& dem, const altiplan::Site& site, const Params& params);

/// Lowers heights above the ellipsoid by those of the geoid.
void bring_to_sea_level(const Dem& dem, Posts& posts);

/// Heights at the layout's posts, from the needed part of the model's own. They are raised where
/// the ground between them would lie below one of the model's posts.
std::vector<float> resample(const Dem& dem, const Layout& layout, const Posts& own);
}  // namespace terrain
