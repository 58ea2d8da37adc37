// SPDX-License-Identifier: Apache-2.0
#include "problems.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include "altiplan/check.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"
#include "measuring.hpp"
#include "ridges.hpp"

namespace altiplan::bench {
namespace {

constexpr double kSide = 30e3;     // metres, of the generated ridges
constexpr double kClearance = 50;  // metres above ground
constexpr double kFloor = 0.1;     // share of the ground below the volume
constexpr double kEnds = 60;       // metres of start and goal above the ground within a cell
constexpr double kRing = 0.1;      // radius of a ring around the goal, of the shorter side
/// Height of a cell over its edge: its steepest step climbs 14 degrees.
constexpr double kFlatness = 0.25;
const std::vector<std::string> kFew = {"ground_clearance {min_m: 50}"};
const std::vector<std::string> kAll = {kFew.front(), "climb_angle {max_deg: 15}",
                                       "turn_angle {max_deg: 60}"};

/// Ground, and a flight over it.
struct Flight {
  Relief relief;
  Box volume;
  Vec3 start;
  Vec3 goal;

  Vec3 sides() const { return volume.max - volume.min; }
  double ring_m() const { return kRing * sides().head<2>().minCoeff(); }
};

double longer_side(const Relief& relief) {
  const Box box = relief.layer->bounds();
  return (box.max - box.min).head<2>().maxCoeff();
}

/// With the volume's ceiling where that share of the ground may be flown over. The ends are centres
/// of cells above valleys in the south-west, and in the east at a share of the sides to the north;
/// at least at the clearance from that share of the ground.
Flight flight_over(const Relief& relief, double ceiling, double level, double north,
                   double cell_m) {
  const HeightField& field = *relief.field;
  const Box ground = relief.layer->bounds();
  const double min_height = height_quantile(field, level) + kClearance;
  const Vec3 low(ground.min.x(), ground.min.y(), height_quantile(field, kFloor));
  const Vec3 high(ground.max.x(), ground.max.y(), height_quantile(field, ceiling) + kClearance);
  const Vec3 sides = high - low;
  const auto valley = [&](double x, double y) {
    const double reach = 0.04 * sides.head<2>().minCoeff();
    return lowest_post(field, low + Vec3(x, y, 0).cwiseProduct(sides), reach);
  };
  const auto above = [&](const Vec3& p) {
    const double top =
        field.max_height(p.x() - cell_m, p.y() - cell_m, p.x() + cell_m, p.y() + cell_m);
    return std::max(min_height, top + kEnds);
  };
  Vec3 start = valley(0.15, 0.15);
  start.z() = above(start);
  const Vec3 cell(cell_m, cell_m, kFlatness * cell_m);
  const Vec3 apart = (valley(0.83, north) - start).cwiseQuotient(cell).array().round();
  Vec3 goal = start + apart.cwiseProduct(cell);
  goal.z() = start.z() + std::ceil((above(goal) - start.z()) / cell.z()) * cell.z();
  return {relief, {low, high}, start, goal};
}

Request request_over(host::Registry& registry, const Flight& flight,
                     const std::vector<std::string>& constraints) {
  Request request;
  request.world =
      std::make_shared<const World>(World().with({"ground", "terrain", flight.relief.layer}));
  request.volume = flight.volume;
  request.start.position = flight.start;
  request.goal = {flight.goal, 0};
  std::vector<NamedConstraint> named;
  Site site;
  site.before = request.world.get();
  for (const std::string& text : constraints) {
    const Chosen of = chosen(registry, "constraint", text);
    named.push_back({text, of.entry.constraint(&of.parameters, site)});
  }
  apply_constraints(request, std::move(named), AppliesTo::route);
  return request;
}

std::string planner_on(double cell_m) {
  char text[200];
  std::snprintf(text, sizeof text,
                "astar {moves: exact, cell_m: [%.6f, %.6f, %.6f], max_memory_mb: 16384}", cell_m,
                cell_m, kFlatness * cell_m);
  return text;
}

/// Cylinders so close that they overlap.
std::shared_ptr<const Environment> ring_of_cylinders(const Vec3& middle, double radius_m) {
  constexpr int kCount = 360;
  const double apart = 2 * kPi * radius_m / kCount;
  std::vector<Shape> shapes;
  for (int n = 0; n < kCount; ++n) {
    const Vec3 at = middle + radius_m * unit_heading(2 * kPi * n / kCount);
    shapes.push_back(Cylinder{at.x(), at.y(), apart});
  }
  return std::make_shared<kit::ShapeLayer>(std::move(shapes));
}

std::string metres(double value) {
  char text[40];
  std::snprintf(text, sizeof text, ", %.3g m", value);
  return text;
}
}  // namespace

std::vector<TerrainProblem> terrain_problems(host::Registry& registry, const TerrainKind& kind) {
  const auto relief_with = [&](int barriers) {
    return kind.file.empty() ? ridges(kSide, kind.seed, barriers) : relief_of(registry, kind.file);
  };
  const Relief relief = relief_with(2);
  const double cell = longer_side(relief) / kind.cells;
  const Flight flight = flight_over(relief, kind.ceiling, 0.3, 0.83, cell);
  const Request within = request_over(registry, flight, kAll);
  std::vector<TerrainProblem> problems;
  const std::string few = "clearance" + metres(cell);
  problems.push_back({few, request_over(registry, flight, kFew), planner_on(cell), false, ""});
  problems.push_back({"all limits" + metres(cell), within, planner_on(cell), false, few});

  Request beside = within;
  beside.world = std::make_shared<const World>(
      within.world->with({"ring", "shape", ring_of_cylinders(flight.goal, flight.ring_m())}));
  problems.push_back({"shut in by cylinders" + metres(cell), beside, planner_on(cell), true, ""});
  Flight behind = flight;
  behind.relief =
      with_cliffs(*relief.field, flight.goal, flight.ring_m(), flight.volume.max.z() + kClearance);
  problems.push_back({"shut in by cliffs" + metres(cell), request_over(registry, behind, kAll),
                      planner_on(cell), true, ""});

  // Higher up and without ranges across: the fine lattice has a thousand times as many cells.
  const Relief open = relief_with(0);
  const double fine = longer_side(open) / kind.fine_cells;
  const Flight far = flight_over(open, kind.ceiling, 0.73, 0.6, fine);
  problems.push_back({"all limits" + metres(fine), request_over(registry, far, kAll),
                      planner_on(fine), false, ""});
  return problems;
}
}  // namespace altiplan::bench
