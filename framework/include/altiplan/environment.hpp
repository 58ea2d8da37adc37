// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/drawing.hpp"
#include "altiplan/site.hpp"
#include "altiplan/threat.hpp"
#include "altiplan/voxel_grid.hpp"

namespace altiplan {

class Field;
class Ground;
class SweptVolume;

/// An obstacle of a layer near a query point.
struct Nearby {
  Vec3 point{0, 0, 0};   ///< nearest point on the obstacle's surface
  double distance = 0;   ///< metres, negative inside
  Vec3 normal{0, 0, 1};  ///< unit, from the obstacle toward the query point
  int id = 0;            ///< of the obstacle within its layer
};
using NearSink = std::function<void(const Nearby&)>;

/// Self-description of a layer.
struct LayerInfo {
  std::optional<Frame> frame;           ///< defined by its files, for a world without one
  std::optional<GridSpec> native_grid;  ///< its cells, if it has its own
  std::vector<Threat> threats;          ///< the layer as 2-D planners see it
  /// What a user should know about the data read ("403 x 344 posts, 236 to 1076 m"), one per line.
  std::vector<std::string> notes;
};

/// A layer of the world: terrain, buildings, zones, radars. Immutable; a solid, closed set.
/// A position that is not finite is blocked and has clearance -infinity; the layer is not asked.
///
/// Contract of every environment, tested by the conformance suite:
///  1. Pure: built from (parameters, Site) alone; const functions are thread-safe.
///  2. clearance is signed (negative inside), 1-Lipschitz, and never more than the true distance.
///  3. blocked(a, b, r) is true whenever the minimum distance of the leg and the layer is below
///     r - 1e-6 m; it may be true up to over_approximation() metres above r; touching is free.
///  4. blocked is symmetric in a and b, and monotone in r.
///  5. Its ground, if any, fulfils the contract of Ground. The layer blocks nothing beyond it: the
///     judge rejects a leg with no ground below part of it.
///  6. rasterize never leaves a cell free that the grid's blocking rule blocks.
///  7. meets(volume) is true whenever the layer and the volume overlap by more than kBodyTolerance;
///     it may be true while they are up to kBodyTolerance apart, or as far as meets_by_clearance
///     does not tell.
class ALTIPLAN_API Environment {
 public:
  virtual ~Environment();

  /// Extent of the layer's obstacles and ground; unbounded directions are infinite.
  Box bounds() const { return do_bounds(); }
  double clearance(const Vec3& p) const;
  bool blocked(const Vec3& a, const Vec3& b, double r) const;
  /// True if the layer shares a point with what a vehicle's body sweeps.
  bool meets(const SweptVolume& volume) const { return do_meets(volume); }
  /// Calls the sink once for each obstacle whose distance from p is at most `reach`.
  void near(const Vec3& p, double reach, const NearSink& sink) const;
  void rasterize(VoxelGrid& grid) const { do_rasterize(grid); }
  double over_approximation() const { return do_over_approximation(); }
  /// The layer's ground, or null; like info(), constant for the layer's lifetime.
  const Ground* ground() const { return do_ground(); }
  /// The layer's field for objectives, or null; constant likewise.
  const Field* field() const { return do_field(); }
  const LayerInfo& info() const { return do_info(); }
  /// Centre of a cell in the indexing of the layer's file.
  std::optional<Vec3> cell_centre(const std::array<double, 3>& cell) const {
    return do_cell_centre(cell);
  }
  /// How viewers show the layer apart from its ground; none: they show its cells.
  std::optional<Drawing> drawing() const { return do_drawing(); }

 private:
  virtual Box do_bounds() const = 0;
  virtual double do_clearance(const Vec3& p) const = 0;
  /// Default: sphere tracing on clearance in steps of at least over_approximation().
  virtual bool do_blocked(const Vec3& a, const Vec3& b, double r) const;
  /// Default: one obstacle, by clearance and its gradient.
  virtual void do_near(const Vec3& p, double reach, const NearSink& sink) const;
  /// Default: by clearance at cell centres, blocking every cell in doubt.
  virtual void do_rasterize(VoxelGrid& grid) const;
  /// Default 0.05 m.
  virtual double do_over_approximation() const;
  /// Default: null. A layer with ground implements Ground as a second base, or owns one.
  virtual const Ground* do_ground() const;
  /// Default: null, as of do_ground.
  virtual const Field* do_field() const;
  /// Default: empty. A layer with other information stores it.
  virtual const LayerInfo& do_info() const;
  virtual std::optional<Vec3> do_cell_centre(const std::array<double, 3>& cell) const;
  virtual std::optional<Drawing> do_drawing() const;

 protected:
  /// Default: meets_by_clearance.
  virtual bool do_meets(const SweptVolume& volume) const;
};
}  // namespace altiplan
