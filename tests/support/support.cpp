// SPDX-License-Identifier: Apache-2.0
#include "support/support.hpp"

#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "host/config/yaml.hpp"
#include "host/plugins/registry.hpp"
#include "support/folders.hpp"

namespace altiplan::testing {
namespace {

host::Registry& registry() {
  static host::Registry registry({altiplan::folders::build() / "lib/altiplan/plugins"});
  return registry;
}

const PluginEntry& entry(std::string_view kind, std::string_view name) {
  return registry().get(kind, name);
}

Value parameters(std::string_view yaml) { return host::parse_yaml(yaml, "test"); }

/// Solid cells, exact as boxes, that are also the layer's native cells.
class DrawnCells final : public Environment {
 public:
  DrawnCells(const GridSpec& spec, std::vector<Cell> blocked)
      : spec_(spec),
        info_{{}, spec, {}, {}},
        blocked_(std::move(blocked)),
        boxes_(boxes_of(spec, blocked_)) {}

 private:
  static std::vector<Shape> boxes_of(const GridSpec& spec, const std::vector<Cell>& cells) {
    std::vector<Shape> boxes;
    for (const Cell& cell : cells) {
      boxes.emplace_back(BoxShape{spec.cell_box(cell)});
    }
    return boxes;
  }
  Box do_bounds() const override { return spec_.box(); }
  double do_clearance(const Vec3& p) const override { return boxes_.clearance(p); }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    return boxes_.blocked(a, b, r);
  }
  void do_near(const Vec3& p, double reach, const NearSink& sink) const override {
    boxes_.near(p, reach, sink);
  }
  void do_rasterize(VoxelGrid& grid) const override {
    const GridSpec& asked = grid.spec();
    const bool own = asked.origin == spec_.origin && asked.cell == spec_.cell &&
                     asked.counts == spec_.counts &&
                     (asked.inflation == 0 || asked.rule == GridSpec::Rule::native);
    if (!own) {
      boxes_.rasterize(grid);
      return;
    }
    for (const Cell& cell : blocked_) {
      grid.set(cell, true);
    }
  }
  double do_over_approximation() const override { return 0; }
  const LayerInfo& do_info() const override { return info_; }
  std::optional<Vec3> do_cell_centre(const std::array<double, 3>& cell) const override {
    return Vec3(spec_.origin +
                spec_.cell.cwiseProduct(Vec3(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5)));
  }

  GridSpec spec_;
  LayerInfo info_;
  std::vector<Cell> blocked_;
  kit::ObstacleSet boxes_;
};

/// The rows of a level, without indentation and blank lines.
std::vector<std::string> rows_of(const std::string& level) {
  std::vector<std::string> rows;
  std::istringstream stream(level);
  for (std::string row; stream >> row;) {
    rows.push_back(row);
  }
  return rows;
}

[[noreturn]] void refuse_drawing(const std::string& why) {
  throw std::invalid_argument("draw: " + why);
}
}  // namespace

std::unique_ptr<Planner> make_planner(std::string_view name, std::string_view yaml) {
  const Value value = parameters(yaml);
  return entry("planner", name).planner(&value);
}

std::unique_ptr<LocalPlanner> make_local_planner(std::string_view name, std::string_view yaml) {
  const Value value = parameters(yaml);
  return entry("local_planner", name).local_planner(&value);
}

std::unique_ptr<Smoother> make_smoother(std::string_view name, std::string_view yaml) {
  const Value value = parameters(yaml);
  return entry("smoother", name).smoother(&value);
}

std::unique_ptr<Constraint> make_constraint(std::string_view name, std::string_view yaml) {
  const Value value = parameters(yaml);
  const World empty;
  Site site;
  site.before = &empty;
  return entry("constraint", name).constraint(&value, site);
}

std::unique_ptr<Tuner> make_tuner(std::string_view name, std::string_view yaml) {
  const Value value = parameters(yaml);
  return entry("tuner", name).tuner(&value);
}

std::unique_ptr<Environment> make_environment(std::string_view name, std::string_view yaml,
                                              const Site& site) {
  const Value value = parameters(yaml);
  return entry("environment", name).environment(&value, site);
}

std::unique_ptr<Task> make_task(std::string_view name, std::string_view yaml, const World& before) {
  Site site;
  site.before = &before;
  const Value value = parameters(yaml);
  return entry("task", name).task(&value, site);
}

std::unique_ptr<Objective> make_objective(std::string_view name, std::string_view yaml,
                                          const Frame& frame) {
  return make_objective(name, yaml, World().with_frame(frame));
}

std::unique_ptr<Objective> make_objective(std::string_view name, std::string_view yaml,
                                          const World& before) {
  Site site;
  site.before = &before;
  site.frame = before.frame();
  return make_objective(name, yaml, site);
}

std::unique_ptr<Objective> make_objective(std::string_view name, std::string_view yaml,
                                          const Site& site) {
  const Value value = parameters(yaml);
  return entry("objective", name).objective(&value, site);
}

std::unique_ptr<Environment> make_environment(std::string_view name, std::string_view yaml) {
  static const World kEmpty;
  Site site;
  site.before = &kEmpty;
  return make_environment(name, yaml, site);
}

std::string parameter_problems(std::string_view kind, std::string_view name,
                               std::string_view yaml) {
  const Value value = parameters(yaml);
  std::string text;
  for (const Problem& problem : entry(kind, name).describe(&value, "").problems) {
    text += (text.empty() ? "" : "\n") + problem.text();
  }
  return text;
}

std::int64_t counter(const PlanResult& result, std::string_view name) {
  for (const Counter& one : result.counters) {
    if (one.name == name) {
      return one.value;
    }
  }
  return -1;
}

World world_of(std::shared_ptr<const Environment> environment, std::string id) {
  Layer layer;
  layer.plugin = id;
  layer.id = std::move(id);
  layer.environment = std::move(environment);
  return World().with(std::move(layer));
}

World world_of(std::vector<Shape> shapes) {
  return world_of(std::make_shared<kit::ShapeLayer>(std::move(shapes)), "shapes");
}

Request request_in(World world, const Vec3& start, const Vec3& goal, const Box& volume) {
  Request request;
  request.world = std::make_shared<const World>(std::move(world));
  request.start.position = start;
  request.goal.position = goal;
  request.volume = volume;
  return request;
}

Drawn draw(const std::vector<std::string>& levels, double cell_m) {
  std::vector<std::vector<std::string>> rows;
  for (const std::string& level : levels) {
    rows.push_back(rows_of(level));
  }
  if (rows.empty() || rows[0].empty()) {
    refuse_drawing("there is no cell");
  }
  GridSpec spec;
  spec.cell = Vec3::Constant(cell_m);
  spec.counts = {int(rows[0][0].size()), int(rows[0].size()), int(rows.size())};
  spec.rule = GridSpec::Rule::native;
  std::vector<Cell> blocked;
  std::optional<Vec3> start;
  std::optional<Vec3> goal;
  for (int k = 0; k < spec.counts[2]; ++k) {
    if (int(rows[k].size()) != spec.counts[1]) {
      refuse_drawing("level " + std::to_string(k) + " has another number of rows");
    }
    for (int j = 0; j < spec.counts[1]; ++j) {
      const std::string& row = rows[k][spec.counts[1] - 1 - j];
      if (int(row.size()) != spec.counts[0]) {
        refuse_drawing("row '" + row + "' has another length");
      }
      for (int i = 0; i < spec.counts[0]; ++i) {
        const Cell cell{i, j, k};
        if (row[i] == '#') {
          blocked.push_back(cell);
        } else if (row[i] == 'S' || row[i] == 'G') {
          std::optional<Vec3>& end = row[i] == 'S' ? start : goal;
          if (end) {
            refuse_drawing(std::string("a second '") + row[i] + "'");
          }
          end = spec.centre(cell);
        } else if (row[i] != '.') {
          refuse_drawing(std::string("unknown cell '") + row[i] + "'");
        }
      }
    }
  }
  Drawn drawn;
  drawn.request =
      request_in(world_of(std::make_shared<DrawnCells>(spec, std::move(blocked)), "drawn"),
                 start.value_or(Vec3(0, 0, 0)), goal.value_or(Vec3(0, 0, 0)), spec.box());
  drawn.world = drawn.request.world;
  return drawn;
}

std::filesystem::path test_data(std::string_view relative) {
  const char* folder = std::getenv("ALTIPLAN_TEST_DATA");
  const std::filesystem::path file =
      (folder != nullptr ? std::filesystem::path(folder)
                         : altiplan::folders::source() / "../shared/data") /
      relative;
  return std::filesystem::exists(file) ? file : std::filesystem::path();
}

std::filesystem::path configs() { return altiplan::folders::source() / "configs"; }
}  // namespace altiplan::testing
