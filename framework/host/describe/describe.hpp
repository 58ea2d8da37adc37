// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/json.hpp"
#include "host/plugins/registry.hpp"

namespace altiplan::host {

/// Description of a plugin, built in or from a library.
struct Description {
  std::string kind;
  std::string name;
  std::string sentence;
  std::string library;  ///< file; "" if built in
  std::string build;
  std::vector<FieldSpec> parameters;
  std::optional<Traits> traits;  ///< of planners, with default parameters
};

/// The plugins of that name, one for each kind that has it. Throws Error if there is none, and
/// PluginError if its library is refused.
std::vector<Description> describe_plugin(Registry& registry, std::string_view name);
std::string describe_text(const Description& description);
Json describe_json(const Description& description);

/// The parameters as a Markdown table, one row each; those of lists and maps follow their key.
std::string parameter_table(const std::vector<FieldSpec>& parameters);

/// The registry's libraries, each loaded in its own process: one that cannot be loaded, or that
/// ends its process, is refused with the reason.
std::vector<Library> examine_all(Registry& registry);
/// A plugin in the list of all.
struct ListedPlugin {
  std::string kind;
  std::string name;
  std::string sentence;
};
std::vector<ListedPlugin> listed_plugins(const std::vector<Library>& libraries);
/// A line for each refused library, and for each copy and each folder searched.
std::string refused_text(const std::vector<Library>& libraries);
std::string searched_text(const Registry& registry);
Json plugins_json(const Registry& registry, const std::vector<Library>& libraries);
}  // namespace altiplan::host
