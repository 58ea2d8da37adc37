// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "altiplan/kit/layers/cell_layer.hpp"
#include "altiplan/kit/layers/ground_body.hpp"
#include "framework/shape_oracle.hpp"
#include "reference/ground_gap.hpp"

// Obstacles of each kind with the convex pieces they were made of: none comes from the library's
// own division into boxes, walls and triangles.
namespace altiplan::oracle {

struct Obstacles {
  std::shared_ptr<const Environment> layer;
  std::vector<Convex> pieces;
  std::shared_ptr<const HeightField> ground;
  Box box;  ///< of what there is to meet

  Gap gap(const Convex& set) const {
    if (ground) {
      return ground_gap(set, *ground);
    }
    const Range own = range(set);
    Gap least;
    for (const Convex& piece : pieces) {
      if (between(own, range(piece)) < least.high) {
        least = nearer(least, separation(set, piece));
      }
    }
    return least;
  }
};

inline void add_piece(Obstacles& all, const std::vector<Vec3>& corners, double disc = 0,
                      double ball = 0) {
  Convex piece{{}, disc, ball};
  for (const Vec3& p : corners) {
    piece.points.push_back(exact(p));
    const Vec3 out(disc + ball, disc + ball, ball);
    all.box = all.box.united({p - out, p + out});
  }
  all.pieces.push_back(std::move(piece));
}

inline void add_upright(Obstacles& all, const std::vector<Point2>& plan, double floor,
                        double ceiling) {
  std::vector<Vec3> corners;
  for (const Point2& p : plan) {
    corners.emplace_back(p[0], p[1], floor);
    corners.emplace_back(p[0], p[1], ceiling);
  }
  add_piece(all, corners);
}

enum class Kind { sphere, cylinder, box, prism, star, cells, mesh, ground };
inline constexpr const char* kKindNames[] = {"sphere", "cylinder", "box",  "prism",
                                             "star",   "cells",    "mesh", "ground"};

/// A shape of the kind about `at`, of at most `size`.
inline Shape add_shape(Obstacles& all, Kind kind, Draw& draw, const Vec3& at, double size) {
  const double tall = size * draw(0.02, 1);
  const double floor = at.z() - tall;
  const double ceiling = at.z() + tall;
  if (kind == Kind::sphere) {
    const double radius = size * draw(0.1, 1);
    add_piece(all, {at}, 0, radius);
    return Sphere{at, radius};
  }
  if (kind == Kind::cylinder) {
    const double radius = size * draw(0.05, 1);
    add_piece(all, {{at.x(), at.y(), floor}, {at.x(), at.y(), ceiling}}, radius);
    return Cylinder{at.x(), at.y(), radius, floor, ceiling};
  }
  if (kind == Kind::box) {
    const Vec3 half(size * draw(0.02, 1), size * draw(0.02, 1), tall);
    const Box box{at - half, at + half};
    add_upright(all,
                {{box.min.x(), box.min.y()},
                 {box.max.x(), box.min.y()},
                 {box.max.x(), box.max.y()},
                 {box.min.x(), box.max.y()}},
                floor, ceiling);
    all.box = all.box.united(box);
    return BoxShape{box};
  }
  if (kind == Kind::prism) {
    Prism prism{{}, {}, floor, ceiling};
    const int corners = 3 + draw.below(7);
    const double turn = draw(0, 2 * kPi);
    for (int n = 0; n < corners; ++n) {  // on a circle, so convex
      const double angle = turn + 2 * kPi * (n + draw(-0.3, 0.3)) / corners;
      prism.outline.push_back({at.x() + size * std::cos(angle), at.y() + size * std::sin(angle)});
    }
    add_upright(all, prism.outline, floor, ceiling);
    return prism;
  }
  const bool has_hole = draw.below(3) > 0;
  const int corners = draw.below(4) == 0 ? 60 : 5 + draw.below(8);
  const Solid solid = star(draw, at.x(), at.y(), size, corners, has_hole, floor, ceiling);
  for (const Triangle& triangle : solid.triangles) {
    add_upright(all, {triangle.begin(), triangle.end()}, floor, ceiling);
  }
  return solid.shape;
}

inline Obstacles shapes_of(Kind kind, Draw& draw, double scale) {
  Obstacles all{nullptr, {}, nullptr, Box::empty()};
  std::vector<Shape> shapes;
  const int count = draw.below(2) == 0 ? 1 : 2 + draw.below(10);
  for (int n = 0; n < count; ++n) {
    const Vec3 at = n == 0 ? Vec3(0, 0, 0) : draw.point(3 * scale);
    shapes.push_back(add_shape(all, kind, draw, at, scale * draw(0.1, 1)));
  }
  all.layer = std::make_shared<kit::ShapeLayer>(shapes);
  return all;
}

/// Some cells of a grid of 5 × 5 × 4, each a piece.
inline Obstacles cells_of(Draw& draw, double scale) {
  Obstacles all{nullptr, {}, nullptr, Box::empty()};
  GridSpec spec;
  spec.rule = GridSpec::Rule::native;
  spec.counts = {5, 5, 4};
  spec.cell = scale * draw.within({0.1, 0.1, 0.1}, {0.4, 0.4, 0.4});
  spec.origin = draw.point(scale);
  VoxelGrid grid(spec);
  const double density = draw(0.02, 0.6);
  for (int n = 0; n < 100; ++n) {
    const Cell cell{n % 5, n / 5 % 5, n / 25};
    if (n == 0 || draw(0, 1) < density) {
      grid.set(cell, true);
      const Box box = spec.cell_box(cell);
      add_upright(all,
                  {{box.min.x(), box.min.y()},
                   {box.max.x(), box.min.y()},
                   {box.max.x(), box.max.y()},
                   {box.min.x(), box.max.y()}},
                  box.min.z(), box.max.z());
    }
  }
  all.layer = std::make_shared<kit::CellLayer>(grid);
  return all;
}

/// Ground over 9 × 9 posts and nothing beyond.
class GroundLayer final : public Environment {
 public:
  explicit GroundLayer(std::shared_ptr<const HeightField> field) : field_(std::move(field)) {}

 private:
  Box do_bounds() const override { return {}; }
  /// A bound that says nothing: all is left to the test of volumes.
  double do_clearance(const Vec3&) const override { return -kInfinity; }
  bool do_blocked(const Vec3&, const Vec3&, double) const override { return true; }
  bool do_meets(const SweptVolume& volume) const override {
    return kit::meets_ground(volume, *field_);
  }

  std::shared_ptr<const HeightField> field_;
};

inline Obstacles ground_of(Draw& draw, double scale) {
  constexpr int kPosts = 9;
  const double spacing = scale / 4;
  const double rough = spacing * std::pow(10, draw(-2, 0.3));
  std::vector<float> heights(kPosts * kPosts);
  for (float& height : heights) {
    height = float(draw(-rough, rough));
  }
  Obstacles all{nullptr, {}, nullptr, {{-scale, -scale, -rough}, {scale, scale, rough}}};
  all.ground = std::make_shared<HeightField>(std::array{-scale, -scale},
                                             std::array{spacing, spacing}, kPosts, kPosts, heights);
  all.layer = std::make_shared<GroundLayer>(all.ground);
  return all;
}
}  // namespace altiplan::oracle
