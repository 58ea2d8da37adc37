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

/// A named environment of a world. An unknown layer is discovered in flight.
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
  Box box;            ///< nothing differs outside it
};

/// Immutable snapshot: layers, known moving obstacles, revision. A change makes a new snapshot that
/// shares the layers. All functions are thread-safe.
class ALTIPLAN_API World {
 public:
  World();

  const std::vector<Layer>& layers() const { return layers_; }
  const std::vector<MovingObstacle>& moving() const { return moving_; }
  const Frame& frame() const { return frame_; }
  std::uint64_t revision() const { return revision_; }
  const Layer* find(std::string_view id) const;

  // Each returns a new snapshot with the next revision.
  World with_frame(Frame frame) const;
  World with(Layer layer) const&;
  World with(Layer layer) &&;  ///< empties the old snapshot, so that thousands of layers can be
                               ///< added one by one
  World with_replaced(Layer layer) const;
  World without(std::string_view id) const;
  World with_moving(std::vector<MovingObstacle> moving) const;

  /// Union of the layers' finite bounds; infinite on an axis that no layer bounds.
  Box bounds() const;
  /// Minimum clearance over the layers, without moving obstacles; infinite in an empty world.
  double clearance(const Vec3& p) const;
  /// The layer that blocks the leg for a sphere of radius r, or null.
  const Layer* blocked_by(const Vec3& a, const Vec3& b, double r) const;
  bool blocked(const Vec3& a, const Vec3& b, double r) const {
    return blocked_by(a, b, r) != nullptr;
  }
  /// Obstacles of all layers within reach of p; the sink also gets the layer.
  void near(const Vec3& p, double reach,
            const std::function<void(const Layer&, const Nearby&)>& sink) const {
    near(p, reach, reach, sink);
  }
  /// The same, with a separate reach for layers with ground: a ground search gets slower with its
  /// radius.
  void near(const Vec3& p, double reach, double ground_reach,
            const std::function<void(const Layer&, const Nearby&)>& sink) const;
  bool has_ground() const { return !grounds_.empty(); }
  /// Highest ground of the layers that have ground there.
  std::optional<double> ground(double x, double y) const;
  /// Minimum height of the leg above the ground of any layer; infinite in a world without ground,
  /// -infinity where no layer has ground below a part of the leg.
  double ground_gap(const Vec3& a, const Vec3& b, double enough = kInfinity) const;
  /// True unless the world has ground and part of the leg has none below (or above) it, whatever
  /// its height. Fast. Layers with ground block nothing beyond it, so that other layers may
  /// continue there; callers must therefore keep legs to this check.
  bool ground_below(const Vec3& a, const Vec3& b) const;
  /// Maximum height of the leg above the ground; +infinity where there is none.
  double ground_gap_max(const Vec3& a, const Vec3& b) const;
  /// Maximum slope of the ground within the horizontal box; infinite where it is unknown or ends.
  double ground_slope(const Box& box) const;
  std::vector<Threat> threats() const;
  /// Largest over-approximation of the layers, metres.
  double over_approximation() const;
  std::optional<GridSpec> native_grid() const;

  /// Occupancy of all layers for the spec; built once per spec and revision, and updated only
  /// within the box of a change. Throws BudgetSpent when the time is used up.
  std::shared_ptr<const VoxelGrid> voxels(const GridSpec& spec) const;
  std::shared_ptr<const VoxelGrid> voxels(const GridSpec& spec, const Budget& budget) const;
  /// Distances between the cells of that grid and its blocked cells; built once per spec and
  /// revision.
  std::shared_ptr<const DistanceField> distances(const GridSpec& spec) const;

 private:
  struct Cache;
  static World next(World world);
  void find_grounds();
  void note_ground(std::size_t layer);
  std::vector<Layer> layers_;
  /// Index and ground of each layer that has ground, in layer order.
  std::vector<std::pair<std::size_t, const Ground*>> grounds_;
  std::vector<MovingObstacle> moving_;
  Frame frame_;
  std::uint64_t revision_ = 0;
  std::shared_ptr<Cache> cache_;
};
}  // namespace altiplan
