// SPDX-License-Identifier: Apache-2.0
#include "host/base/shapes.hpp"
#include "host/config/config_check.hpp"

namespace altiplan::host {
namespace {

std::string shown_location(const std::optional<Location>& where) {
  return where ? where->text() : "default";
}

/// Leaves of a report; fields that hold plugins are explained by the plugins themselves.
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

/// The host's own keys of an entry; a missing id is shown as the host assigned it.
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
    bool is_set = field.where || field.value_json != "null";
    if constexpr (std::is_same_v<Entry, EventEntry>) {
      is_set = is_set && (entry.add || field.spec.name != "known");
    }
    if (is_set) {
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

/// The fields of a file that are not lists of entries.
template <class File>
void add_file(std::vector<Explained>& all, const Value& tree, const std::string& path) {
  File file;
  for (const BoundField& field : bind(file, &tree).fields) {
    if (field.spec.type != FieldType::list) {
      add_fields(all, {{field}, {}}, path);
    }
  }
}

void add_plugin(std::vector<Explained>& all, const Config& config, std::string_view kind,
                const std::string& name, const Value& parameters, const std::string& path) {
  add_fields(all, plugin(*config.registry, kind, name).describe(&parameters, path), path);
}

void add_scenario(std::vector<Explained>& all, const Config& config) {
  const ScenarioFile& scenario = config.scenario;
  const auto tree = [&](const char* list, std::size_t i) -> const Value& {
    return config.scenario_tree.find(list)->items[i];
  };
  add_file<ScenarioFile>(all, config.scenario_tree, "scenario");
  for (std::size_t i = 0; i < scenario.environment.size(); ++i) {
    const LayerEntry& layer = scenario.environment[i];
    const std::string path = item("scenario.environment", i);
    add_entry(all, layer, tree("environment", i), path);
    add_plugin(all, config, "environment", layer.plugin, layer.parameters,
               path + "." + layer.plugin);
  }
  if (scenario.task) {
    add_plugin(all, config, "task", scenario.task->plugin, scenario.task->parameters,
               "scenario.task." + scenario.task->plugin);
  }
  for (std::size_t i = 0; i < scenario.via.size(); ++i) {
    add_entry(all, scenario.via[i], tree("via", i), item("scenario.via", i));
  }
  for (std::size_t i = 0; i < scenario.moving.size(); ++i) {
    add_moving(all, scenario.moving[i], tree("moving", i), item("scenario.moving", i));
  }
  for (std::size_t i = 0; i < scenario.events.size(); ++i) {
    add_entry(all, scenario.events[i], tree("events", i), item("scenario.events", i));
  }
}

void add_step(std::vector<Explained>& all, const Config& config, const StepEntry& step,
              const Value& tree) {
  StepEntry copy;
  for (const BoundField& field : bind(copy, &tree, step.path).fields) {
    if (field.spec.name == "id") {
      all.push_back({step.path + ".id", "\"" + step.id + "\"", shown_location(field.where), ""});
    } else if (field.spec.name != "with" && field.spec.name != "else" &&
               (field.where || field.value_json != "null")) {
      add_fields(all, {{field}, {}}, step.path);
    }
  }
  if (step.plugin != kFollowRoute && step.verb != Verb::returns) {
    add_plugin(all, config, kind_of_step(*config.registry, step), step.plugin, step.with,
               step.path + ".with");
  }
}
}  // namespace

std::vector<Explained> explain(const Config& config) {
  std::vector<Explained> all;
  add_scenario(all, config);
  for (const auto& [entries, path] :
       {std::pair(&config.scenario.constraints, "scenario.constraints"),
        std::pair(&config.pipeline.constraints, "constraints")}) {
    for (std::size_t i = 0; i < entries->size(); ++i) {
      const ConstraintEntry& entry = (*entries)[i];
      add_plugin(all, config, "constraint", entry.plugin, entry.parameters,
                 item(path, i) + "." + entry.plugin);
    }
  }
  for_each_objective(config,
                     [&](const std::string& name, const Value& parameters, const std::string& key) {
                       add_plugin(all, config, "objective", name, parameters, key);
                     });
  add_file<PipelineFile>(all, config.pipeline_tree, "");
  for (std::size_t i = 0; i < config.steps.size(); ++i) {
    const StepEntry& step = config.steps[i];
    add_step(all, config, step, config.pipeline.steps[i]);
    for (std::size_t k = 0; k < step.otherwise.size(); ++k) {
      add_step(all, config, step.otherwise[k], step.alternatives[k]);
    }
  }
  return all;
}
}  // namespace altiplan::host
