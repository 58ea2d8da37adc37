// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "altiplan/environment.hpp"
#include "altiplan/shape.hpp"

namespace altiplan::kit {

struct CellBoxes;

/// A set of solid shapes with exact queries, each O(log n) by a bounding box tree: the answers are
/// bit by bit those of the closed forms evaluated for every shape.
class ALTIPLAN_API ObstacleSet {
 public:
  explicit ObstacleSet(std::vector<Shape> shapes);
  /// Boxes of cells, which take less memory than shapes; shapes() is then empty.
  static ObstacleSet of_cells(CellBoxes boxes);
  ~ObstacleSet();
  ObstacleSet(ObstacleSet&&) noexcept;
  ObstacleSet& operator=(ObstacleSet&&) noexcept;

  const std::vector<Shape>& shapes() const { return shapes_; }
  const Box& bounds() const { return bounds_; }
  /// Signed distance to the nearest shape's surface, negative inside (minus the maximum depth);
  /// infinite for an empty set.
  double clearance(const Vec3& p) const;
  /// True if the leg comes nearer than r - 1e-6 m to a shape; touching is free.
  bool blocked(const Vec3& a, const Vec3& b, double r) const;
  /// True if a shape shares a point with the volume.
  bool meets(const SweptVolume& volume) const;
  void near(const Vec3& p, double reach, const NearSink& sink) const;
  void rasterize(VoxelGrid& grid) const;

 private:
  struct Impl;
  std::vector<Shape> shapes_;
  Box bounds_;
  std::unique_ptr<Impl> impl_;
};

/// The shapes, each with that role.
ALTIPLAN_API Drawing drawing_of(const std::vector<Shape>& shapes,
                                Drawn::Role role = Drawn::Role::obstacle);

/// Bounding discs of the shapes, seen from above.
ALTIPLAN_API std::vector<Threat> threats_of(const std::vector<Shape>& shapes);

/// An environment that is a set of shapes.
class ALTIPLAN_API ShapeLayer : public Environment {
 public:
  explicit ShapeLayer(std::vector<Shape> shapes);
  /// With another info than the bounding discs of its shapes.
  ShapeLayer(std::vector<Shape> shapes, LayerInfo info)
      : set_(std::move(shapes)), info_(std::move(info)) {}
  const ObstacleSet& set() const { return set_; }

 private:
  Box do_bounds() const override { return set_.bounds(); }
  double do_clearance(const Vec3& p) const override { return set_.clearance(p); }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    return set_.blocked(a, b, r);
  }
  void do_near(const Vec3& p, double reach, const NearSink& sink) const override {
    set_.near(p, reach, sink);
  }
  void do_rasterize(VoxelGrid& grid) const override { set_.rasterize(grid); }
  double do_over_approximation() const override { return 0; }
  const LayerInfo& do_info() const override { return info_; }
  std::optional<Drawing> do_drawing() const override { return drawing_of(set_.shapes()); }
  bool do_meets(const SweptVolume& volume) const override { return set_.meets(volume); }

  ObstacleSet set_;
  LayerInfo info_;
};
}  // namespace altiplan::kit
