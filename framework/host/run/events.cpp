// SPDX-License-Identifier: Apache-2.0
#include "host/run/events.hpp"

#include <memory>
#include <utility>

#include "altiplan/kit/obstacle_set.hpp"

namespace altiplan::host {
namespace {

/// The layer with some of its cells changed, drawn as a grid of its own.
class EditedCells final : public Environment {
 public:
  EditedCells(std::shared_ptr<const Environment> original, const GridSpec& spec,
              const std::vector<Vec3>& cells, bool blocked)
      : original_(std::move(original)), grid_(native(spec)) {
    original_->rasterize(grid_);
    for (const Vec3& cell : cells) {
      const auto centre = original_->cell_centre({cell.x(), cell.y(), cell.z()});
      grid_.set(spec.cell_of(centre.value()), blocked);
    }
    std::vector<Shape> boxes;
    for (int k = 0; k < spec.counts[2]; ++k) {
      for (int j = 0; j < spec.counts[1]; ++j) {
        append_runs(j, k, boxes);
      }
    }
    solid_ = std::make_unique<kit::ObstacleSet>(std::move(boxes));
  }

 private:
  static GridSpec native(GridSpec spec) {
    spec.rule = GridSpec::Rule::native;
    return spec;
  }
  /// One box for every run of blocked cells in a row.
  void append_runs(int j, int k, std::vector<Shape>& boxes) const {
    const GridSpec& spec = grid_.spec();
    for (int i = 0; i < spec.counts[0]; ++i) {
      if (!grid_.blocked(i, j, k)) {
        continue;
      }
      int last = i;
      while (last + 1 < spec.counts[0] && grid_.blocked(last + 1, j, k)) {
        ++last;
      }
      boxes.emplace_back(BoxShape{{spec.cell_box({i, j, k}).min, spec.cell_box({last, j, k}).max}});
      i = last;
    }
  }
  Box do_bounds() const override { return original_->bounds(); }
  double do_clearance(const Vec3& p) const override { return solid_->clearance(p); }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    return solid_->blocked(a, b, r);
  }
  void do_near(const Vec3& p, double reach, const NearSink& sink) const override {
    solid_->near(p, reach, sink);
  }
  void do_rasterize(VoxelGrid& grid) const override {
    if (grid.spec() == grid_.spec()) {
      grid.merge(grid_);
    } else {
      solid_->rasterize(grid);
    }
  }
  double do_slack() const override { return 0; }
  std::optional<GridSpec> do_native_grid() const override { return grid_.spec(); }
  std::optional<Vec3> do_cell_centre(const std::array<double, 3>& cell) const override {
    return original_->cell_centre(cell);
  }
  // A ground has no cells: it stays as it was.
  bool do_has_ground() const override { return original_->has_ground(); }
  std::optional<double> do_ground(double x, double y) const override {
    return original_->ground(x, y);
  }
  double do_ground_gap(const Vec3& a, const Vec3& b, double enough) const override {
    return original_->ground_gap(a, b, enough);
  }
  double do_ground_gap_max(const Vec3& a, const Vec3& b) const override {
    return original_->ground_gap_max(a, b);
  }
  double do_ground_slope(const Box& box) const override { return original_->ground_slope(box); }

  std::shared_ptr<const Environment> original_;
  VoxelGrid grid_;
  std::unique_ptr<kit::ObstacleSet> solid_;
};

/// The cells' box; throws ConfigError where the layer has no such cells.
Box box_of_cells(const Layer& layer, const SetCellsEntry& entry, const Location& where,
                 const std::string& key) {
  const auto spec = layer.environment->native_grid();
  if (!spec) {
    throw ConfigError(where, key, "the layer '" + layer.id + "' has no cells of its own");
  }
  Box box = Box::empty();
  for (std::size_t i = 0; i < entry.cells.size(); ++i) {
    const Vec3& cell = entry.cells[i];
    const auto centre = layer.environment->cell_centre({cell.x(), cell.y(), cell.z()});
    if (!centre || !spec->holds(spec->cell_of(*centre))) {
      throw ConfigError(where, key + ".cells." + std::to_string(i),
                        "the layer '" + layer.id + "' has no such cell");
    }
    box = box.united(spec->cell_box(spec->cell_of(*centre)));
  }
  return box;
}

/// The layer as it is when the event comes, with the cells changed.
Layer with_cells(const Layer& layer, const std::vector<Vec3>& cells, bool blocked) {
  const auto spec = layer.environment->native_grid();
  if (!spec) {
    throw Error("event set_cells: the layer '" + layer.id + "' has no cells of its own any more");
  }
  Layer edited = layer;
  edited.environment = std::make_shared<EditedCells>(layer.environment, *spec, cells, blocked);
  return edited;
}
}  // namespace

std::vector<FlightEvent> build_events(const Config& config, const Mission& mission) {
  std::vector<FlightEvent> events;
  Site site = mission.site;
  site.before = &mission.truth;
  const std::optional<double>& level = config.scenario.level_flight_at_m;
  World all = mission.truth;  // with every layer that is ever added
  for (std::size_t i = 0; i < config.scenario.events.size(); ++i) {
    const EventEntry& entry = config.scenario.events[i];
    const Location where = config.scenario_tree.find("events")->items[i].where;
    const std::string key = "events." + std::to_string(i);
    FlightEvent event;
    event.at_s = entry.at_s;
    if (entry.when_near) {
      event.when_near = {resolve_point(entry.when_near->point, site, level, where, key),
                         entry.when_near->within_m};
    }
    event.known = entry.known;
    if (entry.add) {
      event.kind = FlightEvent::Kind::add;
      event.id = entry.id;
      event.layer = build_layer(config, entry.add->plugin, entry.add->parameters, entry.id,
                                entry.known, site, key + ".add." + entry.add->plugin);
      all = all.with(*event.layer);
    } else if (entry.remove) {
      event.kind = FlightEvent::Kind::remove;
      event.id = *entry.remove;
    } else if (entry.move) {
      event.kind = FlightEvent::Kind::move;
      event.id = entry.move->layer;
      event.vector = entry.move->by_m;
    } else if (entry.set_cells) {
      event.kind = FlightEvent::Kind::set_cells;
      event.id = entry.set_cells->layer;
      event.edit = [cells = entry.set_cells->cells, blocked = entry.set_cells->blocked](
                       const Layer& layer) { return with_cells(layer, cells, blocked); };
    } else {
      event.kind = FlightEvent::Kind::move_goal;
      event.vector = resolve_point(entry.move_goal->point, site, level, where, key);
    }
    events.push_back(std::move(event));
  }
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (const auto& cells = config.scenario.events[i].set_cells) {
      const Value& map = config.scenario_tree.find("events")->items[i];
      events[i].box = box_of_cells(*all.find(cells->layer), *cells, map.where,
                                   "events." + std::to_string(i) + ".set_cells");
    }
  }
  return events;
}
}  // namespace altiplan::host
