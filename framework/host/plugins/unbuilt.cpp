// SPDX-License-Identifier: Apache-2.0
#include "host/plugins/unbuilt.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>

#include "altiplan/error.hpp"
#include "host/base/program.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;
namespace {

bool is_allowed = false;

/// One build at a time in a tree: ninja and make expect it.
class BuildLock {
 public:
  explicit BuildLock(const fs::path& file)
      : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
    if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX) != 0) {
      throw Error("cannot lock " + file.string() + ", which a build of plugins needs");
    }
  }
  ~BuildLock() { ::close(descriptor_); }
  BuildLock(const BuildLock&) = delete;
  BuildLock& operator=(const BuildLock&) = delete;

 private:
  int descriptor_;
};

fs::path library_of(const std::string& kind, const std::string& name) {
  return "libaltiplan_" + kind + "_" + name + ".so";
}
}  // namespace

void Unbuilt::allow() { is_allowed = true; }

Unbuilt::Unbuilt(const fs::path& folder) : folder_(folder) {
  if (!is_allowed) {
    return;
  }
  std::ifstream list(folder / "buildable.txt");
  for (Plugin plugin; list >> plugin.kind >> plugin.name;) {
    if (!fs::exists(folder / library_of(plugin.kind, plugin.name))) {
      plugins_.push_back(plugin);
    }
  }
}

std::vector<std::string> Unbuilt::names(std::string_view kind) const {
  std::vector<std::string> names;
  for (const Plugin& plugin : plugins_) {
    if (plugin.kind == kind) {
      names.push_back(plugin.name);
    }
  }
  return names;
}

std::vector<fs::path> Unbuilt::build(std::string_view kind, std::string_view name) {
  std::vector<Plugin> wanted;
  std::copy_if(plugins_.begin(), plugins_.end(), std::back_inserter(wanted),
               [&](const Plugin& p) { return p.kind == kind && p.name == name; });
  return build(wanted);
}

std::vector<fs::path> Unbuilt::build_all() { return build(std::vector(plugins_)); }

std::vector<fs::path> Unbuilt::build(const std::vector<Plugin>& plugins) {
  if (plugins.empty()) {
    return {};
  }
  const fs::path tree =
      folder_.parent_path().parent_path().parent_path();  // of lib/altiplan/plugins
  const std::optional<fs::path> cmake = find_on_path({"cmake"});
  std::vector<std::string> command{cmake.value_or("cmake").string(), "--build", tree.string(),
                                   "--target"};
  std::string words;
  std::vector<fs::path> libraries;
  for (const Plugin& plugin : plugins) {
    command.push_back("altiplan_" + plugin.kind + "_" + plugin.name);
    words += (words.empty() ? "" : ", ") + plugin.name;
    libraries.push_back(folder_ / library_of(plugin.kind, plugin.name));
    std::erase_if(plugins_, [&](const Plugin& other) {
      return other.kind == plugin.kind && other.name == plugin.name;
    });
  }
  if (!cmake) {
    throw Error(words + " is not built yet, and there is no cmake on the PATH to build it");
  }
  const std::string count = std::to_string(libraries.size());
  std::cerr << "altiplan: building " << (libraries.size() > 4 ? count + " plugins" : words)
            << " (needed for the first time)\n";
  const BuildLock lock(folder_ / "buildable.lock");
  const Program build(command);
  const auto end = Program::Clock::now() + std::chrono::hours(2);
  std::optional<int> code;
  while (!code && Program::Clock::now() < end) {
    code = build.ended(Program::Clock::now() + std::chrono::seconds(20));
    if (!code) {
      const auto done = std::count_if(libraries.begin(), libraries.end(),
                                      [](const fs::path& file) { return fs::exists(file); });
      std::cerr << "altiplan: built " << done << " of " << count << '\n';
    }
  }
  if (code != 0) {
    throw Error("building " + words + " failed; cmake --build " + tree.string() + " shows why");
  }
  return libraries;
}
}  // namespace altiplan::host
