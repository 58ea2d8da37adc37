// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/base/built_in.hpp"
#include "host/config/pipeline_file.hpp"
#include "host/plugins/registry.hpp"

namespace altiplan::host {

/// Settings of the command line that override the files.
struct Overrides {
  std::optional<std::filesystem::path> scenario;
  std::optional<std::int64_t> seed;
  std::vector<std::string> set;  ///< "steps.0.with.weight_g=0.6", "scenario.…"
  std::vector<std::filesystem::path> plugin_path;
};

/// A pipeline and its scenario, read, overridden and checked against the plugins that they name.
struct Config {
  std::filesystem::path pipeline_path;  ///< absolute; empty if there is only a scenario
  std::filesystem::path scenario_path;
  Value pipeline_tree;  ///< as read, overrides applied
  Value scenario_tree;
  PipelineFile pipeline;
  std::vector<StepEntry> steps;
  ScenarioFile scenario;
  std::int64_t seed = 0;
  Overrides overrides;
  std::vector<std::filesystem::path> files;  ///< all files that the run reads, in order
  std::shared_ptr<Registry> registry;
  std::vector<std::string> notes;  ///< what was ignored while reading the files
  /// Nothing is planned in this world: its volume stays as given, and ends may lie outside it.
  bool is_only_judged = false;
  std::vector<LonLat> about;  ///< positions of the mission that is judged

  /// What routes minimise: the pipeline's objective, else the scenario's; null: length.
  const ObjectiveEntry* objective() const;
};

/// Reads and checks both files; throws ConfigError with every problem of both. Reuses `shared` if
/// given and of the same folders.
Config load_config(const std::filesystem::path& pipeline, const Overrides& overrides,
                   const std::shared_ptr<Registry>& shared = nullptr);

/// The same of a pipeline, or of a scenario alone, to which the overrides add the steps: then there
/// is no file of a pipeline, and paths are relative to the scenario.
Config load_plan(const std::filesystem::path& file, const Overrides& overrides);

/// A scenario without a pipeline (`check --route`, `validate`).
Config load_scenario(const std::filesystem::path& scenario, const Overrides& overrides);
/// The same from a text in memory, whose paths are absolute; `name` stands for the file in
/// messages.
Config load_scenario_text(const std::string& text, const std::string& name,
                          const Overrides& overrides);

/// Kind of a file, determined by its keys.
enum class FileKind { pipeline, scenario, study, paper };
FileKind kind_of(const Value& tree);

/// The plugin of that kind and name: built in, or from a library. Throws as Registry::get.
const PluginEntry& plugin(Registry& registry, std::string_view kind, std::string_view name);

/// Calls `visit` for every objective that the two files name, with the parts of sums; keys of the
/// scenario begin with "scenario.".
void for_each_objective(const Config& config, const VisitObjective& visit);

/// One resolved parameter of the configuration, for `explain`.
struct Explained {
  std::string key;
  std::string value_json;
  std::string from;  ///< "file:line:column", "--set …" or "default"
  std::string unit;
};
std::vector<Explained> explain(const Config& config);
}  // namespace altiplan::host
