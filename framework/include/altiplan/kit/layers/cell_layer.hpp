// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/kit/layers/obstacle_set.hpp"

namespace altiplan::kit {

/// Boxes that cover the blocked cells and share only faces: runs along x, equal runs of
/// neighbouring rows merged, then equal rectangles of neighbouring levels.
ALTIPLAN_API std::vector<Shape> boxes_of(const VoxelGrid& cells);

/// An environment that is a grid of blocked and free cells: exact, the closed union of the blocked
/// ones. Outside its grid it is free. Its info contains its cells and the notes. Cells are indexed
/// from the lower corner; a file with another indexing overrides `do_cell_centre`.
class ALTIPLAN_API CellLayer : public Environment {
 public:
  explicit CellLayer(VoxelGrid cells, std::vector<std::string> notes = {});
  const VoxelGrid& cells() const { return cells_; }

 protected:
  Box do_bounds() const override { return cells_.spec().box(); }
  double do_clearance(const Vec3& p) const override;
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override;
  void do_near(const Vec3& p, double reach, const NearSink& sink) const override {
    solid_.near(p, reach, sink);
  }
  /// A grid of the same cells is copied unchanged.
  void do_rasterize(VoxelGrid& grid) const override;
  double do_over_approximation() const override { return 0; }
  std::optional<Drawing> do_drawing() const override { return drawing_of(boxes_of(cells_)); }
  const LayerInfo& do_info() const override { return info_; }
  bool do_meets(const SweptVolume& volume) const override { return solid_.meets(volume); }
  std::optional<Vec3> do_cell_centre(const std::array<double, 3>& cell) const override;

 private:
  double depth(const Vec3& p) const;
  bool is_inside(const Vec3& p, double half_edge) const;
  bool runs_in_a_seam(const Vec3& a, const Vec3& b) const;

  VoxelGrid cells_;
  LayerInfo info_;
  ObstacleSet solid_;  ///< boxes that cover the blocked cells and share only faces
};
}  // namespace altiplan::kit
