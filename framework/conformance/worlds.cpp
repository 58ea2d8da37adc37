// SPDX-License-Identifier: Apache-2.0
#include "worlds.hpp"

#include <algorithm>
#include <queue>

#include "altiplan/kit/layers/obstacle_set.hpp"

namespace altiplan::conformance {
namespace {

/// Solid cells that are also the layer's native ones.
class CellLayer final : public Environment {
 public:
  CellLayer(const GridSpec& spec, const std::vector<Shape>& boxes)
      : spec_(spec), info_{{}, spec, {}, {}}, boxes_(boxes) {}

 private:
  Box do_bounds() const override { return spec_.box(); }
  double do_clearance(const Vec3& p) const override { return boxes_.clearance(p); }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    return boxes_.blocked(a, b, r);
  }
  void do_near(const Vec3& p, double reach, const NearSink& sink) const override {
    boxes_.near(p, reach, sink);
  }
  void do_rasterize(VoxelGrid& grid) const override { boxes_.rasterize(grid); }
  double do_over_approximation() const override { return 0; }
  const LayerInfo& do_info() const override { return info_; }
  std::optional<Vec3> do_cell_centre(const std::array<double, 3>& cell) const override {
    return Vec3(spec_.origin +
                spec_.cell.cwiseProduct(Vec3(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5)));
  }

  GridSpec spec_;
  LayerInfo info_;  ///< of its cells
  kit::ObstacleSet boxes_;
};

std::shared_ptr<const World> world_of(std::shared_ptr<const Environment> layer) {
  return std::make_shared<const World>(
      World().with({"layer", "conformance", std::move(layer), true}));
}

Box volume_of(double unit) { return {{0, 0, 0}, unit * Vec3(20, 16, 6)}; }

void level_out(Scene& scene, Flight flight) {
  if (flight == Flight::level) {
    scene.request.goal.position.z() = scene.request.start.position.z();
    scene.request.level_m = scene.request.start.position.z();
    scene.name += ", in level flight";
  }
}

Scene scene_of(double unit, std::string name) {
  Scene scene;
  scene.name = std::move(name);
  scene.unit = unit;
  Request& request = scene.request;
  request.world = std::make_shared<const World>();
  request.volume = volume_of(unit);
  request.start.position = unit * Vec3(1.5, 1.5, 1.5);
  request.goal.position = unit * Vec3(18.5, 14.5, 4.5);
  request.vehicle.radius_m = request.limits.min_clearance = unit / 20;
  request.vehicle.speed_mps = unit / 5;
  return scene;
}

double own_distance(const Sphere& ball, const Vec3& p) {
  return (p - ball.centre).norm() - ball.radius;
}

double own_distance(const BoxShape& shape, const Vec3& p) {
  const Vec3 beyond = (shape.box.min - p).cwiseMax(p - shape.box.max);
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

double own_distance(const Shape& shape, const Vec3& p) {
  const Sphere* ball = std::get_if<Sphere>(&shape);
  return ball != nullptr ? own_distance(*ball, p) : own_distance(std::get<BoxShape>(shape), p);
}
}  // namespace

Scene open_scene(double unit, Flight flight) {
  Scene scene = scene_of(unit, "an empty world");
  level_out(scene, flight);
  return scene;
}

Scene random_scene(double unit, std::uint64_t seed, Flight flight) {
  Scene scene = scene_of(unit, "random world " + std::to_string(seed));
  Request& request = scene.request;
  RandomStream random = RandomStream(seed).sub("world");
  request.start.position += unit * Vec3(random.uniform(), random.uniform(), random.uniform());
  request.goal.position -= unit * Vec3(random.uniform(), random.uniform(), random.uniform());
  level_out(scene, flight);
  const std::int64_t count = random.integer(5, 14);
  while (std::int64_t(scene.solids.size()) < count) {
    const Vec3 centre = random.in(request.volume);
    Shape shape = Sphere{centre, unit * random.uniform(0.7, 2.5)};
    if (random.uniform() < 0.6) {
      const Vec3 half =
          unit * Vec3(random.uniform(0.4, 2.5), random.uniform(0.4, 2.5), random.uniform(0.5, 3));
      shape = BoxShape{{centre - half, centre + half}};
    }
    if (own_distance(shape, request.start.position) > unit &&
        own_distance(shape, request.goal.position) > unit) {
      scene.solids.push_back(shape);
    }
  }
  request.world = world_of(std::make_shared<kit::ShapeLayer>(scene.solids));
  return scene;
}

Scene wall_scene(double unit, double top, Flight flight) {
  Scene scene = scene_of(unit, "a wall " + text(top) + " units high across the straight path");
  Request& request = scene.request;
  request.goal.position = unit * Vec3(18.5, 1.5, 1.5);
  level_out(scene, flight);
  scene.solids = {BoxShape{{unit * Vec3(9.8, -1, -1), unit * Vec3(10.2, 12, top)}}};
  request.world = world_of(std::make_shared<kit::ShapeLayer>(scene.solids));
  return scene;
}

Scene crowded_scene(double unit, Flight flight) {
  Scene scene = scene_of(unit, "a million obstacles");
  Request& request = scene.request;
  request.volume.max *= 10;
  // Posts every 1.25 units from (1, 1, 1); the ends lie between four of them, at their height.
  request.start.position = unit * Vec3(1.625, 1.625, 2.25);
  request.goal.position = unit * Vec3(197.875, 157.875, 57.25);
  level_out(scene, flight);
  request.world = world_of(std::make_shared<BallField>(unit * Vec3(1, 1, 1), 1.25 * unit,
                                                       std::array{160, 128, 48}, unit / 4));
  return scene;
}

void enclose_goal(Scene& scene) {
  const double unit = scene.unit;
  const Vec3 at = scene.request.goal.position;
  std::vector<Change> changes;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Box wall{at - Vec3::Constant(1.4 * unit), at + Vec3::Constant(1.4 * unit)};
      wall.min[axis] = at[axis] + (side < 0 ? -1.4 : 1.2) * unit;
      wall.max[axis] = at[axis] + (side < 0 ? -1.2 : 1.4) * unit;
      with_solid(scene, BoxShape{wall}, "wall" + std::to_string(axis) + (side < 0 ? "a" : "b"),
                 changes);
    }
  }
  scene.name += ", the goal enclosed by a box";
}

Scene ridge_scene(double unit) {
  Scene scene = scene_of(unit, "a crest across the straight path");
  scene.ridge = std::make_shared<Ridge>(10 * unit, 2.3 * unit, 0.3);
  Request& request = scene.request;
  request.goal.position.z() = 1.5 * unit;
  request.limits.min_ground_clearance = unit / 2;
  request.world = world_of(scene.ridge);
  return scene;
}

Scene cell_scene(double unit, std::string name, const std::vector<std::string>& levels,
                 Flight flight) {
  Scene scene = scene_of(unit, std::move(name));
  Request& request = scene.request;
  request.vehicle.radius_m = request.limits.min_clearance = 0;
  GridSpec spec;
  spec.cell = Vec3::Constant(unit);
  spec.rule = GridSpec::Rule::native;
  const auto rows = int(std::count(levels[0].begin(), levels[0].end(), '/')) + 1;
  spec.counts = {int(levels[0].find('/')), rows, int(levels.size())};
  for (int k = 0; k < spec.counts[2]; ++k) {
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < spec.counts[0]; ++i) {
        const Cell cell{i, j, k};
        const char what =
            levels[std::size_t(k)][std::size_t((rows - 1 - j) * (spec.counts[0] + 1) + i)];
        if (what == '#') {
          scene.solids.push_back(BoxShape{spec.cell_box(cell)});
        } else if (what != '.') {
          (what == 'S' ? request.start.position : request.goal.position) = spec.centre(cell);
        }
      }
    }
  }
  request.volume = spec.box();
  request.world = world_of(std::make_shared<CellLayer>(spec, scene.solids));
  level_out(scene, flight);
  return scene;
}

Scene random_cells(double unit, std::uint64_t seed, Flight flight) {
  RandomStream random = RandomStream(seed).sub("cells");
  const bool flat = flight == Flight::level;
  const int nx = flat ? 14 : 8;
  const int ny = flat ? 11 : 7;
  const int nz = flat ? 1 : 5;
  const double density = 0.1 + 0.4 * random.uniform();
  std::vector<std::string> levels(std::size_t(nz),
                                  std::string(std::size_t((nx + 1) * ny - 1), '/'));
  std::vector<char*> free;
  for (std::string& level : levels) {
    for (std::size_t i = 0; i < level.size(); ++i) {
      if (i % std::size_t(nx + 1) != std::size_t(nx)) {
        level[i] = random.uniform() < density ? '#' : '.';
        free.push_back(&level[i]);
      }
    }
  }
  const auto last = std::int64_t(free.size()) - 1;
  const std::int64_t start = random.integer(0, last);
  *free[std::size_t(start)] = 'S';
  *free[std::size_t((start + random.integer(1, last)) % (last + 1))] = 'G';
  std::string name = "random cells " + std::to_string(seed);
  return cell_scene(unit, std::move(name), levels, flight);
}

std::shared_ptr<const World> with_solid(Scene& scene, const Shape& solid, const std::string& id,
                                        std::vector<Change>& changes) {
  scene.solids.push_back(solid);
  changes = {{Change::Kind::add, id, bounds(solid)}};
  scene.request.world = std::make_shared<const World>(scene.request.world->with(
      {id, "conformance", std::make_shared<kit::ShapeLayer>(std::vector<Shape>{solid}), true}));
  return scene.request.world;
}

Scene moved_scene(const Scene& scene, const Vec3& by) {
  Scene there = scene;
  there.name += ", moved by " + text(by);
  Request& request = there.request;
  request.start.position += by;
  request.goal.position += by;
  request.volume = {request.volume.min + by, request.volume.max + by};
  if (request.level_m) {
    *request.level_m += by.z();
  }
  for (Shape& solid : there.solids) {
    solid = moved(solid, by);
  }
  request.world = world_of(std::make_shared<kit::ShapeLayer>(there.solids));
  return there;
}

double own_clearance(const Scene& scene, const Vec3& p) {
  double min_distance = kInfinity;
  for (const Shape& solid : scene.solids) {
    min_distance = std::min(min_distance, own_distance(solid, p));
  }
  if (scene.ridge != nullptr) {
    min_distance = std::min(min_distance, scene.ridge->clearance(p));
  }
  return min_distance;
}

namespace {

Cell cell_at(const GridSpec& spec, const Vec3& p) {
  const Vec3 at = (p - spec.origin).cwiseQuotient(spec.cell);
  return {int(std::floor(at.x())), int(std::floor(at.y())), int(std::floor(at.z()))};
}

/// The free cells of a scene, and the steps between them.
class LaneMap {
 public:
  LaneMap(const Scene& cells, const Lanes& lanes)
      : spec_(*cells.request.world->native_grid()), lanes_(lanes) {
    solid_.assign(spec_.cell_count(), false);
    for (const Shape& solid : cells.solids) {
      const Box& box = std::get<BoxShape>(solid).box;
      solid_[id(cell_at(spec_, (box.min + box.max) / 2))] = true;
    }
  }

  std::size_t id(const Cell& c) const {
    return std::size_t((c[2] * spec_.counts[1] + c[1]) * spec_.counts[0] + c[0]);
  }
  bool free(const Cell& c) const { return spec_.holds(c) && !solid_[id(c)]; }
  bool open(const Cell& a, const Cell& b) const {
    int moved = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      moved += a[axis] != b[axis];
    }
    if (moved == 0 || (lanes_.neighbours == 6 && moved > 1) || !free(b)) {
      return false;
    }
    for (int corner = 0; lanes_.free_box && corner < 8; ++corner) {
      if (!free({corner & 1 ? a[0] : b[0], corner & 2 ? a[1] : b[1], corner & 4 ? a[2] : b[2]})) {
        return false;
      }
    }
    return true;
  }
  const GridSpec& spec() const { return spec_; }

 private:
  GridSpec spec_;
  Lanes lanes_;
  std::vector<bool> solid_;
};
}  // namespace

double shortest(const Scene& cells, const Lanes& lanes) {
  const LaneMap map(cells, lanes);
  const Cell goal = cell_at(map.spec(), cells.request.goal.position);
  const Cell start = cell_at(map.spec(), cells.request.start.position);
  std::vector<double> best(map.spec().cell_count(), kInfinity);
  using Entry = std::pair<double, Cell>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  queue.push({0, start});
  best[map.id(start)] = 0;
  while (!queue.empty()) {
    const auto [g, c] = queue.top();
    queue.pop();
    if (c == goal) {
      return g;
    }
    for (int d = 0; d < 27; ++d) {
      const Cell move{d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1};
      const Vec3 step(move[0], move[1], move[2]);
      const Cell n{c[0] + move[0], c[1] + move[1], c[2] + move[2]};
      const double length = g + map.spec().cell.cwiseProduct(step).norm();
      if (map.open(c, n) && length < best[map.id(n)]) {
        best[map.id(n)] = length;
        queue.push({length, n});
      }
    }
  }
  return kInfinity;
}

std::shared_ptr<const Body> flat_wing(double unit) {
  auto body = std::make_shared<Body>();
  body->parts.push_back(box_part(unit * Vec3(0.4, 1.6, 0.1), Vec3::Zero()));
  return body;
}

Factory<Constraint> on_site(const ConstraintFactory& make, const Options& options,
                            const std::shared_ptr<const World>& before) {
  if (!make) {
    return {};
  }
  const auto world = before != nullptr ? before : std::make_shared<const World>();
  return [make, world, options] {
    Site site;
    site.before = world.get();
    site.frame = world->frame();
    site.volume = options.volume.value_or(Box{{0, 0, 0}, {1000, 1000, 1000}});
    site.random = RandomStream(options.seed).sub("site");
    return make(site);
  };
}
}  // namespace altiplan::conformance
