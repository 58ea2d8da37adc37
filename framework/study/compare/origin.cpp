// SPDX-License-Identifier: Apache-2.0
#include "study/compare/origin.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace altiplan::study {
namespace {

/// Contents of files by path, or builds of plugins by kind and name.
using Origins = std::map<std::string, std::string>;

Origins files_of(const host::Json& result) {
  Origins files;
  for (const host::Json& file : result.at("files")) {
    files[file.at("path").get<std::string>()] = file.at("sha256").get<std::string>();
  }
  return files;
}

Origins plugins_of(const host::Json& result) {
  Origins plugins;
  for (const host::Json& plugin : result.at("plugins")) {
    plugins[plugin.at("kind").get<std::string>() + " '" + plugin.at("name").get<std::string>() +
            "'"] = plugin.at("build").get<std::string>();
  }
  return plugins;
}

/// Calls `differ` for entries with different contents; keeps those that only one of them has.
template <class Differ>
void take_common(Origins& then, Origins& now, const Differ& differ) {
  for (auto was = then.begin(); was != then.end();) {
    const auto is = now.find(was->first);
    if (is == now.end()) {
      ++was;
      continue;
    }
    if (is->second != was->second) {
      differ(is->first);
    }
    now.erase(is);
    was = then.erase(was);
  }
}

/// Likewise for files of the same name in different folders, if each has only one: a study may have
/// been moved.
template <class Differ>
void take_moved(Origins& then, Origins& now, const Differ& differ) {
  const auto by_name = [](const Origins& files) {
    std::map<std::string, std::vector<std::string>> names;
    for (const auto& [path, content] : files) {
      names[std::filesystem::path(path).filename().string()].push_back(path);
    }
    return names;
  };
  const auto of_now = by_name(now);
  for (const auto& [name, paths] : by_name(then)) {
    const auto found = of_now.find(name);
    if (paths.size() != 1 || found == of_now.end() || found->second.size() != 1) {
      continue;
    }
    const std::string& path = found->second.front();
    if (then.at(paths.front()) != now.at(path)) {
      differ(path);
    }
    then.erase(paths.front());
    now.erase(path);
  }
}

void say_left(const Origins& then, const Origins& now, const char* quote,
              std::vector<std::string>& changed) {
  for (const auto& [what, was] : then) {
    changed.push_back(quote + what + quote + " is no longer used");
  }
  for (const auto& [what, is] : now) {
    changed.push_back(quote + what + quote + " is newly used");
  }
}

/// Compares the keys that the variants of the same name in both studies set.
void compare_sets(const char* kind, const StoredVariant& then,
                  const std::vector<StoredVariant>& now, std::vector<std::string>& changed) {
  const auto found = std::find_if(now.begin(), now.end(), [&](const StoredVariant& variant) {
    return variant.name == then.name;
  });
  if (found != now.end() && found->set != then.set) {
    changed.push_back(std::string(kind) + " '" + then.name + "' sets different keys");
  }
}

bool same_budget(const StudyBudget& one, const StudyBudget& other) {
  const auto all = [](const StudyBudget& b) {
    return std::tie(b.time_s, b.iterations, b.wall_s, b.cpu_s, b.memory_mb);
  };
  return all(one) == all(other);
}

std::vector<std::string> changed_results(const std::string& then, const std::string& now) {
  try {
    const host::Json before = host::parse_json(then);
    const host::Json after = host::parse_json(now);
    std::vector<std::string> changed = changed_origins(before, after);
    const std::string was = before.at("version").get<std::string>();
    const std::string is = after.at("version").get<std::string>();
    if (was != is) {
      changed.push_back("the first was made by altiplan " + was + ", the second by " + is);
    }
    return changed;
  } catch (const host::Json::exception&) {
    return {};  // a damaged result has no information on its inputs
  }
}
}  // namespace

std::vector<std::string> changed_origins(const host::Json& then, const host::Json& now) {
  std::vector<std::string> changed;
  Origins before = files_of(then);
  Origins after = files_of(now);
  const auto differ = [&](const std::string& path) {
    changed.push_back("'" + path + "' has changed since");
  };
  take_common(before, after, differ);
  take_moved(before, after, differ);
  say_left(before, after, "'", changed);
  before = plugins_of(then);
  after = plugins_of(now);
  take_common(before, after, [&](const std::string& plugin) {
    changed.push_back(plugin + " has been rebuilt since");
  });
  say_left(before, after, "", changed);
  return changed;
}

std::vector<std::string> changed_origins(const Comparison& comparison, const StudyData& first,
                                         const StudyData& second, const ResultOf& of_first,
                                         const ResultOf& of_second) {
  std::vector<std::string> all;
  const auto add = [&](const std::vector<std::string>& sentences) {
    for (const std::string& sentence : sentences) {
      if (std::find(all.begin(), all.end(), sentence) == all.end()) {
        all.push_back(sentence);
      }
    }
  };
  std::set<std::size_t> pipelines;
  std::set<std::size_t> scenarios;
  std::set<std::pair<std::size_t, std::string>> read;
  for (const OtherOrigin& pair : comparison.other_origins) {
    const StoredVariant& scenario = first.scenarios[pair.first->scenario];
    if (pipelines.insert(pair.first->pipeline).second) {
      compare_sets("pipeline", first.pipelines[pair.first->pipeline], second.pipelines, all);
    }
    if (scenarios.insert(pair.first->scenario).second) {
      compare_sets("scenario", scenario, second.scenarios, all);
    }
    if (read.contains({pair.first->pipeline, scenario.of})) {
      continue;
    }
    const std::string then = of_first(*pair.first);
    const std::string now = of_second(*pair.second);
    if (!then.empty() && !now.empty()) {
      read.insert({pair.first->pipeline, scenario.of});
      add(changed_results(then, now));
    }
  }
  if (!same_budget(first.file.budget, second.file.budget)) {
    add({"the budget differs"});
  }
  return all;
}
}  // namespace altiplan::study
