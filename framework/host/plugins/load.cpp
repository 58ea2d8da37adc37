// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>

#include <algorithm>
#include <boost/core/demangle.hpp>
#include <boost/dll/shared_library.hpp>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <new>

#include "altiplan/error.hpp"
#include "host/base/in_child.hpp"
#include "host/base/machine_fault.hpp"
#include "host/base/words.hpp"
#include "host/plugins/checksum.hpp"
#include "host/plugins/private_copy.hpp"
#include "host/plugins/registry.hpp"
#include "host/scripts/script.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;
namespace {

/// A message of the loader with the name that it ends with ("undefined symbol: _ZN…") as C++ has
/// it.
std::string with_readable_symbol(const std::string& text) {
  const std::size_t at = text.rfind(" _Z");
  if (at == text.npos) {
    return text;
  }
  const std::string symbol = text.substr(at + 1);
  const std::string name = boost::core::demangle(symbol.c_str());
  return name == symbol ? text
                        : text.substr(0, at + 1) + name + " (" + symbol +
                              "): expected in one of the libraries that it is linked with";
}

/// Stays open to the end of the process: objects and exceptions of a plugin must never outlive its
/// code. Messages name `file`.
boost::dll::shared_library& open_for_ever(const fs::path& path, const fs::path& file) {
  static std::vector<std::unique_ptr<boost::dll::shared_library>>& open =
      *new std::vector<std::unique_ptr<boost::dll::shared_library>>;
  auto library = std::make_unique<boost::dll::shared_library>();
  boost::dll::fs::error_code error;
  errno = 0;  // the loader reports its failure only as text; errno keeps the cause
  library->load(path, error, boost::dll::load_mode::rtld_now | boost::dll::load_mode::rtld_local);
  if (error) {
    const int of_system = errno;
    // Boost's own text ends in an unrelated "Bad file descriptor".
    const char* reason = ::dlerror();
    std::string text = reason != nullptr ? reason : error.message();
    if (text.starts_with(path.string() + ": ")) {
      text.erase(0, path.string().size() + 2);
    }
    fail_to_use(file.string() + " cannot be loaded: " + with_readable_symbol(text), of_system);
  }
  return *open.emplace_back(std::move(library));
}

/// The run-path folders of the library that are relative to its own ($ORIGIN).
std::vector<fs::path> own_folders(const ElfFile& elf, const fs::path& folder) {
  std::vector<fs::path> folders;
  for (const std::int64_t tag : {DT_RPATH, DT_RUNPATH}) {
    for (std::string rest : elf.dynamic_texts(tag)) {
      while (!rest.empty()) {
        const std::string one = rest.substr(0, rest.find(':'));
        rest.erase(0, one.size() + 1);
        for (const std::string_view origin : {"$ORIGIN", "${ORIGIN}"}) {
          if (one.starts_with(origin)) {
            folders.push_back(folder.string() + one.substr(origin.size()));
          }
        }
      }
    }
  }
  return folders;
}

bool is_loaded(const std::string& name) {
  void* handle = ::dlopen(name.c_str(), RTLD_LAZY | RTLD_NOLOAD);
  if (handle != nullptr) {
    ::dlclose(handle);
  }
  return handle != nullptr;
}

/// A copy has no folder: the libraries that its $ORIGIN leads to are opened before it, each from a
/// copy too, and it finds them by their names (DT_SONAME).
void open_neighbours(const ElfFile& elf, const fs::path& folder) {
  const std::vector<fs::path> folders = own_folders(elf, folder);
  for (const std::string& name : elf.dynamic_texts(DT_NEEDED)) {
    const auto found = std::find_if(folders.begin(), folders.end(), [&](const fs::path& place) {
      return fs::is_regular_file(status_of(place / name));
    });
    if (found != folders.end() && !is_loaded(name)) {
      auto& copy = *new PrivateCopy(*found / name);  // never freed, like its library
      open_neighbours(ElfFile(copy.path()), *found);
      open_for_ever(copy.path_to_load(), *found / name);
    }
  }
}

/// Tools that look up libraries by name in the process's map (perf, valgrind) cannot find copies.
bool is_to_be_loaded_in_place() { return std::getenv("ALTIPLAN_PLUGINS_IN_PLACE") != nullptr; }

boost::dll::shared_library& open_copy(const Library& library, PrivateCopy& copy) {
  const fs::path file = fs::absolute(library.file);
  if (is_to_be_loaded_in_place()) {
    return open_for_ever(file, library.file);
  }
  try {
    open_neighbours(ElfFile(copy.path()), file.parent_path());
  } catch (const ElfError& error) {
    fail_to_use(library.file.string() + ": a library that it needs: " + error.what(),
                error.error());
  }
  return open_for_ever(copy.path_to_load(), library.file);
}

bool has_maker(const PluginEntry& entry) {
  const std::string_view kind = entry.kind;
  return entry.describe != nullptr &&
         ((kind == "environment" && entry.environment != nullptr) ||
          (kind == "constraint" && entry.constraint != nullptr) ||
          (kind == "planner" && entry.planner != nullptr) ||
          (kind == "local_planner" && entry.local_planner != nullptr) ||
          (kind == "smoother" && entry.smoother != nullptr) ||
          (kind == "tuner" && entry.tuner != nullptr) ||
          (kind == "objective" && entry.objective != nullptr) ||
          (kind == "task" && entry.task != nullptr));
}

/// Checks that the parameters have valid names: damaged data yields invalid ones.
void check_names(const FieldSpec& spec) {
  for (const FieldSpec& field : spec.children) {
    const bool nameless = spec.type == FieldType::list || field.type == FieldType::point ||
                          field.type == FieldType::plugin;
    if (!is_snake_case(field.name) && !(nameless && field.name.empty())) {
      throw PluginError("a parameter is named " + excerpt(field.name) +
                        ", expected lower-case letters, digits and '_'");
    }
    check_names(field);
  }
}

std::vector<const PluginEntry*> entries_of(const Library& library, PrivateCopy& copy) {
  boost::dll::shared_library& opened = open_copy(library, copy);
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
                        plugin.name + "', but does not contain it");
    }
    entries.push_back(*found);
  }
  return entries;
}

/// Uses the library as reading a configuration file will, as far as possible without one.
void try_out(const Library& library, PrivateCopy& copy) {
  for (const PluginEntry* entry : entries_of(library, copy)) {
    try {
      FieldSpec all;
      for (const ParamReport report = entry->describe(nullptr, "");
           const BoundField& field : report.fields) {
        all.children.push_back(field.spec);
      }
      check_names(all);
    } catch (const std::bad_alloc&) {
      throw;  // not the plugin's fault
    } catch (const std::exception& error) {
      throw PluginError(library.file.string() + ": describing the " + entry->kind + " '" +
                        entry->name + "': " + error.what());
    }
  }
}

/// Checks that the copy is what was examined: the file may change while it is examined and copied.
void verify(const Library& library, const PrivateCopy& copy) {
  const Library now = examine_library(copy.path());
  if (now.is_machine_fault) {
    throw MachineFault(library.file.string() + ": " + now.refused);
  }
  if (!now.refused.empty() || now.build != library.build || now.checksum != library.checksum) {
    throw PluginError(library.file.string() +
                      " has changed since this program started: run it again");
  }
  try {
    verify_checksum(ElfFile(copy.path()));
  } catch (const ElfError& error) {
    fail_to_use(library.file.string() + ": " + error.what(), error.error());
  }
}

struct Loaded {
  PrivateCopy copy;
  std::vector<const PluginEntry*> entries;
};
}  // namespace

std::vector<const PluginEntry*> load_library(const Library& library) {
  if (is_script(library.file)) {
    return load_script(library);
  }
  static std::mutex mutex;
  static std::map<std::string, Loaded>& loaded = *new std::map<std::string, Loaded>;
  const std::string key =
      fs::absolute(library.file).string() + " " + library.build + " " + library.checksum;
  const std::lock_guard lock(mutex);
  auto found = loaded.find(key);
  if (found == loaded.end()) {
    PrivateCopy copy(library.file);
    verify(library, copy);
    // Code that runs on loading may end the process: a child tries it first.
    in_child(library.file.string() + ": ", [&] { try_out(library, copy); });
    std::vector<const PluginEntry*> entries = entries_of(library, copy);
    found = loaded.emplace(key, Loaded{std::move(copy), std::move(entries)}).first;
  }
  return found->second.entries;
}

bool is_unchanged(const Library& library) {
  if (is_script(library.file)) {
    return examine_script(library.file).build == library.build;
  }
  try {
    const PrivateCopy copy(library.file);
    verify(library, copy);
    return true;
  } catch (const MachineFault&) {
    throw;
  } catch (const Error&) {
    return false;
  }
}
}  // namespace altiplan::host
