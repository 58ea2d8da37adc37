// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <iostream>

#include "commands.hpp"
#include "host/first_route/file_info.hpp"

namespace altiplan::cli {
namespace {

struct Arguments {
  std::vector<std::string> files;
  std::string crs;
  host::Overrides overrides;
};

int info_of(const Arguments& arguments) {
  host::Registry registry(host::Registry::search_path(arguments.overrides.plugin_path));
  int code = kDone;
  for (const std::string& file : arguments.files) {
    host::FileInfo info;
    try {
      info = host::info_of(file, arguments.crs, registry);
    } catch (const PluginError&) {
      throw;
    } catch (const Error& error) {  // the files that follow may be good
      std::cerr << "altiplan: " << error.what() << '\n';
      code = kBadFile;
      continue;
    }
    std::printf("%s: %s\n", file.c_str(), info.kind.c_str());
    for (const std::string& fact : info.facts) {
      std::printf("  %s\n", fact.c_str());
    }
    if (!info.scenario.empty()) {
      std::printf("  in a scenario:\n");
    }
    for (const std::string& line : info.scenario) {
      std::printf("    %s\n", line.c_str());
    }
  }
  return code;
}
}  // namespace

void add_info(App& app, Action& action) {
  App* command =
      app.add_subcommand("info", "what a file holds: elevation model, zones, map, mission");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("files", arguments->files, "files")->required();
  command->add_option("--crs", arguments->crs, "coordinate system of a model that names none")
      ->type_name("EPSG:CODE");
  add_plugin_path(*command, arguments->overrides);
  set_example(*command, "altiplan info configs/data/jacksboro_fault.tif");
  command->callback([&action, arguments] { action = [arguments] { return info_of(*arguments); }; });
}
}  // namespace altiplan::cli
