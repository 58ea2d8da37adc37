// SPDX-License-Identifier: Apache-2.0
#include "host/registry/registry.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <boost/dll/shared_library.hpp>
#include <cstdlib>
#include <cstring>
#include <set>

#include "altiplan/error.hpp"
#include "host/registry/in_child.hpp"
#include "host/registry/install_root.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;

/// A library that is open, with its entries in the manifest's order.
struct Registry::Loaded {
  std::vector<const PluginEntry*> entries;
};

namespace {

/// Planners and local planners answer to one key (`plan:`), so they share their names.
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
    if (it->path().extension() == ".so") {
      files.push_back(it->path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string with_article(std::string_view kind) {
  return (kind.starts_with('e') ? "an " : "a ") + std::string(kind);
}

/// Refuses all libraries that offer one kind and name more than once between them.
void refuse_conflicts(std::vector<Library>& libraries) {
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
                        other_kind + " too: take one of the two away";
        }
      }
    }
  }
  for (std::size_t i = 0; i < libraries.size(); ++i) {
    std::string& refused = libraries[i].refused;
    refused += (refused.empty() || reasons[i].empty() ? "" : "; ") + reasons[i];
  }
}

/// The same build offering the same plugins. A build id outlives changes to a file's bytes, so only
/// libraries whose manifests are read without complaint count.
bool same_build(const Library& a, const Library& b) {
  return a.refused.empty() && b.refused.empty() && !a.build.empty() && a.build == b.build &&
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

/// The library, open from now to the end of the process: objects, and exceptions, of a plugin must
/// never outlive its code.
boost::dll::shared_library& open_for_ever(const fs::path& file) {
  static std::vector<std::unique_ptr<boost::dll::shared_library>>& open =
      *new std::vector<std::unique_ptr<boost::dll::shared_library>>;
  auto library = std::make_unique<boost::dll::shared_library>();
  boost::dll::fs::error_code error;
  library->load(file, error, boost::dll::load_mode::rtld_now | boost::dll::load_mode::rtld_local);
  if (error) {
    // Boost's own text ends in an unrelated "Bad file descriptor".
    const char* reason = ::dlerror();
    throw PluginError(file.string() + " cannot be loaded: " +
                      (reason != nullptr ? reason : error.message().c_str()));
  }
  return *open.emplace_back(std::move(library));
}

bool has_maker(const PluginEntry& entry) {
  const std::string_view kind = entry.kind;
  return entry.describe != nullptr &&
         ((kind == "environment" && entry.environment != nullptr) ||
          (kind == "constraint" && entry.constraint != nullptr) ||
          (kind == "planner" && entry.planner != nullptr) ||
          (kind == "local_planner" && entry.local_planner != nullptr) ||
          (kind == "smoother" && entry.smoother != nullptr) ||
          (kind == "tuner" && entry.tuner != nullptr));
}

std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

/// Whether files can hold these parameters: names that lie in damaged data are no names.
void check_names(const FieldSpec& spec) {
  for (const FieldSpec& field : spec.children) {
    const bool nameless = spec.type == FieldType::list || field.type == FieldType::point ||
                          field.type == FieldType::plugin;
    if (!is_snake_case(field.name) && !(nameless && field.name.empty())) {
      throw PluginError("a parameter is named '" + printable(field.name) +
                        "', expected lower-case letters, digits and '_'");
    }
    check_names(field);
  }
}

/// Uses the library as reading a file will, as far as that goes without one.
void try_out(const Library& library) {
  for (const PluginEntry* entry : load_library(library)) {
    try {
      FieldSpec all;
      for (const ParamReport report = entry->describe(nullptr, "");
           const BoundField& field : report.fields) {
        all.children.push_back(field.spec);
      }
      check_names(all);
    } catch (const std::exception& error) {
      throw PluginError(library.file.string() + ": describing the " + entry->kind + " '" +
                        entry->name + "': " + error.what());
    }
  }
}
}  // namespace

std::vector<const PluginEntry*> load_library(const Library& library) {
  boost::dll::shared_library& opened = open_for_ever(fs::absolute(library.file));
  if (!opened.has(kPluginListSymbol)) {
    throw PluginError(library.file.string() + " does not export " + kPluginListSymbol);
  }
  std::size_t count = 0;
  const PluginEntry* const* list =
      opened.get<std::remove_pointer_t<PluginList>>(kPluginListSymbol)(&count);
  std::vector<const PluginEntry*> entries;
  for (const Manifest& plugin : library.plugins) {
    const auto found = std::find_if(list, list + count, [&](const PluginEntry* entry) {
      return entry != nullptr && entry->kind != nullptr && entry->name != nullptr &&
             std::strcmp(entry->kind, plugin.kind) == 0 &&
             std::strcmp(entry->name, plugin.name) == 0 && has_maker(*entry);
    });
    if (found == list + count) {
      throw PluginError(library.file.string() + " announces the " + plugin.kind + " '" +
                        plugin.name + "', but does not hold it");
    }
    entries.push_back(*found);
  }
  return entries;
}

Registry::Registry(std::vector<fs::path> folders) : folders_(std::move(folders)) {
  std::set<fs::path> seen;
  for (const fs::path& folder : folders_) {
    for (const fs::path& file : libraries_in(folder)) {
      std::error_code error;
      const fs::path real = fs::canonical(file, error);
      if (!seen.insert(error ? file : real).second) {
        continue;
      }
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
  }
  refuse_conflicts(libraries_);
}

Registry::~Registry() = default;

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
  return {names.begin(), names.end()};
}

const Library* Registry::offering(std::string_view kind, std::string_view name) const {
  const auto refuse = [&](const Library& library) {
    throw PluginError("the library of the " + std::string(kind) + " '" + std::string(name) +
                      "' is refused: " + library.file.string() + ": " + library.refused);
  };
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
  // Where a damaged library no longer says what it offers, its file's name still does.
  const std::string file = "libaltiplan_" + std::string(kind) + "_" + std::string(name) + ".so";
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
  const std::lock_guard lock(mutex_);
  std::unique_ptr<Loaded>& loaded = loaded_[library->file];
  if (!loaded) {
    // A damaged library can crash the dynamic loader, whose checks are few: a child goes first.
    in_child(library->file.string() + ": ", [&] { try_out(*library); });
    loaded = std::make_unique<Loaded>(Loaded{load_library(*library)});
  }
  return **std::find_if(
      loaded->entries.begin(), loaded->entries.end(),
      [&](const PluginEntry* entry) { return entry->kind == kind && entry->name == name; });
}

std::string Registry::not_offered(std::string_view kind, std::string_view name) const {
  const std::vector<std::string> present = names(kind);
  std::string text = "no library offers the " + std::string(kind) + " '" + std::string(name) + "'";
  const std::string near = nearest_name(name, present);
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
  text += near.empty() ? "" : "; did you mean '" + near + "'?";
  text += "; present: " + joined(present);
  std::vector<std::string> searched;
  for (const fs::path& folder : folders_) {
    searched.push_back(folder.string() + (fs::is_directory(folder) ? "" : " (no such folder)"));
  }
  text += "; searched: " + joined(searched);
  return text + (refused.empty() ? "" : "; refused: " + joined(refused));
}
}  // namespace altiplan::host
