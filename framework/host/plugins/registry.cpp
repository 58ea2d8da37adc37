// SPDX-License-Identifier: Apache-2.0
#include "host/plugins/registry.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <set>

#include "altiplan/error.hpp"
#include "altiplan_build.hpp"
#include "host/base/built_in.hpp"
#include "host/base/install_root.hpp"
#include "host/base/machine_fault.hpp"
#include "host/scripts/script.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;

namespace {

/// Planners and local planners share one key (`plan:`), and so one namespace.
bool share_names(std::string_view a, std::string_view b) {
  const auto plans = [](std::string_view kind) {
    return kind == "planner" || kind == "local_planner";
  };
  return a == b || (plans(a) && plans(b));
}

std::vector<fs::path> libraries_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == ".so" || offers_scripts(it->path())) {
      files.push_back(it->path());
    }
  }
  if (is_machine_fault(error.value())) {
    throw MachineFault(unreadable(folder, error.value()));
  }
  if (error && error != std::errc::no_such_file_or_directory &&
      error != std::errc::not_a_directory) {
    throw Error(unreadable(folder, error.value()));
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string with_article(std::string_view kind) {
  return (kind.starts_with('e') ? "an " : "a ") + std::string(kind);
}

/// Refuses all libraries that offer the same kind and name.
void refuse_conflicts(std::deque<Library>& libraries) {
  std::vector<std::string> reasons(libraries.size());
  for (std::size_t i = 0; i < libraries.size(); ++i) {
    for (std::size_t j = 0; j < libraries.size(); ++j) {
      for (const Manifest& a : libraries[i].plugins) {
        for (const Manifest& b : libraries[j].plugins) {
          if ((i == j && &a == &b) || std::strcmp(a.name, b.name) != 0 ||
              !share_names(a.kind, b.kind)) {
            continue;
          }
          const std::string other_kind =
              std::strcmp(a.kind, b.kind) == 0 ? "it" : with_article(b.kind) + " of that name";
          reasons[i] += (reasons[i].empty() ? "" : "; ") + std::string("offers the ") + a.kind +
                        " '" + a.name + "', and " + libraries[j].file.string() + " offers " +
                        other_kind + " too: remove one of the two";
        }
      }
    }
  }
  for (std::size_t i = 0; i < libraries.size(); ++i) {
    std::string& refused = libraries[i].refused;
    if (refused.find(reasons[i]) != std::string::npos) {
      continue;  // known since other libraries were added
    }
    refused += (refused.empty() ? "" : "; ") + reasons[i];
  }
}

/// True for the same build offering the same plugins. A build id survives changes to a file's
/// bytes, so only libraries with a valid manifest count.
bool same_build(const Library& a, const Library& b) {
  return a.refused.empty() && b.refused.empty() && !a.build.empty() && a.build == b.build &&
         a.checksum == b.checksum &&
         std::equal(a.plugins.begin(), a.plugins.end(), b.plugins.begin(), b.plugins.end(),
                    [](const Manifest& x, const Manifest& y) {
                      return std::strcmp(x.kind, y.kind) == 0 && std::strcmp(x.name, y.name) == 0;
                    });
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : ", ") + word;
  }
  return text.empty() ? "none" : text;
}
}  // namespace

FileStamp::FileStamp(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) == 0) {
    numbers_ = {std::int64_t(status.st_dev), std::int64_t(status.st_ino), status.st_size,
                status.st_mtim.tv_sec,       status.st_mtim.tv_nsec,      status.st_ctim.tv_sec,
                status.st_ctim.tv_nsec};
  } else if (is_machine_fault(errno)) {
    throw MachineFault(unreadable(file, errno));
  }
}

Registry::Registry(std::vector<fs::path> folders) : folders_(std::move(folders)) {
  std::set<fs::path> seen;
  std::vector<fs::path> files;
  for (const fs::path& folder : folders_) {
    for (const fs::path& file : libraries_in(folder)) {
      std::error_code error;
      const fs::path real = fs::canonical(file, error);
      if (is_machine_fault(error.value())) {
        throw MachineFault(unreadable(file, error.value()));
      }
      if (seen.insert(error ? file : real).second) {
        files.push_back(file);
      }
    }
    if (seen.insert(folder / "buildable.txt").second) {
      unbuilt_.emplace_back(folder);
    }
  }
  add(files);
}

void Registry::add(const std::vector<fs::path>& files) {
  if (files.empty()) {
    return;
  }
  for (const fs::path& file : files) {
    Library library = examine_library(file);
    const auto first =
        std::find_if(libraries_.begin(), libraries_.end(),
                     [&](const Library& other) { return same_build(other, library); });
    if (first != libraries_.end()) {
      copies_.push_back({file, first->file});
    } else {
      libraries_.push_back(std::move(library));
    }
  }
  refuse_conflicts(libraries_);
}

void Registry::build_all() {
  for (Unbuilt& unbuilt : unbuilt_) {
    add(unbuilt.build_all());
  }
}

std::vector<fs::path> Registry::search_path(const std::vector<fs::path>& extra) {
  std::vector<fs::path> folders = extra;
  if (const char* listed = std::getenv("ALTIPLAN_PLUGIN_PATH")) {
    std::string_view rest = listed;
    while (!rest.empty()) {
      const std::string_view folder = rest.substr(0, rest.find(':'));
      // An empty entry would mean the current folder.
      if (!folder.empty()) {
        folders.emplace_back(folder);
      }
      rest.remove_prefix(std::min(rest.size(), folder.size() + 1));
    }
  }
  const fs::path installed = install_root();
  if (!installed.empty()) {
    folders.push_back(installed / ALTIPLAN_INSTALL_LIBDIR / "altiplan/plugins");
    if (folders.back() != installed / "lib/altiplan/plugins") {
      folders.push_back(installed / "lib/altiplan/plugins");  // of a build tree
    }
  }
  return folders;
}

std::vector<std::string> Registry::names(std::string_view kind) const {
  std::set<std::string> names;
  for (const Library& library : libraries_) {
    for (const Manifest& plugin : library.plugins) {
      if (library.refused.empty() && plugin.kind == kind) {
        names.insert(plugin.name);
      }
    }
  }
  for (const Unbuilt& unbuilt : unbuilt_) {
    const std::vector<std::string> more = unbuilt.names(kind);
    names.insert(more.begin(), more.end());
  }
  return {names.begin(), names.end()};
}

const Library* Registry::offering(std::string_view kind, std::string_view name) {
  // Also where another folder offers the name: that the two conflict must not depend on what is
  // built.
  for (Unbuilt& unbuilt : unbuilt_) {
    add(unbuilt.build(kind, name));
  }
  return find(kind, name);
}

const Library* Registry::find(std::string_view kind, std::string_view name) const {
  const auto refuse = [&](const Library& library) {
    const std::string why = "the library of the " + std::string(kind) + " '" + std::string(name) +
                            "' is refused: " + library.file.string() + ": " + library.refused;
    if (library.is_machine_fault) {
      throw MachineFault(why);
    }
    throw PluginError(why);
  };
  const std::string file = "libaltiplan_" + std::string(kind) + "_" + std::string(name) + ".so";
  for (const Library& library : libraries_) {
    if (library.file.filename() == file && library.is_machine_fault) {
      refuse(library);  // a copy in another folder may be another build
    }
  }
  for (const Library& library : libraries_) {
    for (const Manifest& plugin : library.plugins) {
      if (plugin.kind != kind || plugin.name != name) {
        continue;
      }
      if (!library.refused.empty()) {
        refuse(library);
      }
      return &library;
    }
  }
  // If a damaged library no longer states what it offers, its file name still does.
  for (const Library& library : libraries_) {
    if (!library.refused.empty() && library.file.filename() == file) {
      refuse(library);
    }
  }
  return nullptr;
}

const PluginEntry& Registry::get(std::string_view kind, std::string_view name) {
  const Library* library = offering(kind, name);
  if (library == nullptr) {
    throw Error(not_offered(kind, name));
  }
  {
    const std::lock_guard lock(mutex_);
    used_.try_emplace(library, FileStamp(library->file));
  }
  const std::vector<const PluginEntry*> entries = load_library(*library);
  return **std::find_if(entries.begin(), entries.end(), [&](const PluginEntry* entry) {
    return entry->kind == kind && entry->name == name;
  });
}

std::vector<fs::path> Registry::changed() {
  const std::lock_guard lock(mutex_);
  std::vector<fs::path> files;
  for (auto& [library, stamp] : used_) {
    if (const FileStamp now(library->file); now != stamp) {
      stamp = now;
      if (!is_unchanged(*library)) {
        files.push_back(library->file);
      }
    }
  }
  return files;
}

std::string Registry::not_offered(std::string_view kind, std::string_view name) const {
  const std::vector<std::string> present = names(kind);
  std::vector<std::string> built_in;
  for (const PluginEntry& entry : built_in_plugins()) {
    if (entry.kind == kind) {
      built_in.push_back(entry.name);
    }
  }
  std::string text =
      "no library provides the " + std::string(kind) + " '" + std::string(name) + "'";
  std::string near = nearest_name(name, built_in);
  near = near.empty() ? nearest_name(name, present) : near;
  std::vector<std::string> refused;
  for (const Library& library : libraries_) {
    if (!library.refused.empty()) {
      refused.push_back(library.file.string() + " (" + library.refused + ")");
    }
    for (const Manifest& plugin : library.plugins) {
      if (plugin.name == name) {
        text += " ('" + std::string(name) + "' is " + with_article(plugin.kind) + ")";
      }
    }
  }
  if (near.empty()) {
    std::vector<std::string> searched;
    for (const fs::path& folder : folders_) {
      searched.push_back(folder.string() + (is_folder(folder) ? "" : " (no such folder)"));
    }
    text += "; present: " + joined(present) + "; searched: " + joined(searched) +
            (built_in.empty() ? "" : "; built in: " + joined(built_in));
  } else {
    text += "; did you mean '" + near + "'?";
  }
  return text + (refused.empty() ? "" : "; refused: " + joined(refused));
}
}  // namespace altiplan::host
