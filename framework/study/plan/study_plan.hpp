// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host/config/config.hpp"
#include "study/model/study_file.hpp"

namespace altiplan::study {

/// A scenario or a pipeline with some of its keys set: one cell of the factor grid.
struct Variant {
  std::string name;  ///< unique in the study: "fusion[weight_g=0.3]", "hills[seed=17]"
  std::string of;    ///< the entry's id, or the scenario file's stem
  std::filesystem::path file;
  std::vector<std::string> set;  ///< as for --set, those of scenarios prefixed with "scenario."
};

/// One run of the study.
struct PlannedRun {
  std::size_t scenario = 0;  ///< index into StudyPlan::scenarios
  std::size_t pipeline = 0;
  int repetition = 0;     ///< from 0
  std::int64_t seed = 0;  ///< of (study seed, scenario, repetition): the same for every pipeline
  /// Hash of its name and of everything the result depends on: both files as resolved, the files
  /// that they name, the seed, the budget, the builds of the host and the plugins.
  std::string key;
};

struct StudyPlan {
  std::filesystem::path path;  ///< absolute
  std::string text;            ///< content of the file without comments and blanks
  std::string source;          ///< content of the file, unchanged
  StudyFile file;
  std::vector<Variant> scenarios;
  std::vector<Variant> pipelines;
  std::vector<PlannedRun> runs;              ///< those selected, in execution order: shuffled
  std::size_t planned = 0;                   ///< number of all runs of the study
  std::size_t unchecked = 0;                 ///< of the runs: those without a key
  std::shared_ptr<host::Registry> registry;  ///< of the last run planned
  std::vector<std::shared_ptr<host::Registry>>
      registries;  ///< all of them: files may name plugin folders
};

/// "PIPELINE SCENARIO #REPETITION"
std::string name_of_run(const StudyPlan& plan, const PlannedRun& run);

struct StudySelection {
  std::optional<double> sample;  ///< share of the (scenario, repetition) pairs, 0 … 1
  std::string filter;            ///< regular expression on "PIPELINE SCENARIO #REPETITION"
  int shard = 1;                 ///< of `shards`, from 1
  int shards = 1;
  std::set<std::string> pipelines = {};  ///< names of variants; empty: all
  std::string scenarios = {};            ///< Variant::of; "": all
  /// Maximum number of pairs of scenario and pipeline that are checked; the runs of others get no
  /// key.
  std::size_t max_checked = std::size_t(-1);
};

/// Reads and checks the study, and every pair of pipeline and scenario in it; throws ConfigError
/// with all problems.
StudyPlan load_study(const std::filesystem::path& study, const StudySelection& selection,
                     const std::vector<std::filesystem::path>& plugin_path);

/// The arguments of `altiplan run` that repeat the run.
host::Overrides overrides_of(const StudyPlan& plan, const PlannedRun& run,
                             const std::vector<std::filesystem::path>& plugin_path);

/// Build ids of the program and of the libraries that it shares with its plugins.
const std::string& host_build();

/// PlannedRun::key of the run of that name with this configuration.
std::string key_of(const host::Config& config, const StudyBudget& budget, const std::string& name,
                   std::int64_t seed);

/// The configuration of a run, as the worker runs it and `replay` repeats it.
host::Config load_run(const StudyPlan& plan, const PlannedRun& run,
                      const std::vector<std::filesystem::path>& plugin_path);
}  // namespace altiplan::study
