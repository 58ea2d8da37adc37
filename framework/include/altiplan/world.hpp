// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/distance_field.hpp"
#include "altiplan/environment.hpp"
#include "altiplan/shape.hpp"

namespace altiplan {

struct Budget;

/// A named environment of a world. A layer that is not known is met in flight.
struct Layer {
  std::string id;
  std::string plugin;
  std::shared_ptr<const Environment> environment;
  bool known = true;
};

/// A solid in straight motion: the shape as it is at `since_s`, moving with `velocity`.
struct MovingObstacle {
  std::string id;
  Shape shape;
  Vec3 velocity{0, 0, 0};
  double since_s = 0;
  bool known = true;

  Shape at(double time_s) const { return moved(shape, velocity * (time_s - since_s)); }
};

/// A difference between two snapshots of a world.
struct Change {
  enum class Kind { add, remove, move, set_cells };
  Kind kind = Kind::add;
  std::string layer;  ///< id
  Box box;            ///< outside of it nothing differs
};

/// Immutable snapshot: layers, known moving obstacles, revision. A change makes a new snapshot that
/// shares the layers. All functions may be called from many threads.
class ALTIPLAN_API World {
 public:
  World();
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  World(const World&);
  World& operator=(const World&);

  const std::vector<Layer>& layers() const { return layers_; }
  const std::vector<MovingObstacle>& moving() const { return moving_; }
  const Frame& frame() const { return frame_; }
  std::uint64_t revision() const { return revision_; }
  const Layer* find(std::string_view id) const;

  // A new snapshot, one revision on.
  World with_frame(Frame frame) const;
  World with(Layer layer) const;
  World with_replaced(Layer layer) const;
  World without(std::string_view id) const;
  World with_moving(std::vector<MovingObstacle> moving) const;

  /// Union of the layers' bounds that are finite; per axis infinite where no layer bounds it.
  Box bounds() const;
  /// Least clearance over the layers (moving obstacles are not part of it); infinite in an empty
  /// world.
  double clearance(const Vec3& p) const;
  /// The layer that blocks the leg for a sphere of radius r, or null.
  const Layer* blocked_by(const Vec3& a, const Vec3& b, double r) const;
  bool blocked(const Vec3& a, const Vec3& b, double r) const {
    return blocked_by(a, b, r) != nullptr;
  }
  /// Obstacles of all layers within reach of p; the sink learns the layer too.
  void near(const Vec3& p, double reach,
            const std::function<void(const Layer&, const Nearby&)>& sink) const {
    near(p, reach, reach, sink);
  }
  /// The same, but of layers with ground within `ground_reach`: a search of ground takes the longer
  /// the wider it is.
  void near(const Vec3& p, double reach, double ground_reach,
            const std::function<void(const Layer&, const Nearby&)>& sink) const;
  bool has_ground() const;
  /// Highest ground of the layers that have one there.
  std::optional<double> ground(double x, double y) const;
  /// Least height of the leg above the ground of any layer; infinite in a world without ground,
  /// -infinity where no layer has ground below a part of the leg.
  double ground_gap(const Vec3& a, const Vec3& b, double enough = kInfinity) const;
  /// Whether a leg may be there for all that the ground says: in a world with ground, all of it has
  /// some below (or above: how high it is matters not). Quick. Layers with ground block nothing
  /// beyond it, so that others may go on there; who uses the world keeps legs to this.
  bool ground_below(const Vec3& a, const Vec3& b) const;
  /// Greatest height of the leg above the ground; +infinity where there is none.
  double ground_gap_max(const Vec3& a, const Vec3& b) const;
  std::vector<Threat> threats() const;
  /// Greatest slack of the layers.
  double slack() const;
  std::optional<GridSpec> native_grid() const;

  /// Occupancy of all layers under the spec; built once per spec and revision, a change patches it
  /// inside its box only. Ends by BudgetSpent when the time is used up.
  std::shared_ptr<const VoxelGrid> voxels(const GridSpec& spec) const;
  std::shared_ptr<const VoxelGrid> voxels(const GridSpec& spec, const Budget& budget) const;
  /// Distances between the cells of that grid and its blocked ones; built once per spec and
  /// revision.
  std::shared_ptr<const DistanceField> distances(const GridSpec& spec) const;

 private:
  struct Cache;
  World next() const;
  std::vector<Layer> layers_;
  std::vector<MovingObstacle> moving_;
  Frame frame_;
  std::uint64_t revision_ = 0;
  std::shared_ptr<Cache> cache_;
};

/// Whether a sphere of radius r that flies a–b between the times t0 and t1 comes nearer than r to
/// the moving obstacle: exact, by its relative motion.
ALTIPLAN_API bool hits(const MovingObstacle& obstacle, const Vec3& a, double t0, const Vec3& b,
                       double t1, double r);
/// Least distance between that flight and the obstacle's surface; 0 where they meet.
ALTIPLAN_API double separation(const MovingObstacle& obstacle, const Vec3& a, double t0,
                               const Vec3& b, double t1);
}  // namespace altiplan
