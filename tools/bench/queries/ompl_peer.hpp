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

/// OMPL's DiscreteMotionValidator on a grid, with samples at most a cell edge apart; the states of
/// the legs are created beforehand.
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
