// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <atomic>
#include <deque>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>

#include "altiplan/error.hpp"
#include "host/plugins/script.hpp"
#include "host/plugins/script_object.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

/// A plugin of a file of Python; kept to the end of the process, as libraries are.
struct Script {
  fs::path file;
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

template <class Made>
std::unique_ptr<Made> make(const Script& script, const Value* source) {
  try {
    ParamReport report = describe(script, source, "");
    if (!report.problems.empty()) {
      throw ConfigError(std::move(report.problems));
    }
    Json values = Json::object();
    for (const BoundField& field : report.fields) {
      values[field.spec.name] = Json::parse(field.value_json);
    }
    return std::make_unique<Made>(
        ScriptSource{script.file, script.entry.kind, script.name, std::move(values)});
  } catch (const Error&) {
    throw;
  } catch (...) {
    attribute_to("");
  }
}

template <std::size_t N>
ParamReport describe_at(const Value* source, const std::string& path) {
  return describe(*the_scripts[N], source, path);
}
template <std::size_t N>
std::unique_ptr<Planner> planner_at(const Value* source) {
  return make<ScriptPlanner>(*the_scripts[N], source);
}
template <std::size_t N>
std::unique_ptr<Smoother> smoother_at(const Value* source) {
  return make<ScriptSmoother>(*the_scripts[N], source);
}

using Factories = std::tuple<decltype(PluginEntry::describe), decltype(PluginEntry::planner),
                             decltype(PluginEntry::smoother)>;
template <std::size_t... N>
constexpr std::array<Factories, sizeof...(N)> factories(std::index_sequence<N...>) {
  return {Factories{&describe_at<N>, &planner_at<N>, &smoother_at<N>}...};
}
constexpr std::array kFactories = factories(std::make_index_sequence<kMaxScripts>());

/// Called under the lock of load_script.
const PluginEntry& enter(const fs::path& file, const Json& told, bool smooths) {
  static std::deque<Script>& all = *new std::deque<Script>;
  if (all.size() == kMaxScripts) {
    throw PluginError(file.string() + ": a process loads at most " + std::to_string(kMaxScripts) +
                      " plugins written in Python");
  }
  ScriptParams params(told.at("parameters"));
  const auto& [describes, plans, smoothes] = kFactories[all.size()];
  Script& script = all.emplace_back();
  script.file = fs::absolute(file);
  script.name = told.at("name").get<std::string>();
  script.sentence = told.at("sentence").get<std::string>();
  script.params = std::move(params);
  script.entry.kind = smooths ? "smoother" : "planner";
  script.entry.name = script.name.c_str();
  script.entry.sentence = script.sentence.c_str();
  script.entry.describe = describes;
  if (smooths) {
    script.entry.smoother = smoothes;
  } else {
    script.entry.planner = plans;
  }
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
    const Json* told = nullptr;
    for (const Json& one : worker.plugins()) {
      told = one.at("name") == plugin.name && one.at("kind") == plugin.kind ? &one : told;
    }
    if (told == nullptr) {
      throw PluginError("announces the " + std::string(plugin.kind) + " '" + plugin.name +
                        "', but does not contain it");
    }
    entries.push_back(&enter(library.file, *told, std::string_view(plugin.kind) == "smoother"));
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
