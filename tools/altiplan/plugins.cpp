// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <iostream>

#include "commands.hpp"
#include "host/describe/describe.hpp"
#include "host/describe/schema.hpp"
#include "host/result/result_json.hpp"
#include "study/model/study_file.hpp"
#include "study/reproduce/paper_file.hpp"
#include "table.hpp"

namespace altiplan::cli {
namespace {

struct PluginsArguments {
  std::string name;
  host::Overrides overrides;
  bool strict = false;
  bool json = false;
};

host::Registry registry_of(const PluginsArguments& arguments) {
  return host::Registry(host::Registry::search_path(arguments.overrides.plugin_path));
}

int plugins(const PluginsArguments& arguments) {
  host::Registry registry = registry_of(arguments);
  const std::vector<host::Library> libraries = host::examine_all(registry);
  if (arguments.json) {
    std::cout << host::file_text(host::plugins_json(registry, libraries));
  } else {
    Table table({{"", false, 31}, {""}}, 0);
    for (const host::ListedPlugin& plugin : host::listed_plugins(libraries)) {
      table.add({Table::Cell(plugin.kind + " " + plugin.name, Color::strong), plugin.sentence});
    }
    table.print(stdout);
    std::fputs(painted(stdout, Color::bad, host::refused_text(libraries)).c_str(), stdout);
    std::fputs(host::searched_text(registry).c_str(), stdout);
  }
  const bool refused = std::any_of(libraries.begin(), libraries.end(),
                                   [](const host::Library& l) { return !l.refused.empty(); });
  return refused && arguments.strict ? kBadPlugin : kDone;
}

int describe(const PluginsArguments& arguments) {
  host::Registry registry = registry_of(arguments);
  const std::vector<host::Description> all = host::describe_plugin(registry, arguments.name);
  if (arguments.json) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const host::Description& description : all) {
      json.push_back(host::describe_json(description));
    }
    std::cout << host::file_text(all.size() == 1 ? json.front() : json);
    return kDone;
  }
  for (const host::Description& description : all) {
    std::cout << host::describe_text(description);
  }
  return kDone;
}

int schema(const PluginsArguments& arguments) {
  host::Registry registry = registry_of(arguments);
  std::cout << host::file_text(host::any_file_schema(host::choices_of(registry),
                                                     host::fields_of<study::StudyFile>(),
                                                     host::fields_of<study::PaperFile>()));
  return kDone;
}

using Command = std::pair<App&, PluginsArguments&>;

Command add(App& app, Action& action, const char* name, const char* sentence,
            int (*call)(const PluginsArguments&)) {
  Command added = add_command<PluginsArguments>(app, action, name, sentence, call);
  add_plugin_path(added.first, added.second.overrides);
  added.first.add_flag("--json", added.second.json, "print as JSON");
  return added;
}
}  // namespace

void add_plugins(App& app, Action& action) {
  auto [all, of_all] = add(app, action, "plugins",
                           "list the loaded plugins, and why other libraries are refused", plugins);
  all.add_flag("--strict", of_all.strict, "exit with code 4 if a library is refused");
  set_example(all, "altiplan plugins --plugin-path build/my_plugins");

  auto [one, of_one] =
      add(app, action, "describe", "print a plugin's description, parameters and traits", describe);
  one.add_option("name", of_one.name, "name of the plugin")->required();
  set_example(one, "altiplan describe astar");

  set_example(
      add(app, action, "schema", "print the JSON Schema (draft-07) of the input files", schema)
          .first,
      "altiplan schema > altiplan.schema.json");
}
}  // namespace altiplan::cli
