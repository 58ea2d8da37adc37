// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "altiplan/voxel_grid.hpp"

namespace altiplan::bench {

struct CellLeg {
  Cell a;
  Cell b;
};

/// OMPL's DiscreteMotionValidator on a grid, a sample a cell edge or nearer; the states of the legs
/// are made beforehand.
class OmplPeer {
 public:
  OmplPeer(const VoxelGrid& grid, const std::vector<CellLeg>& legs);
  ~OmplPeer();
  OmplPeer(OmplPeer&&) noexcept;
  bool is_free(std::size_t leg) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace altiplan::bench
