// SPDX-License-Identifier: Apache-2.0
#include "host/config/config_check.hpp"
#include "host/config/shapes.hpp"

namespace altiplan::host {
namespace {

std::string shown_location(const std::optional<Location>& where) {
  return where ? where->text() : "default";
}

/// Leaves of a report; fields that hold plugins are explained by those plugins.
void add_fields(std::vector<Explained>& all, const ParamReport& report, const std::string& path) {
  for (const BoundField& field : report.fields) {
    if (field.spec.type == FieldType::plugin) {
      continue;
    }
    const std::string name = field.spec.type == FieldType::point ? "at" : field.spec.name;
    const std::string& value = field.value_json;
    all.push_back({path.empty() ? name : path + "." + name, value.empty() ? "null" : value,
                   shown_location(field.where), field.spec.unit});
  }
}

/// The host's own keys of an entry; an id that was not given is the one that the host gave.
template <class Entry>
void add_entry(std::vector<Explained>& all, const Entry& entry, const Value& tree,
               const std::string& path) {
  Entry copy;
  for (BoundField& field : bind(copy, &tree, path).fields) {
    if constexpr (requires { entry.id; }) {
      if (field.spec.name == "id") {
        field.value_json = entry.id.empty() ? "null" : "\"" + entry.id + "\"";
      }
    }
    bool said = field.where || field.value_json != "null";
    if constexpr (std::is_same_v<Entry, EventEntry>) {
      said = said && (entry.add || field.spec.name != "known");
    }
    if (said) {
      add_fields(all, {{field}, {}}, path);
    }
  }
}

void add_moving(std::vector<Explained>& all, const MovingEntry& moving, const Value& tree,
                const std::string& path) {
  add_entry(all, moving, tree, path);
  const std::string inner = path + "." + moving.shape;
  add_fields(all, describe_moving(moving.shape)(&moving.parameters, inner), inner);
}
}  // namespace

std::vector<Explained> explain(const Config& config) {
  std::vector<Explained> all;
  Registry& registry = *config.registry;
  const auto add_plugin = [&](std::string_view kind, const std::string& name,
                              const Value& parameters, const std::string& path) {
    add_fields(all, plugin(registry, kind, name).describe(&parameters, path), path);
  };
  ScenarioFile scenario;
  for (const BoundField& field : bind(scenario, &config.scenario_tree).fields) {
    if (field.spec.type != FieldType::list) {
      add_fields(all, {{field}, {}}, "scenario");
    }
  }
  for (std::size_t i = 0; i < config.scenario.environment.size(); ++i) {
    const LayerEntry& layer = config.scenario.environment[i];
    const std::string path = item("scenario.environment", i);
    add_entry(all, layer, config.scenario_tree.find("environment")->items[i], path);
    add_plugin("environment", layer.plugin, layer.parameters, path + "." + layer.plugin);
  }
  for (std::size_t i = 0; i < config.scenario.via.size(); ++i) {
    add_entry(all, config.scenario.via[i], config.scenario_tree.find("via")->items[i],
              item("scenario.via", i));
  }
  for (std::size_t i = 0; i < config.scenario.moving.size(); ++i) {
    add_moving(all, config.scenario.moving[i], config.scenario_tree.find("moving")->items[i],
               item("scenario.moving", i));
  }
  for (std::size_t i = 0; i < config.scenario.events.size(); ++i) {
    add_entry(all, config.scenario.events[i], config.scenario_tree.find("events")->items[i],
              item("scenario.events", i));
  }
  for (const auto& [entries, path] :
       {std::pair(&config.scenario.constraints, "scenario.constraints"),
        std::pair(&config.pipeline.constraints, "constraints")}) {
    for (std::size_t i = 0; i < entries->size(); ++i) {
      const ConstraintEntry& entry = (*entries)[i];
      add_plugin("constraint", entry.plugin, entry.parameters, item(path, i) + "." + entry.plugin);
    }
  }
  PipelineFile pipeline;
  for (const BoundField& field : bind(pipeline, &config.pipeline_tree).fields) {
    if (field.spec.type != FieldType::list) {
      add_fields(all, {{field}, {}}, "");
    }
  }
  const auto add_step = [&](const StepEntry& step, const Value& tree) {
    StepEntry copy;
    for (const BoundField& field : bind(copy, &tree, step.path).fields) {
      if (field.spec.name == "id") {
        all.push_back({step.path + ".id", "\"" + step.id + "\"", shown_location(field.where), ""});
      } else if (field.spec.name != "with" && field.spec.name != "else" &&
                 (field.where || field.value_json != "null")) {
        add_fields(all, {{field}, {}}, step.path);
      }
    }
    if (step.plugin != kFollowRoute) {
      add_plugin(kind_of_step(registry, step), step.plugin, step.with, step.path + ".with");
    }
  };
  for (std::size_t i = 0; i < config.steps.size(); ++i) {
    const StepEntry& step = config.steps[i];
    add_step(step, config.pipeline.steps[i]);
    for (std::size_t k = 0; k < step.otherwise.size(); ++k) {
      add_step(step.otherwise[k], step.alternatives[k]);
    }
  }
  return all;
}
}  // namespace altiplan::host
