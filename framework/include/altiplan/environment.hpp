// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/drawing.hpp"
#include "altiplan/frame.hpp"
#include "altiplan/random.hpp"
#include "altiplan/vehicle.hpp"
#include "altiplan/voxel_grid.hpp"

namespace altiplan {

class Ground;
class World;

/// A disc that a plane planner avoids.
struct Threat {
  Vec3 centre{0, 0, 0};
  double radius = 0;
  std::string kind;  ///< "radar", "zone", …
  std::string id;
};

/// What a layer knows of an obstacle near a point.
struct Nearby {
  Vec3 point{0, 0, 0};   ///< of the obstacle's surface, nearest to the asking point
  double distance = 0;   ///< metres, negative inside
  Vec3 normal{0, 0, 1};  ///< unit, from the obstacle toward the asking point
  int id = 0;            ///< of the obstacle within its layer
};
using NearSink = std::function<void(const Nearby&)>;

/// What a layer says of itself.
struct LayerInfo {
  std::optional<Frame> frame;           ///< that its files fix, for a world that has none yet
  std::optional<GridSpec> native_grid;  ///< its cells, where it has cells of its own
  std::vector<Threat> threats;          ///< what planners of the plane see of it
  /// What a user should know of what was read ("403 x 344 posts, 236 to 1076 m"), a line each.
  std::vector<std::string> notes;
};

/// What an environment is built from besides its parameters.
struct ALTIPLAN_API Site {
  Frame frame;            ///< without a position until a layer brings one
  std::string frame_crs;  ///< asked for by the scenario's `frame: {crs: …}`, or ""
  Box volume;             ///< infinite where the scenario leaves it to the layers
  Vehicle vehicle;
  const World* before = nullptr;  ///< the layers before this one; never null inside a constructor
  std::optional<Vec3> start;      ///< where already known
  std::optional<Vec3> goal;
  double start_time_s = 0;  ///< of the scenario, seconds since 1970-01-01 UTC; 0 where not given
  bool has_start_time = false;
  RandomStream random;

  /// A user's point in local metres; throws Error saying what is missing (a frame with a position,
  /// ground below it, a layer with cells).
  Vec3 resolve(const Point& point) const;
};

/// A layer of the world: terrain, buildings, zones, radars. Immutable; a solid, closed set.
/// A place that is not finite is blocked and has a clearance of -infinity; the layer is not asked.
///
/// Laws, held by every environment and tested by the conformance suite:
///  1. Pure: built from (parameters, Site) alone; const functions may run on many threads.
///  2. clearance is signed (negative inside), 1-Lipschitz, and never more than the true distance.
///  3. blocked(a, b, r) is true whenever the least distance between the leg and the layer is below
///     r - 1e-6 m; it may be true up to over_approximation() metres above r; touching is free.
///  4. blocked is symmetric in a and b, and monotone in r.
///  5. Its ground, if it has one, holds the laws of Ground. Beyond it the layer blocks nothing: a
///     leg with no ground below part of it is the judge's to refuse.
///  6. rasterize never leaves a cell free that the grid's rule blocks.
class ALTIPLAN_API Environment {
 public:
  virtual ~Environment();

  /// Where the layer's obstacles and ground are; unbounded directions are infinite.
  Box bounds() const { return do_bounds(); }
  double clearance(const Vec3& p) const;
  bool blocked(const Vec3& a, const Vec3& b, double r) const;
  /// Calls the sink once for each obstacle whose distance from p is at most `reach`.
  void near(const Vec3& p, double reach, const NearSink& sink) const;
  void rasterize(VoxelGrid& grid) const { do_rasterize(grid); }
  double over_approximation() const { return do_over_approximation(); }
  /// The ground that the layer brings, or null; as the layer's info, the same for its whole life.
  const Ground* ground() const { return do_ground(); }
  const LayerInfo& info() const { return do_info(); }
  /// Centre of a cell as the layer's file counts it.
  std::optional<Vec3> cell_centre(const std::array<double, 3>& cell) const {
    return do_cell_centre(cell);
  }
  /// What to show of the layer beside its ground; none: whoever shows it asks for its cells.
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
  /// Default: null. A layer with a ground is one itself, as a second base, or has one.
  virtual const Ground* do_ground() const;
  /// Default: nothing to say. A layer that says something keeps it.
  virtual const LayerInfo& do_info() const;
  virtual std::optional<Vec3> do_cell_centre(const std::array<double, 3>& cell) const;
  virtual std::optional<Drawing> do_drawing() const;
};
}  // namespace altiplan
