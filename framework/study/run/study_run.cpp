// SPDX-License-Identifier: Apache-2.0
#include "study/run/study_run.hpp"

#include <algorithm>
#include <chrono>
#include <set>

#include "host/base/machine_fault.hpp"
#include "host/base/words.hpp"
#include "study/model/run_values.hpp"
#include "study/plan/study_selection.hpp"
#include "study/run/machine.hpp"
#include "study/run/study_worker.hpp"
#include "study/store/claim_history.hpp"
#include "study/store/place.hpp"
#include "study/store/store.hpp"
#include "study/workers/worker_pool.hpp"

namespace altiplan::study {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxProbes = 50;  // of pipelines: a dry run should not take long

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The runs of a plan and their store.
class Study {
 public:
  Study(const StudyPlan& plan, const StudyOptions& options) : plan_(plan), options_(options) {
    for (std::size_t i = 0; i < plan.runs.size(); ++i) {
      by_key_[plan.runs[i].key] = i;
    }
  }

  /// A run that has ended, as it is stored.
  StoredRun stored(const PlannedRun& run, const Ended& ended, std::int64_t session) const {
    const RunOutcome outcome = outcome_of(ended, plan_.file.budget);
    StoredRun row;
    row.key = run.key;
    row.scenario = plan_.scenarios[run.scenario].name;
    row.pipeline = plan_.pipelines[run.pipeline].name;
    row.repetition = run.repetition;
    row.seed = run.seed;
    row.outcome = name(outcome.outcome);
    row.message = outcome.message;
    row.wall_time_s = ended.wall_s;
    row.cpu_time_s = ended.cpu_s;
    row.peak_memory_mb = ended.peak_memory_mb;
    row.place = ended.place;
    row.session = session;
    row.result = options_.results ? outcome.result : "";
    row.trace = outcome.trace;
    row.values = outcome.values;
    for (const auto& value :
         {std::pair<std::string, double>{"solved", outcome.outcome == Outcome::solved},
          {"wall_time_s", ended.wall_s},
          {"cpu_time_s", ended.cpu_s},
          {"peak_memory_mb", ended.peak_memory_mb}}) {
      row.values.insert(std::lower_bound(row.values.begin(), row.values.end(), value), value);
    }
    return row;
  }

  Work work() const {
    return [this](const Job& job) {
      const PlannedRun& run = plan_.runs[job.index];
      const PlannedConfig planned{[&] { return load_run(plan_, run, options_.plugin_path); },
                                  [&](const host::Config& config) {
                                    return run.key == key_of(config, plan_.file.budget,
                                                             name_of_run(plan_, run), run.seed);
                                  }};
      return study_run(job, planned, plan_.file.budget, options_.traces);
    };
  }

  PoolOptions pool_options() const {
    PoolOptions pool;
    pool.jobs = options_.jobs;
    pool.reuse = options_.reuse;
    pool.limits = job_limits(plan_.file.budget);
    pool.key = [this](std::size_t i) { return record_key(plan_.runs[i]); };
    pool.appraise = [this](const Ended& ended) {
      return appraisal_of(ended, plan_.file.budget, name_of_run(plan_, plan_.runs[ended.job]));
    };
    pool.say = options_.say;
    return pool;
  }

  /// Identifies a record in the work folder: a later call may have selected other runs.
  std::string record_key(const PlannedRun& run) const {
    return run.key + " " + name_of_run(plan_, run);
  }

  const PlannedRun* find(const std::string& key) const {
    const auto found = by_key_.find(key);
    return found == by_key_.end() ? nullptr : &plan_.runs[found->second];
  }

  /// The study file may have grown (more seeds, another pipeline), but must not have lost stored
  /// runs.
  void expect_same_study(const Store& store) const {
    const auto names = [](const auto& variants) {
      std::set<std::string> all;
      for (const auto& variant : variants) {
        all.insert(variant.name);
      }
      return all;
    };
    const std::set<std::string> scenarios = names(plan_.scenarios);
    const std::set<std::string> pipelines = names(plan_.pipelines);
    std::size_t others = 0;
    std::string first;
    for (const StoredRun& run : store.outlines()) {
      if (!scenarios.contains(run.scenario) || !pipelines.contains(run.pipeline) ||
          run.repetition >= plan_.file.repetitions) {
        first = others++ == 0 ? run_name(run) : first;
      }
    }
    if (others > 0) {
      throw Error("'" + store.file().string() + "' contains " + host::counted(others, "run") +
                  " that this study does not have, such as " + first +
                  ": give another --out, or --fresh to start over");
    }
  }

  /// Assigns the store to this study, or throws Error if it belongs to another.
  void prepare(Store& store) const {
    if (!store.study().empty()) {
      expect_same_study(store);
    }
    store.set_study({{"name", plan_.file.name},
                     {"path", plan_.path.string()},
                     {"text", plan_.text},
                     {"source", plan_.source},
                     {"seed", std::to_string(plan_.file.seed)},
                     {"claims", claim_history(store, plan_.file, this_session().started)},
                     {"planned", std::to_string(plan_.planned)}});
    const auto as_stored = [](const std::vector<Variant>& variants) {
      std::vector<StoredVariant> all;
      for (const Variant& variant : variants) {
        all.push_back({variant.name, variant.of, variant.file.string(), variant.set});
      }
      return all;
    };
    store.add_variants(as_stored(plan_.scenarios), as_stored(plan_.pipelines));
    drop_outdated(store);
  }

  /// Indices of the runs whose keys are not among these.
  std::vector<std::size_t> without(const std::vector<std::string>& keys) const {
    const std::set<std::string> there(keys.begin(), keys.end());
    std::vector<std::size_t> left;
    for (std::size_t i = 0; i < plan_.runs.size(); ++i) {
      if (!there.contains(plan_.runs[i].key)) {
        left.push_back(i);
      }
    }
    return left;
  }

 private:
  /// Selects for repetition the runs made with other files, plugins or another program.
  void drop_outdated(Store& store) const {
    std::map<std::string, std::string> wanted;
    for (const PlannedRun& run : plan_.runs) {
      wanted[name_of_run(plan_, run)] = run.key;
    }
    std::vector<std::string> outdated;
    for (const StoredRun& run : store.outlines()) {
      const auto found = wanted.find(run_name(run));
      if (found != wanted.end() && found->second != run.key) {
        outdated.push_back(run.key);
      }
    }
    if (!outdated.empty()) {
      options_.say(host::counted(outdated.size(), "stored run") +
                   " out of date (inputs, budgets or binaries changed): running again" +
                   (plan_.runs.size() < plan_.planned
                        ? "; others that are not selected may be out of date too"
                        : ""));
      store.remove(outdated);
    }
  }

  const StudyPlan& plan_;
  const StudyOptions& options_;
  std::map<std::string, std::size_t> by_key_;
};

/// Runs use the libraries that the plan has loaded, even if their files change.
/// A file that is written slowly changes more than once: it is reported once.
void report_changes(const StudyPlan& plan, const StudyOptions& options,
                    std::set<fs::path>& reported) {
  for (const std::shared_ptr<host::Registry>& registry : plan.registries) {
    for (const fs::path& file : registry->changed()) {
      if (reported.insert(file).second) {
        options.say(file.string() +
                    " has changed since the study began: this call continues with the old library; "
                    "repeat the command to run with the new one");
      }
    }
  }
}

/// Recovers runs that a killed call made but did not store, of this selection or another; outdated
/// ones are detected by their keys when they are next selected.
std::size_t recover(const Study& study, const StudyPlan& plan, const WorkFolder& folder,
                    Store& store, std::int64_t session) {
  const std::vector<Ended> records = folder.records();
  if (records.empty()) {
    return 0;
  }
  std::map<std::string, PlannedRun> by_name;
  for (const PlannedRun& run : all_runs(plan)) {
    by_name[name_of_run(plan, run)] = run;
  }
  std::set<std::string> there;
  for (const StoredRun& run : store.outlines()) {
    there.insert(run_name(run));
  }
  std::vector<StoredRun> found;
  for (const Ended& ended : records) {
    const std::size_t space = ended.key.find(' ');
    const auto run = by_name.find(ended.key.substr(std::min(ended.key.size(), space + 1)));
    const bool is_final = appraisal_of(ended, plan.file.budget, "").verdict == Appraisal::final;
    if (run != by_name.end() && is_final && there.insert(run->first).second) {
      run->second.key = ended.key.substr(0, space);
      found.push_back(study.stored(run->second, ended, session));
    }
  }
  store.add(found);
  return found.size();
}
}  // namespace

StudyEnd run_study(const StudyPlan& plan, const StudyOptions& options) {
  const Clock::time_point start = Clock::now();
  const Study study(plan, options);
  WorkFolder folder(work_folder_of(options.store));  // locked before the store is touched
  if (options.fresh) {
    remove_store(options.store);
    folder.clear();
  }
  Store store(options.store, StoreMode::write);
  study.prepare(store);
  WorkerPool pool(folder, study.pool_options());
  StoredSession session = this_session();
  session.command = options.command;
  session.jobs = options.jobs;
  session.reuse = options.reuse;
  session.limits = pool.limits_kept();
  const std::int64_t session_id = store.add_session(session);
  if (const std::size_t found = recover(study, plan, folder, store, session_id)) {
    options.say("recovered " + host::counted(found, "unstored run") + " of the previous call");
  }
  folder.clear();
  const std::vector<std::size_t> left = study.without(store.keys());
  StudyProgress progress;
  progress.runs = plan.runs.size();
  progress.before = plan.runs.size() - left.size();
  options.progress(progress);
  std::set<fs::path> changed;
  const auto keep = [&](const std::vector<Ended>& ended) {
    std::vector<StoredRun> rows;
    for (const Ended& one : ended) {
      rows.push_back(study.stored(plan.runs[one.job], one, session_id));
      ++progress.outcomes[rows.back().outcome];
    }
    store.add(rows);
    progress.done += rows.size();
    progress.elapsed_s = since(start);
    report_changes(plan, options, changed);
    options.progress(progress);
  };
  const WorkerPool::Finish finish = pool.run(left, study.work(), keep);
  progress.elapsed_s = since(start);
  return {progress, finish == WorkerPool::Finish::interrupted};
}

StudyEstimate estimate_study(const StudyPlan& plan, const StudyOptions& options) {
  const Study study(plan, options);
  StudyEstimate estimate;
  std::vector<std::string> keys;
  double seconds = 0;
  if (!options.fresh && host::is_there(options.store)) {
    const Store store(options.store, StoreMode::read);
    study.expect_same_study(store);
    for (const StoredRun& run : store.outlines()) {
      if (study.find(run.key) != nullptr) {
        keys.push_back(run.key);
        seconds += run.wall_time_s;
      }
    }
  }
  const std::vector<std::size_t> left = study.without(keys);
  estimate.stored = keys.size();
  estimate.left = left.size();
  estimate.measured = keys.size();
  if (keys.empty() && !left.empty()) {
    std::map<std::size_t, std::size_t> first;  // of each pipeline
    for (const std::size_t i : left) {
      if (!plan.runs[i].key.empty() && first.size() < kMaxProbes) {
        first.emplace(plan.runs[i].pipeline, i);
      }
    }
    std::vector<std::size_t> probes;
    for (const auto& [pipeline, run] : first) {
      probes.push_back(run);
    }
    WorkFolder folder(options.store.string() + ".probe");
    PoolOptions pool_options = study.pool_options();
    pool_options.reuse = 1;
    WorkerPool pool(folder, pool_options);
    pool.run(probes, study.work(), [&](const std::vector<Ended>& ended) {
      for (const Ended& one : ended) {
        seconds += one.wall_s;
        ++estimate.measured;
      }
    });
    folder.clear();
    estimate.is_probed = true;
  }
  estimate.run_s = estimate.measured > 0 ? seconds / double(estimate.measured) : 0;
  estimate.total_s = estimate.run_s * double(estimate.left) / double(options.jobs);
  return estimate;
}
}  // namespace altiplan::study
