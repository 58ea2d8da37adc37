// SPDX-License-Identifier: Apache-2.0
#include "altiplan/error.hpp"
#include "host/base/built_in.hpp"
#include "host/base/in_child.hpp"
#include "host/base/machine_fault.hpp"
#include "host/describe/describe.hpp"

namespace altiplan::host {
std::vector<Library> examine_all(Registry& registry) {
  registry.build_all();
  std::vector<Library> libraries(registry.libraries().begin(), registry.libraries().end());
  for (Library& library : libraries) {
    if (library.is_machine_fault) {
      throw MachineFault(library.file.string() + ": " + library.refused);
    }
    if (library.refused.empty()) {
      try {
        // Getting one plugin tries all of its library; the parent process must load none.
        in_child("",
                 [&] { registry.get(library.plugins.front().kind, library.plugins.front().name); });
      } catch (const PluginError& error) {
        library.refused = error.what();
      }
    }
  }
  return libraries;
}

std::vector<ListedPlugin> listed_plugins(const std::vector<Library>& libraries) {
  std::vector<ListedPlugin> all;
  for (const PluginEntry& entry : built_in_plugins()) {
    all.push_back({entry.kind, entry.name, std::string(entry.sentence) + " (built in)"});
  }
  for (const Library& library : libraries) {
    for (const Manifest& plugin : library.plugins) {
      if (library.refused.empty()) {
        all.push_back({plugin.kind, plugin.name, plugin.sentence});
      }
    }
  }
  return all;
}

std::string refused_text(const std::vector<Library>& libraries) {
  std::string text;
  for (const Library& library : libraries) {
    if (!library.refused.empty()) {
      text += "refused: " + library.file.string() + ": " + library.refused + "\n";
    }
  }
  return text;
}

std::string searched_text(const Registry& registry) {
  std::string text;
  for (const LibraryCopy& copy : registry.copies()) {
    text += "skipped: " + copy.file.string() + ": the same build as " + copy.used.string() +
            ", which comes first\n";
  }
  for (const std::filesystem::path& folder : registry.folders()) {
    text += "searched: " + folder.string() + (is_folder(folder) ? "" : " (no such folder)") + "\n";
  }
  return text;
}

Json plugins_json(const Registry& registry, const std::vector<Library>& libraries) {
  Json json = {{"folders", Json::array()},
               {"built_in", Json::array()},
               {"libraries", Json::array()},
               {"copies", Json::array()}};
  for (const std::filesystem::path& folder : registry.folders()) {
    json["folders"].push_back(folder.string());
  }
  for (const PluginEntry& entry : built_in_plugins()) {
    json["built_in"].push_back(
        {{"kind", entry.kind}, {"name", entry.name}, {"sentence", entry.sentence}});
  }
  for (const Library& library : libraries) {
    Json plugins = Json::array();
    for (const Manifest& plugin : library.plugins) {
      plugins.push_back(
          {{"kind", plugin.kind},
           {"name", plugin.name},
           {"sentence", plugin.sentence},
           {"api", std::to_string(plugin.api_major) + "." + std::to_string(plugin.api_minor)},
           {"compiler", plugin.compiler},
           {"optimised", plugin.optimised != 0}});
    }
    json["libraries"].push_back(
        {{"file", library.file.string()},
         {"build", library.build},
         {"checksum", library.checksum},
         {"plugins", std::move(plugins)},
         {"refused", library.refused.empty() ? Json() : Json(library.refused)}});
  }
  for (const LibraryCopy& copy : registry.copies()) {
    json["copies"].push_back({{"file", copy.file.string()}, {"used", copy.used.string()}});
  }
  return json;
}
}  // namespace altiplan::host
