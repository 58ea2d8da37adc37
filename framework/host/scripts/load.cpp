// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <atomic>
#include <deque>
#include <map>
#include <mutex>
#include <utility>

#include "altiplan/error.hpp"
#include "host/scripts/object.hpp"
#include "host/scripts/script.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;
namespace {

/// A plugin of a file of Python; kept to the end of the process, as libraries are.
struct Script {
  fs::path file;
  std::string kind;
  std::string name;
  std::string sentence;
  ScriptParams params;
  PluginEntry entry{};
};

// The factories of an entry are plain functions, which know nothing of a file: each script has its
// own, made for its place in this table.
constexpr std::size_t kMaxScripts = 256;
std::array<std::atomic<const Script*>, kMaxScripts> the_scripts{};

ParamReport describe(const Script& script, const Value* source, const std::string& path) {
  ScriptParams params = script.params;
  return bind(params, source, path);
}

/// What the plugin is made of; the parameters are checked.
ScriptSource source_of(const Script& script, const Value* source) {
  ParamReport report = describe(script, source, "");
  if (!report.problems.empty()) {
    throw ConfigError(std::move(report.problems));
  }
  Json values = Json::object();
  for (const BoundField& field : report.fields) {
    values[field.spec.name] = parse_json(field.value_json);
  }
  return {script.file, script.entry.kind, script.name, std::move(values)};
}

/// Exceptions that are not the framework's become PluginError.
template <class Make>
auto guarded(const Make& make) {
  try {
    return make();
  } catch (const Error&) {
    throw;
  } catch (...) {
    attribute_to("");
  }
}

std::unique_ptr<Environment> make_environment(const Script& script, const Value* source,
                                              const Site& site) {
  return guarded([&] { return script_environment(source_of(script, source), site); });
}
std::unique_ptr<Constraint> make_constraint(const Script& script, const Value* source) {
  return guarded([&] { return script_constraint(source_of(script, source)); });
}
std::unique_ptr<Objective> make_objective(const Script& script, const Value* source,
                                          const Site& site) {
  return guarded([&] { return script_objective(source_of(script, source), site); });
}
std::unique_ptr<Planner> make_planner(const Script& script, const Value* source) {
  return guarded([&] { return std::make_unique<ScriptPlanner>(source_of(script, source)); });
}
std::unique_ptr<Smoother> make_smoother(const Script& script, const Value* source) {
  return guarded([&] { return std::make_unique<ScriptSmoother>(source_of(script, source)); });
}

template <std::size_t N>
ParamReport describe_at(const Value* source, const std::string& path) {
  return describe(*the_scripts[N], source, path);
}
template <std::size_t N>
std::unique_ptr<Environment> environment_at(const Value* source, const Site& site) {
  return make_environment(*the_scripts[N], source, site);
}
template <std::size_t N>
std::unique_ptr<Constraint> constraint_at(const Value* source, const Site&) {
  return make_constraint(*the_scripts[N], source);
}
template <std::size_t N>
std::unique_ptr<Objective> objective_at(const Value* source, const Site& site) {
  return make_objective(*the_scripts[N], source, site);
}
template <std::size_t N>
std::unique_ptr<Planner> planner_at(const Value* source) {
  return make_planner(*the_scripts[N], source);
}
template <std::size_t N>
std::unique_ptr<Smoother> smoother_at(const Value* source) {
  return make_smoother(*the_scripts[N], source);
}

/// An entry with the factories of a place, of which a script keeps that of its kind.
template <std::size_t N>
constexpr PluginEntry entry_at() {
  PluginEntry entry{};
  entry.describe = &describe_at<N>;
  entry.environment = &environment_at<N>;
  entry.constraint = &constraint_at<N>;
  entry.objective = &objective_at<N>;
  entry.planner = &planner_at<N>;
  entry.smoother = &smoother_at<N>;
  return entry;
}
template <std::size_t... N>
constexpr std::array<PluginEntry, sizeof...(N)> entries(std::index_sequence<N...>) {
  return {entry_at<N>()...};
}
constexpr std::array kEntries = entries(std::make_index_sequence<kMaxScripts>());

void keep_factory_of_kind(PluginEntry& entry) {
  const std::string_view kind = entry.kind;
  entry.environment = kind == "environment" ? entry.environment : nullptr;
  entry.constraint = kind == "constraint" ? entry.constraint : nullptr;
  entry.objective = kind == "objective" ? entry.objective : nullptr;
  entry.planner = kind == "planner" ? entry.planner : nullptr;
  entry.smoother = kind == "smoother" ? entry.smoother : nullptr;
}

/// Called under the lock of load_script.
const PluginEntry& enter(const fs::path& file, const Json& reported) {
  static std::deque<Script>& all = *new std::deque<Script>;
  if (all.size() == kMaxScripts) {
    throw PluginError(file.string() + ": a process loads at most " + std::to_string(kMaxScripts) +
                      " plugins written in Python");
  }
  ScriptParams params(reported.at("parameters"));
  const PluginEntry& entry = kEntries[all.size()];
  Script& script = all.emplace_back();
  script.file = fs::absolute(file);
  script.kind = reported.at("kind").get<std::string>();
  script.name = reported.at("name").get<std::string>();
  script.sentence = reported.at("sentence").get<std::string>();
  script.params = std::move(params);
  script.entry = entry;
  script.entry.kind = script.kind.c_str();
  script.entry.name = script.name.c_str();
  script.entry.sentence = script.sentence.c_str();
  keep_factory_of_kind(script.entry);
  the_scripts[all.size() - 1] = &script;
  return script.entry;
}

std::vector<const PluginEntry*> entries_of(const Library& library) {
  const ScriptWorker worker(library.file);
  if (examine_script(library.file).build != library.build) {
    throw PluginError("has changed since this program started: run it again");
  }
  std::vector<const PluginEntry*> entries;
  for (const Manifest& plugin : library.plugins) {
    const Json* reported = nullptr;
    for (const Json& one : worker.plugins()) {
      reported = one.at("name") == plugin.name && one.at("kind") == plugin.kind ? &one : reported;
    }
    if (reported == nullptr) {
      throw PluginError("announces the " + std::string(plugin.kind) + " '" + plugin.name +
                        "', but does not contain it");
    }
    entries.push_back(&enter(library.file, *reported));
  }
  return entries;
}
}  // namespace

std::vector<const PluginEntry*> load_script(const Library& library) {
  static std::mutex mutex;
  static auto& loaded = *new std::map<std::string, std::vector<const PluginEntry*>>;
  const std::lock_guard lock(mutex);
  const std::string key = fs::absolute(library.file).string() + " " + library.build;
  const auto found = loaded.find(key);
  if (found != loaded.end()) {
    return found->second;
  }
  try {
    return loaded[key] = entries_of(library);
  } catch (const PluginError& error) {
    loaded.erase(key);
    throw PluginError(library.file.string() + ": " + error.what(), error.reason());
  }
}
}  // namespace altiplan::host
