// SPDX-License-Identifier: Apache-2.0
#include "study/compare/replay.hpp"

#include <algorithm>
#include <map>

#include "altiplan/error.hpp"
#include "host/config/config.hpp"
#include "study/compare/origin.hpp"
#include "study/model/study_data.hpp"
#include "study/store/find_run.hpp"
#include "study/store/load_study.hpp"

namespace altiplan::study {
namespace {

StoredVariant variant_named(const std::vector<StoredVariant>& variants, const std::string& name,
                            const Store& store) {
  const auto found =
      std::find_if(variants.begin(), variants.end(),
                   [&](const StoredVariant& variant) { return variant.name == name; });
  if (found == variants.end()) {
    throw Error("'" + store.file().string() + "' is damaged: it does not say what '" + name +
                "' is");
  }
  return *found;
}

std::vector<std::string> what_changed(const host::Json& stored, const host::Json& now) {
  std::vector<std::string> changed = changed_origins(stored, now);
  const std::string then = stored.at("version").get<std::string>();
  if (stored.at("version") != now.at("version")) {
    changed.insert(changed.begin(), "this is altiplan " + now.at("version").get<std::string>() +
                                        ", the stored run was made by " + then);
  }
  return changed;
}

/// The result of the run without its inputs.
host::Json outcome_of(host::Json result) {
  for (const char* key : {"version", "files", "plugins"}) {
    result.erase(key);
  }
  return result;
}
}  // namespace

host::Config config_of(const Store& store, const StoredRun& run,
                       const std::vector<std::filesystem::path>& plugin_path) {
  const StoredVariant pipeline = variant_named(store.pipelines(), run.pipeline, store);
  const StoredVariant scenario = variant_named(store.scenarios(), run.scenario, store);
  host::Overrides overrides;
  overrides.scenario = scenario.file;
  overrides.seed = run.seed;
  overrides.set = pipeline.set;
  overrides.set.insert(overrides.set.end(), scenario.set.begin(), scenario.set.end());
  overrides.plugin_path = plugin_path;
  return host::load_config(pipeline.file, overrides);
}

StudyBudget budget_of(const Store& store) { return study_file(store).budget; }

Replayed compare_replay(const StoredRun& stored, const host::Json& result, const std::string& key) {
  if (stored.result.empty()) {
    const std::string status = result.at("status").get<std::string>();
    std::vector<std::string> changed;
    if (key != stored.key) {
      changed.push_back("a file, a plugin or the program has changed since the stored run");
    }
    return {changed, status == stored.outcome
                         ? std::nullopt
                         : std::optional(host::Difference{"status", stored.outcome, status})};
  }
  const host::Json before = host::json_or_discarded(stored.result);
  try {
    // As stored: invalid UTF-8 in a plugin's message has been replaced.
    const host::Json now = host::parse_json(host::file_text(result));
    std::vector<std::string> changed = what_changed(before, now);
    if (changed.empty() && key != stored.key) {
      changed.push_back("the program is another build than that of the stored run");
    }
    return {changed, host::first_difference(outcome_of(before), outcome_of(now))};
  } catch (const host::Json::exception&) {
    throw Error("the stored result of " + run_name(stored) + " is not a result of altiplan run");
  }
}
}  // namespace altiplan::study
