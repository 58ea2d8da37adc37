// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "altiplan/constraint.hpp"
#include "altiplan/environment.hpp"
#include "altiplan/local_planner.hpp"
#include "altiplan/objective.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin_abi.hpp"
#include "altiplan/smoother.hpp"
#include "altiplan/task.hpp"
#include "altiplan/tuner.hpp"
#include "host/base/plugin_file.hpp"
#include "host/plugins/unbuilt.hpp"

namespace altiplan::host {

/// File metadata for a cheap test whether a file was modified or replaced.
class FileStamp {
 public:
  explicit FileStamp(const std::filesystem::path& file);
  bool operator==(const FileStamp&) const = default;

 private:
  std::array<std::int64_t, 7> numbers_{};
};

/// A second copy of one build: the first in search order is used.
struct LibraryCopy {
  std::filesystem::path file;
  std::filesystem::path used;
};

/// Knows which library offers which plugin, and loads it on first use. Libraries are read as ELF
/// files first; only those whose manifest matches this host, and whose bytes match their checksum,
/// are opened (rtld_now, local), and none is unloaded.
class Registry {
 public:
  /// Folders in search order; missing ones are skipped.
  explicit Registry(std::vector<std::filesystem::path> folders);
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  /// `extra` (the command line, then the config), ALTIPLAN_PLUGIN_PATH (colon-separated), and the
  /// install folder relative to this program; never the current folder.
  static std::vector<std::filesystem::path> search_path(
      const std::vector<std::filesystem::path>& extra);

  const std::vector<std::filesystem::path>& folders() const { return folders_; }
  const std::deque<Library>& libraries() const { return libraries_; }
  /// Files that were skipped as copies of a library found before.
  const std::vector<LibraryCopy>& copies() const { return copies_; }
  /// Has what a build tree can make and has not made yet built, for commands that look at all
  /// plugins; nothing elsewhere. Throws Error if the build fails.
  void build_all();
  /// Names offered for a kind, sorted; those that a build tree can make too.
  std::vector<std::string> names(std::string_view kind) const;
  /// The library that offers the plugin; null if none does. Throws PluginError if a library that
  /// offers the name, or is called libaltiplan_KIND_NAME.so, is refused. Libraries that offer the
  /// same name (planners and local planners share one namespace) are all refused. A build tree
  /// builds the plugin that it has not built yet.
  const Library* offering(std::string_view kind, std::string_view name);

  /// Loads the library at the first call, in a child process before this one. Throws PluginError if
  /// the library cannot be used, Error if no library provides the name (with the folders searched
  /// and the nearest name).
  const PluginEntry& get(std::string_view kind, std::string_view name);

  /// Files of libraries in use that have changed since they were loaded; reports each change once.
  std::vector<std::filesystem::path> changed();

 private:
  const Library* find(std::string_view kind, std::string_view name) const;
  void add(const std::vector<std::filesystem::path>& files);
  std::string not_offered(std::string_view kind, std::string_view name) const;

  std::vector<std::filesystem::path> folders_;
  std::deque<Library> libraries_;  ///< each stays where it is when others are added
  std::vector<LibraryCopy> copies_;
  std::vector<Unbuilt> unbuilt_;
  std::mutex mutex_;  ///< of used_
  std::map<const Library*, FileStamp> used_;
};

/// Reads a library's ELF headers, manifest and build id without running any of its code; never
/// throws: errors are reported in `refused`.
Library examine_library(const std::filesystem::path& file);

/// The library's entries, in the manifest's order. At the first call it is copied, verified, tried
/// in a child process (a damaged one can end the process) and opened in this one for good. Throws
/// PluginError if it cannot be opened, has changed since it was examined, or lacks a plugin that
/// its manifest announces; Error if the system has no memory for it.
std::vector<const PluginEntry*> load_library(const Library& library);

/// True if the file is unchanged since it was examined.
bool is_unchanged(const Library& library);
}  // namespace altiplan::host
