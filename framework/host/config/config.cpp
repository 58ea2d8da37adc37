// SPDX-License-Identifier: Apache-2.0
#include "host/config/config.hpp"

#include "host/base/built_in.hpp"
#include "host/base/input.hpp"
#include "host/config/config_check.hpp"
#include "host/config/mission_key.hpp"
#include "host/config/overrides.hpp"
#include "host/config/yaml.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;
namespace {

fs::path absolute_file(const fs::path& path) {
  if (path.empty()) {
    return path;  // absolute("") throws
  }
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  if (error) {
    throw ConfigError(Location{path.string(), 0, 0, ""}, "",
                      "cannot be found: the current folder no longer exists");
  }
  return absolute.lexically_normal();
}

std::shared_ptr<Registry> make_registry(const Config& config,
                                        const std::shared_ptr<Registry>& shared = nullptr) {
  std::vector<fs::path> folders = config.overrides.plugin_path;
  for (const auto* list : {&config.pipeline.plugins, &config.scenario.plugins}) {
    for (const Path& path : *list) {
      folders.emplace_back(path.text);
    }
  }
  const std::vector<fs::path> path = Registry::search_path(folders);
  return shared && shared->folders() == path ? shared : std::make_shared<Registry>(path);
}

/// Checked first: a file of the wrong kind would give one problem per key.
void expect_kind(const Value& tree, FileKind expected) {
  if (tree.kind != Value::Kind::map) {
    throw ConfigError(tree.where, "",
                      "expected keys with values ('altiplan: 1', …), found " + tree.what());
  }
  const std::string wanted = expected == FileKind::scenario ? "scenario" : "pipeline";
  if (kind_of(tree) == FileKind::study) {
    throw ConfigError(tree.where, "",
                      "this is a study (altiplan study runs it), expected a " + wanted);
  }
  if (kind_of(tree) == FileKind::paper) {
    throw ConfigError(tree.where, "",
                      "this is a paper (altiplan reproduce runs it), expected a " + wanted);
  }
  const bool has_steps = tree.find("steps") != nullptr;
  if (expected == FileKind::scenario && has_steps && kind_of(tree) == FileKind::pipeline) {
    throw ConfigError(place_of(tree, "steps"), "steps", "this is a pipeline, expected a scenario");
  }
  if (expected == FileKind::pipeline && !has_steps && kind_of(tree) == FileKind::scenario) {
    throw ConfigError(
        tree.where, "",
        "this is a scenario, expected a pipeline: a file with 'scenario' and 'steps'");
  }
}

/// False if the file, or a text in its place, cannot be read as YAML: its keys are unknown then. A
/// tree that is there is not read again.
bool read_scenario(Config& config, Checker& checker,
                   const std::optional<std::string>& text = std::nullopt) {
  std::vector<fs::path> mission;
  try {
    if (config.scenario_tree.kind != Value::Kind::map) {
      config.scenario_tree =
          text ? parse_yaml(*text, config.scenario_path.string()) : load_yaml(config.scenario_path);
    }
    expect_kind(config.scenario_tree, FileKind::scenario);
    apply_overrides(config.scenario_tree, config.overrides.set, FileOfKey::scenario);
    config.notes = add_mission(config.scenario_tree, mission);
  } catch (const ConfigError& error) {
    checker.add(error.problems());
    return false;
  }
  checker.add(bind(config.scenario, &config.scenario_tree).problems);
  if (!text) {
    config.files.push_back(config.scenario_path);
  }
  config.files.insert(config.files.end(), mission.begin(), mission.end());
  return true;
}

/// Reads the scenario named by the pipeline or the command line; false, with the problem reported,
/// if there is none.
bool find_scenario(Config& config, Checker& checker) {
  if (config.overrides.scenario) {
    config.scenario_path = absolute_file(*config.overrides.scenario);
    return true;
  }
  const auto& named = config.pipeline.scenario;
  const Location where = place_of(config.pipeline_tree, "scenario");
  if (!named) {
    checker.problem(where, "", "the key 'scenario' is missing: a scenario file, or --scenario");
    return false;
  }
  if (named->text.empty()) {
    return false;  // already reported
  }
  config.scenario_path = absolute_file(named->text);
  const std::string why = file_problem(config.scenario_path);
  if (!why.empty()) {
    checker.problem(where, "scenario", why);
  }
  return why.empty();
}
}  // namespace

const ObjectiveEntry* Config::objective() const {
  const auto& given = pipeline.objective ? pipeline.objective : scenario.objective;
  return given && given->plugin != "length" ? &*given : nullptr;
}

void for_each_objective(const Config& config, const VisitObjective& visit) {
  const auto of_file = [&](const auto& file, const std::string& prefix) {
    if (file.objective) {
      for_each_objective(file.objective->plugin, file.objective->parameters, prefix + "objective",
                         visit);
    }
    for (std::size_t i = 0; i < file.constraints.size(); ++i) {
      if (file.constraints[i].plugin == "limit") {
        LimitParams limit;
        bind(limit, &file.constraints[i].parameters);
        for_each_objective(limit.of.plugin, limit.of.parameters,
                           prefix + item("constraints", i) + ".limit.of", visit);
      }
    }
    for (std::size_t i = 0; i < file.metrics.size(); ++i) {
      for_each_objective(file.metrics[i].plugin, file.metrics[i].parameters,
                         prefix + item("metrics", i), visit);
    }
  };
  of_file(config.scenario, "scenario.");
  of_file(config.pipeline, "");
}

const PluginEntry& plugin(Registry& registry, std::string_view kind, std::string_view name) {
  for (const PluginEntry& entry : built_in_plugins()) {
    if (kind == entry.kind && name == entry.name) {
      return entry;
    }
  }
  return registry.get(kind, name);
}

FileKind kind_of(const Value& tree) {
  if (tree.find("tables") != nullptr && tree.find("steps") == nullptr) {
    return FileKind::paper;
  }
  if (tree.find("steps") == nullptr &&
      (tree.find("pipelines") != nullptr || tree.find("scenarios") != nullptr)) {
    return FileKind::study;
  }
  const bool scenario = tree.find("environment") != nullptr || tree.find("start") != nullptr ||
                        tree.find("goal") != nullptr || tree.find("mission") != nullptr;
  return scenario ? FileKind::scenario : FileKind::pipeline;
}

namespace {
Config scenario_config(const fs::path& path, const std::optional<std::string>& text,
                       const Overrides& overrides) {
  Config config;
  config.overrides = overrides;
  config.scenario_path = path;
  config.seed = overrides.seed.value_or(0);
  Checker checker(config);
  const bool read = read_scenario(config, checker, text);
  config.registry = make_registry(config);
  if (read) {
    check_scenario(checker, config.scenario, config.scenario_tree);
    Ids metrics;
    check_metrics(checker, config.scenario.metrics, config.scenario_tree, metrics);
  }
  checker.finish();
  return config;
}

/// Of a pipeline whose tree is read.
Config pipeline_config(Config config, const std::shared_ptr<Registry>& shared) {
  expect_kind(config.pipeline_tree, FileKind::pipeline);
  apply_overrides(config.pipeline_tree, config.overrides.set, FileOfKey::pipeline);
  Checker checker(config);
  checker.add(bind(config.pipeline, &config.pipeline_tree).problems);
  if (!config.pipeline_path.empty()) {
    config.files.push_back(config.pipeline_path);
  }
  config.seed = config.overrides.seed.value_or(config.pipeline.seed);
  const bool read = find_scenario(config, checker) && read_scenario(config, checker);
  config.registry = make_registry(config, shared);
  Ids metrics;
  if (read) {
    check_scenario(checker, config.scenario, config.scenario_tree);
    check_metrics(checker, config.scenario.metrics, config.scenario_tree, metrics);
  }
  check_metrics(checker, config.pipeline.metrics, config.pipeline_tree, metrics);
  check_constraints(checker, config.pipeline.constraints, config.pipeline_tree);
  if (config.pipeline.objective) {
    check_objective(checker, *config.pipeline.objective, *config.pipeline_tree.find("objective"),
                    "objective");
  }
  check_steps(checker, config);
  checker.finish();
  return config;
}

/// {altiplan: 1}, at the place of this tree.
Value empty_pipeline(const Value& at) {
  Value version;
  version.text = std::to_string(kFileFormat);
  version.where = at.where;
  Value tree = empty_map();
  tree.where = at.where;
  tree.entries.push_back({"altiplan", at.where, version});
  return tree;
}
}  // namespace

Config load_scenario(const fs::path& scenario, const Overrides& overrides) {
  return scenario_config(absolute_file(scenario), std::nullopt, overrides);
}

Config load_scenario_text(const std::string& text, const std::string& name,
                          const Overrides& overrides) {
  return scenario_config(name, text, overrides);
}

Config load_config(const fs::path& pipeline, const Overrides& overrides,
                   const std::shared_ptr<Registry>& shared) {
  Config config;
  config.overrides = overrides;
  config.pipeline_path = absolute_file(pipeline);
  config.pipeline_tree = load_yaml(config.pipeline_path);
  return pipeline_config(std::move(config), shared);
}

Config load_plan(const fs::path& file, const Overrides& overrides) {
  Config config;
  config.overrides = overrides;
  config.pipeline_path = absolute_file(file);
  config.pipeline_tree = load_yaml(config.pipeline_path);
  if (kind_of(config.pipeline_tree) == FileKind::scenario) {
    config.overrides.scenario = std::exchange(config.pipeline_path, {});
    config.scenario_tree =
        std::exchange(config.pipeline_tree, empty_pipeline(config.pipeline_tree));
  }
  return pipeline_config(std::move(config), nullptr);
}
}  // namespace altiplan::host
