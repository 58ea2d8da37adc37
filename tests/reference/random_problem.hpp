// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "altiplan/environment.hpp"
#include "altiplan/ground.hpp"
#include "reference/lattice_oracle.hpp"
#include "support/support.hpp"

// Small problems drawn from a seed, each both as the framework's request and as the oracle's scene.
namespace altiplan::reference {

/// Slanting ground as a layer.
class GroundPlane final : public Environment, public Ground {
 public:
  explicit GroundPlane(const Plane& plane) : plane_(plane) {}

 private:
  Box do_bounds() const override { return {}; }
  double do_clearance(const Vec3& p) const override { return plane_.above(p) / plane_.steepness(); }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    return std::min(do_clearance(a), do_clearance(b)) < r - kLengthTolerance;
  }
  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double x, double y) const override {
    return -plane_.above({x, y, 0});
  }
  double do_gap(const Vec3& a, const Vec3& b, double) const override {
    return std::min(plane_.above(a), plane_.above(b));
  }
  double do_gap_max(const Vec3& a, const Vec3& b) const override {
    return std::max(plane_.above(a), plane_.above(b));
  }
  double do_slope(const Box&) const override {
    return std::hypot(plane_.slope[0], plane_.slope[1]);
  }
  double do_over_approximation() const override { return 0; }

  Plane plane_;
};

struct Problem {
  Scene scene;
  Request request;
  LatticeOptions lattice;
};

/// True of a last leg from a cell that is more than an edge from the goal: where turns refuse the
/// others, it may make a route that the lattice has not.
inline bool has_long_last_leg(const Route& route, const Problem& problem) {
  if (route.size() < 2) {
    return false;
  }
  const Vec3 leg = route[route.size() - 1] - route[route.size() - 2];
  return (leg.cwiseAbs().cwiseQuotient(problem.lattice.cell).array() > 1 + 1e-9).any();
}

/// The scene as a world, `layers` of them for the solids, the ground last.
inline World world_of(const Scene& scene, std::size_t layers = 1) {
  World world;
  for (std::size_t n = 0; n < layers; ++n) {
    std::vector<Shape> shapes;
    for (std::size_t s = n; s < scene.solids.size(); s += layers) {
      shapes.push_back(scene.solids[s].shape);
    }
    const World one = testing::world_of(std::move(shapes));
    Layer layer = one.layers().front();
    layer.id += std::to_string(n);
    world = world.with(std::move(layer));
  }
  if (scene.ground) {
    world = world.with({"ground", "plane", std::make_shared<GroundPlane>(*scene.ground), true});
  }
  return world;
}

/// What may be in a problem.
struct Mix {
  bool prisms = true;
  bool ground = true;
  bool limits = true;
  double max_cells = 6;  ///< on an axis
};

inline void draw_limits(oracle::Draw& draw, Problem& problem) {
  Limits& limits = problem.request.limits;
  const Vec3& cell = problem.lattice.cell;
  const Vec3 way = problem.request.goal.position - problem.request.start.position;
  if (draw.below(3) == 0) {
    limits.max_climb = radians(draw(15, 80));
  }
  if (draw.below(4) == 0) {
    const Box& volume = problem.request.volume;
    const double least = std::min(0.0, way.z()) + problem.request.start.position.z();
    limits.altitude.push_back({AltitudeBand::Datum::sea, draw(volume.min.z(), least),
                               draw.below(2) == 0 ? kInfinity : draw(least, volume.max.z() + 1)});
  }
  if (draw.below(5) == 0) {
    limits.max_leg = cell.norm() * draw(0.6, 1.1);
  }
  if (draw.below(8) == 0) {
    limits.min_leg = cell.minCoeff() * draw(0.3, 1.5);
  }
  if (draw.below(4) == 0) {
    limits.max_route_length = way.norm() * draw(0.8, 1.8);
  }
  if (draw.below(4) == 0) {
    limits.min_clearance = draw(0, 0.5);
  }
  if (problem.scene.ground && draw.below(2) == 0) {
    limits.min_ground_clearance = draw(0, 1);
  }
  if (problem.scene.ground && draw.below(3) == 0) {
    limits.altitude.push_back(
        {AltitudeBand::Datum::ground, draw(-1, 1), draw.below(2) == 0 ? kInfinity : draw(2, 6)});
  }
}

inline std::unique_ptr<Problem> random_problem(std::uint64_t seed, const Mix& mix = {}) {
  oracle::Draw draw(seed);
  auto problem = std::make_unique<Problem>();
  const Vec3 shapes_of_cells[] = {{1, 1, 1}, {2, 1, 0.5}, {1.3, 0.9, 1.1}};
  problem->lattice.cell = shapes_of_cells[draw.below(3)];
  const Vec3& cell = problem->lattice.cell;
  const bool level = draw.below(4) == 0;
  const Vec3 low = draw.within({-50, -50, -5}, {50, 50, 5});
  const Vec3 size = cell.cwiseProduct(
      draw.within({2, 2, 1}, {mix.max_cells, mix.max_cells, mix.max_cells * 0.7}));
  const Box volume{low, low + size};
  const auto inside = [&] { return draw.within(volume.min, volume.max); };
  const Vec3 start = inside();
  Vec3 goal = inside();
  if (draw.below(2) == 0) {  // a centre
    for (int axis = 0; axis < 3; ++axis) {
      goal[axis] = start[axis] + cell[axis] * std::trunc((goal[axis] - start[axis]) / cell[axis]);
    }
  }
  goal.z() = level ? start.z() : goal.z();
  for (int n = draw.below(9); n > 0; --n) {
    const Vec3 at = inside();
    oracle::Solid solid = oracle::random_solid(draw, at, cell.norm() * draw(0.3, 1));
    while (!mix.prisms && std::holds_alternative<Prism>(solid.shape)) {
      solid = oracle::random_solid(draw, at, cell.norm() * draw(0.3, 1));
    }
    problem->scene.solids.push_back(std::move(solid));
  }
  if (mix.ground && draw.below(4) == 0) {
    problem->scene.ground = Plane{0, {draw(-0.5, 0.5), draw(-0.5, 0.5)}};
    const Plane& plane = *problem->scene.ground;
    problem->scene.ground->height = std::min(plane.above(start), plane.above(goal)) - draw(0.2, 2);
  }
  const std::size_t layers = 1 + std::size_t(draw.below(3));
  problem->request = testing::request_in(world_of(problem->scene, layers), start, goal, volume);
  if (level) {
    problem->request.level_m = start.z();
  }
  if (draw.below(2) == 0) {
    problem->request.vehicle.radius_m = draw(0.05, 0.3);
  }
  if (draw.below(3) == 0) {
    problem->request.goal.tolerance_m = cell.norm() * draw(0.1, 1);
  }
  if (mix.limits) {
    draw_limits(draw, *problem);
  }
  return problem;
}
}  // namespace altiplan::reference
