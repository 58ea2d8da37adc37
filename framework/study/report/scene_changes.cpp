// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "host/base/machine_fault.hpp"
#include "study/report/scenes.hpp"

namespace altiplan::study::report {
namespace {

/// Builds by kind and name of the plugins that make the world: the planners do not matter.
std::map<std::string, std::string> world_builds(const host::Json& plugins) {
  std::map<std::string, std::string> builds;
  for (const host::Json& plugin : plugins) {
    const std::string kind = plugin.at("kind");
    if (kind == "environment" || kind == "constraint") {
      builds[kind + " '" + plugin.at("name").get<std::string>() + "'"] = plugin.at("build");
    }
  }
  return builds;
}
}  // namespace

std::vector<std::string> what_changed(const host::StoredResult& stored) {
  std::vector<std::string> changes;
  for (const std::string& file : stored.changed) {
    changes.push_back(file + (host::is_there(file) ? " has changed since" : " no longer exists"));
  }
  if (!changes.empty()) {
    return changes;  // the files may name other plugins now
  }
  const auto now =
      world_builds(host::plugins_json(host::load_config(stored.pipeline, stored.overrides)));
  for (const auto& [plugin, build] : world_builds(stored.json.at("plugins"))) {
    const auto found = now.find(plugin);
    if (found == now.end() || found->second != build) {
      changes.push_back(plugin + " has been rebuilt since");
    }
  }
  return changes;
}
}  // namespace altiplan::study::report
