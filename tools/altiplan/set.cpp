// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "altiplan/formats/input_file.hpp"
#include "commands.hpp"
#include "host/base/output_file.hpp"
#include "host/config/yaml.hpp"
#include "host/config/yaml_edit.hpp"

namespace altiplan::cli {
namespace {

struct SetArguments {
  std::string file;
  std::vector<std::string> set;
  host::Overrides overrides;
};

/// A file with its text before and after.
struct Edited {
  std::filesystem::path file;
  std::string before;
  std::string after;
};

Edited edited(const std::filesystem::path& file, const SetArguments& arguments,
              host::FileOfKey which) {
  const std::string before = formats::read_file(file);
  return {file, before,
          host::with_assignments(before, file.string(), arguments.overrides.set, which)};
}

int set(SetArguments arguments) {
  const host::FileKind kind = host::kind_of(host::load_yaml(arguments.file));
  if (kind != host::FileKind::pipeline && kind != host::FileKind::scenario) {
    throw ConfigError({arguments.file, 0, 0, ""}, "", "expected a pipeline or a scenario");
  }
  const bool is_scenario = kind == host::FileKind::scenario;
  for (const std::string& assignment : arguments.set) {
    const bool removes = assignment.starts_with('~');
    arguments.overrides.set.push_back(std::string(removes ? "~" : "") +
                                      (is_scenario ? "scenario." : "") +
                                      assignment.substr(removes ? 1 : 0));
  }
  // As the files will be: whatever is wrong with a value shows before anything is written.
  const host::Config config = is_scenario ? host::load_scenario(arguments.file, arguments.overrides)
                                          : host::load_config(arguments.file, arguments.overrides);
  std::vector<Edited> files{
      edited(arguments.file, arguments,
             is_scenario ? host::FileOfKey::scenario : host::FileOfKey::pipeline)};
  if (!is_scenario) {
    files.push_back(edited(config.scenario_path, arguments, host::FileOfKey::scenario));
  }
  for (const auto& [file, before, after] : files) {
    if (const std::string problem = host::output_problem(file);
        after != before && !problem.empty()) {
      throw Error(problem);
    }
  }
  for (const auto& [file, before, after] : files) {
    if (after != before) {
      host::write_file(file, after);
      std::printf("%s: written\n", file.c_str());
    }
  }
  return kDone;
}
}  // namespace

void add_set(App& app, Action& action) {
  auto [command, arguments] = add_command<SetArguments>(
      app, action, "set", "change values of a pipeline or scenario file, and nothing else in it",
      set);
  command.add_option("file", arguments.file, "pipeline or scenario file (YAML)")->required();
  command
      .add_option(
          "assignments", arguments.set,
          "KEY=VALUE, or ~KEY to remove; of a pipeline, scenario.KEY changes its scenario's file")
      ->required();
  add_plugin_path(command, arguments.overrides);
  set_example(
      command,
      "altiplan set pipeline.yaml steps.0.with.weight_g=0.6 'scenario.goal.at_m=[23000, 21000]'");
}
}  // namespace altiplan::cli
