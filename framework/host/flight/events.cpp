// SPDX-License-Identifier: Apache-2.0
#include "host/flight/events.hpp"

#include <memory>
#include <utility>

#include "altiplan/ground.hpp"
#include "altiplan/kit/layers/cell_layer.hpp"

namespace altiplan::host {
namespace {

/// The layer with some of its cells changed, as a separate grid.
class EditedCells final : public kit::CellLayer, public Ground {
 public:
  EditedCells(std::shared_ptr<const Environment> original, const GridSpec& spec,
              const std::vector<Vec3>& cells, bool blocked)
      : CellLayer(edited(*original, spec, cells, blocked)),
        original_(std::move(original)),
        ground_(original_->ground()) {}

 private:
  static VoxelGrid edited(const Environment& original, GridSpec spec,
                          const std::vector<Vec3>& cells, bool blocked) {
    spec.rule = GridSpec::Rule::native;
    VoxelGrid grid(spec);
    original.rasterize(grid);
    for (const Vec3& cell : cells) {
      const auto centre = original.cell_centre({cell.x(), cell.y(), cell.z()});
      grid.set(spec.cell_of(centre.value()), blocked);
    }
    return grid;
  }
  Box do_bounds() const override { return original_->bounds(); }
  std::optional<Vec3> do_cell_centre(const std::array<double, 3>& cell) const override {
    return original_->cell_centre(cell);
  }
  // A ground has no cells: it stays unchanged, but the layer may block more than its ground.
  const Ground* do_ground() const override { return ground_ != nullptr ? this : nullptr; }
  std::optional<double> do_height(double x, double y) const override {
    return ground_->height(x, y);
  }
  double do_gap(const Vec3& a, const Vec3& b, double enough) const override {
    return ground_->gap(a, b, enough);
  }
  double do_gap_max(const Vec3& a, const Vec3& b) const override { return ground_->gap_max(a, b); }
  double do_slope(const Box& box) const override { return ground_->slope(box); }

  std::shared_ptr<const Environment> original_;
  const Ground* ground_;  ///< of the original, or null
};

/// Bounding box of the cells; throws ConfigError if the layer has no such cells.
Box box_of_cells(const Layer& layer, const SetCellsEntry& entry, const Location& where,
                 const std::string& key) {
  const auto& spec = layer.environment->info().native_grid;
  if (!spec) {
    throw ConfigError(where, key, "the layer '" + layer.id + "' has no cells");
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

/// The layer as it is when the event occurs, with the cells changed.
Layer with_cells(const Layer& layer, const std::vector<Vec3>& cells, bool blocked) {
  const auto& spec = layer.environment->info().native_grid;
  if (!spec) {
    throw Error("event set_cells: the layer '" + layer.id + "' no longer has cells");
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
  World all = mission.truth;  // including every layer added later
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
    } else if (entry.visit) {
      event.kind = FlightEvent::Kind::visit;
      event.target = {resolve_point(entry.visit->point, site, level, where, key),
                      entry.visit->within_m};
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
