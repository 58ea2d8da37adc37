// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/voxel_grid.hpp"

namespace altiplan {

/// Euclidean distance from each cell to the nearest blocked cell of a voxel grid (the outside half
/// of an ESDF), exact between cell centres, by the lower envelope of parabolas
/// (Felzenszwalb and Huttenlocher, Theory of Computing 8, 2012). O(cells).
class ALTIPLAN_API DistanceField {
 public:
  /// Distances are clamped to `max_m`.
  explicit DistanceField(const VoxelGrid& grid, double max_m = kInfinity);

  const GridSpec& spec() const { return spec_; }
  /// Metres between the centre of c and that of the nearest blocked cell; 0 in a blocked cell.
  double centre_distance(const Cell& c) const;
  /// Lower bound of the distance from p to every blocked cell, metres; 0 outside the grid.
  double clearance(const Vec3& p) const;
  std::size_t bytes() const { return distances_.size() * sizeof(float); }

 private:
  GridSpec spec_;
  std::vector<float> distances_;
};
}  // namespace altiplan
