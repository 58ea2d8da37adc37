// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "altiplan/body.hpp"
#include "altiplan/check.hpp"
#include "report.hpp"

namespace altiplan::conformance {

/// Solid balls in closed form: queries do not allocate.
class Balls final : public Environment {
 public:
  explicit Balls(std::vector<Sphere> balls);

 private:
  Box do_bounds() const override;
  double do_clearance(const Vec3& p) const override;
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override;
  void do_near(const Vec3& p, double reach, const NearSink& sink) const override;
  double do_over_approximation() const override { return 0; }
  const LayerInfo& do_info() const override { return info_; }
  std::vector<Sphere> balls_;
  LayerInfo info_;
};

/// Balls of one size on the posts of a grid, any number of posts; each query tests only a few.
class BallField final : public Environment {
 public:
  BallField(const Vec3& first, double spacing, const std::array<int, 3>& counts, double radius)
      : first_(first), spacing_(spacing), counts_(counts), radius_(radius) {}

 private:
  Box do_bounds() const override;
  double do_clearance(const Vec3& p) const override;
  void do_near(const Vec3& p, double reach, const NearSink& sink) const override;
  Vec3 first_;
  double spacing_;
  std::array<int, 3> counts_;
  double radius_;
};

/// Ground that rises on both sides to a crest along x = crest_x, in closed form.
class Ridge final : public Environment, public Ground {
 public:
  Ridge(double crest_x, double top, double slope) : x_(crest_x), top_(top), slope_(slope) {}
  double height_at(double x) const { return top_ - slope_ * std::abs(x - x_); }

 private:
  Box do_bounds() const override;
  double do_clearance(const Vec3& p) const override;
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override;
  double do_over_approximation() const override { return 0; }
  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double x, double) const override { return height_at(x); }
  double do_gap(const Vec3& a, const Vec3& b, double enough) const override;
  double do_gap_max(const Vec3& a, const Vec3& b) const override;
  double do_slope(const Box&) const override { return slope_; }
  double x_;
  double top_;
  double slope_;
};

/// Forwards everything to another layer, and reports the position of each obstacle query to
/// `asked`.
class Watched final : public Environment {
 public:
  using Asked = std::function<void(const Vec3&)>;
  Watched(std::shared_ptr<const Environment> inner, Asked asked)
      : inner_(std::move(inner)),
        asked_(std::move(asked)),
        info_{{}, inner_->info().native_grid, {}, {}} {}

 private:
  Box do_bounds() const override { return inner_->bounds(); }
  double do_clearance(const Vec3& p) const override;
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override;
  void do_near(const Vec3& p, double reach, const NearSink& sink) const override;
  void do_rasterize(VoxelGrid& grid) const override;
  double do_over_approximation() const override { return inner_->over_approximation(); }
  const LayerInfo& do_info() const override { return info_; }
  std::shared_ptr<const Environment> inner_;
  Asked asked_;
  LayerInfo info_;  ///< its cells only
};

/// A problem and its parts, so that it can be judged independently of the world's queries.
struct Scene {
  std::string name;  ///< identifies how to reproduce it
  double unit = 1;
  Request request;
  std::vector<Shape> solids;  ///< spheres and boxes
  std::shared_ptr<const Ridge> ridge;
};

/// Flight mode of a scene: `level` for planners that know level flight only, or to test it.
enum class Flight { spatial, level };

/// An empty scene.
Scene open_scene(double unit, Flight flight);
/// Random balls and boxes; start and goal in opposite corners.
Scene random_scene(double unit, std::uint64_t seed, Flight flight);
/// A wall across the straight path, `top` units high, with a long detour around it.
Scene wall_scene(double unit, double top, Flight flight);
/// Ten times as large on each axis, with a million balls in between.
Scene crowded_scene(double unit, Flight flight);
/// Puts a hollow box around the goal, which makes it unreachable.
void enclose_goal(Scene& scene);
/// A crest across the straight path, to be crossed at a height above ground.
Scene ridge_scene(double unit);
/// Cells from text: one string per level from the lowest, rows separated by '/' from the north, '#'
/// solid, 'S' and 'G' start and goal. The cells are the layer's own, with an edge of one unit.
Scene cell_scene(double unit, std::string name, const std::vector<std::string>& levels,
                 Flight flight);
/// Random cells.
Scene random_cells(double unit, std::uint64_t seed, Flight flight);
/// The world of the scene with one more solid, and the corresponding change.
std::shared_ptr<const World> with_solid(Scene& scene, const Shape& solid, const std::string& id,
                                        std::vector<Change>& changes);
/// The scene, translated.
Scene moved_scene(const Scene& scene, const Vec3& by);

/// A body of 0.4 x 1.6 x 0.1 units.
std::shared_ptr<const Body> flat_wing(double unit);

/// Distance to the nearest solid of the scene, by this library's own formulas.
double own_clearance(const Scene& scene, const Vec3& p);

/// The defect of the route, found by dense samples and own formulas; "" for a valid one.
std::string unsound(const Route& route, const Scene& scene);

/// Length of the shortest path over the scene's free cells from start to goal; infinite where there
/// is none.
struct Lanes {
  int neighbours = 26;    ///< or 6; in level flight 8 or 4
  bool free_box = false;  ///< a step needs every cell of its bounding box free
};
double shortest(const Scene& cells, const Lanes& lanes);
/// Makes constraints on a site in a world; null: an empty one. Null for no factory.
Factory<Constraint> on_site(const ConstraintFactory& make, const Options& options,
                            const std::shared_ptr<const World>& before);
}  // namespace altiplan::conformance
