// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "altiplan/plugin_abi.hpp"

namespace altiplan::host {

/// A plugin library as its file describes it; nothing of it has run yet.
struct Library {
  std::filesystem::path file;
  std::string build;              ///< GNU build id, else a hash of the file; hexadecimal
  std::vector<Manifest> plugins;  ///< empty where refused before the manifest could be read
  std::string refused;            ///< why, with both sides; "" when it may be loaded
};

/// A second copy of one build: the one that comes first in search order is used.
struct LibraryCopy {
  std::filesystem::path file;
  std::filesystem::path used;
};

/// Knows which library offers which plugin, and loads one when it is first asked for. Libraries are
/// read as ELF files first; only one whose manifest fits this host is ever opened (rtld_now,
/// local), and none is unloaded.
class Registry {
 public:
  /// Folders in search order; missing ones are passed over.
  explicit Registry(std::vector<std::filesystem::path> folders);
  ~Registry();
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  /// `extra` (the command line, then the config), ALTIPLAN_PLUGIN_PATH (colon-separated), and the
  /// install folder relative to this program; never the current folder.
  static std::vector<std::filesystem::path> search_path(
      const std::vector<std::filesystem::path>& extra);

  const std::vector<std::filesystem::path>& folders() const { return folders_; }
  const std::vector<Library>& libraries() const { return libraries_; }
  /// Files that were passed over as copies of a library found before.
  const std::vector<LibraryCopy>& copies() const { return copies_; }
  /// Names offered for a kind, sorted.
  std::vector<std::string> names(std::string_view kind) const;
  /// The library that offers the plugin; null where none does. Throws PluginError where a library
  /// that offers the name, or is called libaltiplan_KIND_NAME.so, is refused. Libraries that share
  /// a name (planners and local planners have theirs in common) are all refused.
  const Library* offering(std::string_view kind, std::string_view name) const;

  /// Loads at the first call, in a child process before this one. Throws PluginError where the
  /// library cannot be used, Error where no library offers the name (with the folders searched and
  /// the nearest name).
  const PluginEntry& get(std::string_view kind, std::string_view name);

 private:
  std::string not_offered(std::string_view kind, std::string_view name) const;

  std::vector<std::filesystem::path> folders_;
  std::vector<Library> libraries_;
  std::vector<LibraryCopy> copies_;
  struct Loaded;
  std::mutex mutex_;  ///< of loaded_
  std::map<std::filesystem::path, std::unique_ptr<Loaded>> loaded_;
};

/// Reads a library's ELF headers, manifest and build id without running any of its code; never
/// throws: what is wrong stands in `refused`.
Library examine_library(const std::filesystem::path& file);

/// Opens the library in this process, for ever: its entries, in the manifest's order. Throws
/// PluginError where it cannot be opened, or does not hold what its manifest announces. A damaged
/// one can end the process.
std::vector<const PluginEntry*> load_library(const Library& library);

/// Lower-case letters, digits and '_', the first a letter: a plugin, and a parameter, are so named.
bool is_snake_case(std::string_view name);
}  // namespace altiplan::host
