// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/distance_field.hpp"
#include "altiplan/environment.hpp"
#include "altiplan/ground.hpp"
#include "altiplan/moving_obstacle.hpp"

namespace altiplan {

struct Budget;

/// A named environment of a world. A layer that is not known is met in flight.
struct Layer {
  std::string id;
  std::string plugin;
  std::shared_ptr<const Environment> environment;
  bool known = true;
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
  World with(Layer layer) const&;
  World with(Layer layer) &&;  ///< leaves the old snapshot empty: thousands are added one by one
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
  bool has_ground() const { return !grounds_.empty(); }
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
  double over_approximation() const;
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
  static World next(World world);
  void find_grounds();
  void note_ground(std::size_t layer);
  std::vector<Layer> layers_;
  /// Of the layers that have one, in their order: the layer's index, and its ground.
  std::vector<std::pair<std::size_t, const Ground*>> grounds_;
  std::vector<MovingObstacle> moving_;
  Frame frame_;
  std::uint64_t revision_ = 0;
  std::shared_ptr<Cache> cache_;
};
}  // namespace altiplan
