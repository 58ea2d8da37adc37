// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <iostream>

#include "commands.hpp"
#include "host/config/yaml.hpp"
#include "host/mission/mission.hpp"
#include "host/mission/winds.hpp"
#include "host/result/result_json.hpp"
#include "progress.hpp"
#include "study/plan/study_plan.hpp"
#include "study/plan/undecidable.hpp"
#include "study/reproduce/paper.hpp"

namespace altiplan::cli {
namespace {

struct ValidateArguments {
  std::vector<std::string> files;
  host::Overrides overrides;
  bool json = false;
  bool builds = false;
};

/// Builds the world, whose layers read their files, and prints its warnings.
void build(const host::Config& config) {
  const host::Mission mission =
      busy("building the world", [&] { return host::build_mission(config, 1); });
  for (const std::string& warning : mission.warnings) {
    warn(warning);
  }
}

/// Returns what was checked, for the user.
std::string validate_one(const std::string& file, const ValidateArguments& arguments) {
  const host::FileKind kind = host::kind_of(host::load_yaml(file));
  if (kind == host::FileKind::study) {
    const auto plan = busy("reading the study", [&] {
      return study::load_study(file, {}, arguments.overrides.plugin_path);
    });
    for (const std::string& sentence : study::undecidable_claims(plan, {})) {
      warn(file + ": " + sentence);
    }
    return arguments.builds ? "valid; the worlds of a study are not built" : "valid";
  }
  if (kind == host::FileKind::paper) {
    study::read_paper(file);
    return arguments.builds ? "valid; the worlds of a paper are not built" : "valid";
  }
  const host::Config config = kind == host::FileKind::pipeline
                                  ? host::load_config(file, arguments.overrides)
                                  : host::load_scenario(file, arguments.overrides);
  if (arguments.builds) {
    build(config);
  } else {
    host::expect_minimised(config);
    host::expect_one_wind(config);
  }
  return arguments.builds ? "valid, and its world can be built" : "valid";
}

int validate(const ValidateArguments& arguments) {
  int code = kDone;
  for (const std::string& file : arguments.files) {
    try {
      const std::string verdict = validate_one(file, arguments);
      std::cout << file << ": " << verdict << '\n';
    } catch (const ConfigError& error) {
      for (const Problem& problem : error.problems()) {
        std::cerr << problem.text() << '\n';
      }
      code = std::max(code, kBadFile);
    } catch (const PluginError& error) {
      std::cerr << file << ": " << error.what() << '\n';
      code = kBadPlugin;
    }
  }
  return code;
}

int explain_as_json(const host::Config& config, const std::vector<host::Explained>& all) {
  const host::Mission mission = host::build_mission(config, 1);
  host::Json parameters = host::Json::array();
  for (const host::Explained& entry : all) {
    parameters.push_back({{"key", entry.key},
                          {"value", host::parse_json(entry.value_json)},
                          {"unit", entry.unit},
                          {"from", entry.from}});
  }
  const host::Json json{
      {"parameters", parameters}, {"notes", mission.notes}, {"warnings", mission.warnings}};
  std::cout << host::file_text(json);
  return kDone;
}

/// Builds the world too, since the notes and warnings of the layers come from it. The notes are
/// printed as they arise: the extent of a layer helps to correct a volume that is refused.
int explain(const ValidateArguments& arguments) {
  const host::Config config = host::load_config(arguments.files[0], arguments.overrides);
  const std::vector<host::Explained> all = host::explain(config);
  if (arguments.json) {
    return explain_as_json(config, all);
  }
  std::size_t width = 0;
  for (const host::Explained& entry : all) {
    width = std::max(width, entry.key.size());
  }
  for (const host::Explained& entry : all) {
    const std::string value = entry.value_json +
                              (entry.unit.empty() || entry.value_json == "null" ? "" : " ") +
                              (entry.value_json == "null" ? "" : entry.unit);
    std::printf("%-*s  %-24s  %s\n", int(width), entry.key.c_str(), value.c_str(),
                entry.from.c_str());
  }
  const host::Mission mission = host::build_mission(
      config, 1, {}, [](const std::string& note) { std::printf("%s\n", note.c_str()); });
  for (const std::string& warning : mission.warnings) {
    warn(warning);
  }
  return kDone;
}
}  // namespace

void add_validate(App& app, Action& action) {
  auto [command, arguments] = add_command<ValidateArguments>(
      app, action, "validate",
      "check pipeline, scenario, study and paper files without running them", validate);
  command.add_option("files", arguments.files, "pipeline, scenario, study and paper files (YAML)")
      ->required();
  command.add_flag("--build", arguments.builds,
                   "also build the world, so that the contents of its files are checked");
  add_plugin_path(command, arguments.overrides);
  set_example(command, "altiplan validate configs/*/*.yaml");
}

void add_explain(App& app, Action& action) {
  auto [command, arguments] = add_command<ValidateArguments>(
      app, action, "explain", "print a pipeline with all defaults and the source of each value",
      explain);
  command.add_option("pipeline", arguments.files, "pipeline file (YAML)")->required()->expected(1);
  add_overrides(command, arguments.overrides);
  command.add_flag("--json", arguments.json, "print as JSON");
  set_example(command, "altiplan explain configs/pipelines/ridge_crossing.yaml");
}
}  // namespace altiplan::cli
