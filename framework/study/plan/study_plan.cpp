// SPDX-License-Identifier: Apache-2.0
#include "study/plan/study_plan.hpp"

#include <dlfcn.h>

#include <map>

#include "altiplan/formats/iso_time.hpp"
#include "altiplan/kit/dubins/dubins.hpp"
#include "altiplan_build.hpp"
#include "host/base/machine_fault.hpp"
#include "host/base/sha256.hpp"
#include "host/mission/objective.hpp"
#include "host/plugins/registry.hpp"
#include "host/result/result_json.hpp"
#include "study/model/records.hpp"
#include "study/plan/study_grid.hpp"
#include "study/plan/study_reading.hpp"
#include "study/plan/study_selection.hpp"

namespace altiplan::study {
namespace fs = std::filesystem;
namespace {

std::string build_of(const fs::path& file) {
  const host::Library library = host::examine_library(file);
  if (library.build.empty()) {
    throw host::MachineFault(file.string() + ": " + library.refused);
  }
  return library.build;
}

/// Everything that the result of a pair depends on, except the seed.
std::string pair_text(const host::Config& config, const StudyBudget& budget) {
  std::string text = std::string(ALTIPLAN_VERSION) + "\n" + host_build() + "\n";
  text += flow_text(config.pipeline_tree) + "\n" + flow_text(config.scenario_tree) + "\n";
  for (const fs::path& file : config.files) {
    // Comments do not count: the trees of the two files are included above.
    if (file != config.pipeline_path && file != config.scenario_path) {
      text += host::sha256_of_present(file) + "\n";
    }
  }
  text += host::exact_json_text(host::plugins_json(config)) + "\n";
  text += host::exact_json_text({budget.wall_s, budget.cpu_s.value_or(0), budget.memory_mb}) + "\n";
  return text;
}

std::string key_of(const std::string& pair, const std::string& name, std::int64_t seed) {
  return host::sha256_of(pair + name + "\n" + std::to_string(seed));
}
}  // namespace

const std::string& host_build() {
  static const std::string kBuild = [] {
    std::string builds = build_of("/proc/self/exe");
    for (void* of_library :
         {reinterpret_cast<void*>(&nearest_name), reinterpret_cast<void*>(&kit::turn_sense),
          reinterpret_cast<void*>(&formats::iso_time)}) {
      if (Dl_info info{}; dladdr(of_library, &info) != 0) {
        builds += " " + build_of(info.dli_fname);
      }
    }
    return builds;
  }();
  return kBuild;
}

std::string name_of_run(const StudyPlan& plan, const PlannedRun& run) {
  return run_name(plan.pipelines[run.pipeline].name, plan.scenarios[run.scenario].name,
                  run.repetition);
}

host::Overrides overrides_of(const StudyPlan& plan, const PlannedRun& run,
                             const std::vector<fs::path>& plugin_path) {
  host::Overrides overrides;
  overrides.scenario = plan.scenarios[run.scenario].file;
  overrides.seed = run.seed;
  overrides.set = plan.pipelines[run.pipeline].set;
  const auto& of_scenario = plan.scenarios[run.scenario].set;
  overrides.set.insert(overrides.set.end(), of_scenario.begin(), of_scenario.end());
  overrides.plugin_path = plugin_path;
  return overrides;
}

StudyPlan load_study(const fs::path& study, const StudySelection& selection,
                     const std::vector<fs::path>& plugin_path) {
  StudyProblems problems;
  StudyVariants variants(problems);
  StudyPlan plan = read_study(study, problems, variants, plugin_path);
  plan.planned = plan.scenarios.size() * plan.pipelines.size() * std::size_t(plan.file.repetitions);
  plan.runs = selected_runs(plan, selection);
  std::map<std::pair<std::size_t, std::size_t>, std::string> pairs;
  for (PlannedRun& run : plan.runs) {
    const std::pair pair(run.scenario, run.pipeline);
    if (pairs.size() >= selection.max_checked && !pairs.contains(pair)) {
      ++plan.unchecked;
      continue;
    }
    std::string& text = pairs[pair];
    if (text.empty()) {
      try {
        const host::Config config = host::load_config(
            plan.pipelines[run.pipeline].file, overrides_of(plan, run, plugin_path), plan.registry);
        if (config.registry != plan.registry) {
          plan.registry = config.registry;
          plan.registries.push_back(config.registry);
        }
        host::expect_minimised(config);
        text = pair_text(config, plan.file.budget);
      } catch (const PluginError& error) {
        text = error.what();  // only its own runs are refused, one by one
      } catch (const ConfigError& error) {
        for (const Problem& problem : error.problems()) {
          problems.add(variants.placed(problem));
        }
        text = "wrong";
      }
    }
    run.key = key_of(text, name_of_run(plan, run), run.seed);
  }
  problems.finish();
  return plan;
}

std::string key_of(const host::Config& config, const StudyBudget& budget, const std::string& name,
                   std::int64_t seed) {
  return key_of(pair_text(config, budget), name, seed);
}

host::Config load_run(const StudyPlan& plan, const PlannedRun& run,
                      const std::vector<fs::path>& plugin_path) {
  return host::load_config(plan.pipelines[run.pipeline].file, overrides_of(plan, run, plugin_path),
                           plan.registry);
}
}  // namespace altiplan::study
