// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace altiplan::host {

/// Plugins that a build tree can make and has not made yet. `tools/run` builds only those that its
/// pipeline names; the registry has the others built when a command needs them. CMake lists them
/// beside their libraries, in `buildable.txt`; what is installed has no such list.
class Unbuilt {
 public:
  /// From now on this process may start builds, which `altiplan` does; what tests or fuzzes never
  /// asks for that.
  static void allow();

  /// Reads the list of that folder of libraries; empty where there is none or none is allowed.
  explicit Unbuilt(const std::filesystem::path& folder);

  /// Names of a kind, in the list's order.
  std::vector<std::string> names(std::string_view kind) const;
  /// Builds these plugins, prints that it does to standard error, and returns their libraries.
  /// Throws Error if the build fails, with the command that shows why.
  std::vector<std::filesystem::path> build(std::string_view kind, std::string_view name);
  std::vector<std::filesystem::path> build_all();

 private:
  struct Plugin {
    std::string kind;
    std::string name;
  };
  std::vector<std::filesystem::path> build(const std::vector<Plugin>& plugins);

  std::filesystem::path folder_;
  std::vector<Plugin> plugins_;
};
}  // namespace altiplan::host
