// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "altiplan/formats/input_file.hpp"
#include "commands.hpp"
#include "host/base/output_file.hpp"
#include "host/base/program.hpp"
#include "study/slurm/command.hpp"
#include "study/slurm/slurm.hpp"
#include "study/store/merge.hpp"
#include "study/store/place.hpp"
#include "study/store/store.hpp"

namespace altiplan::cli {
namespace fs = std::filesystem;
namespace {

struct SlurmArguments {
  std::string study;
  std::string out;
  double chunk_minutes = 20;
  std::optional<std::string> partition;
  bool dry_run = false;
  bool submit = false;
  int jobs = 1;
  int reuse = 1;
  bool traces = false;
  std::optional<double> sample;
  std::string filter;
  host::Overrides overrides;
  std::vector<std::string> sbatch;
};

/// Slurm's default MaxArraySize is 1001.
constexpr double kMaxShards = 1000;
/// Number of pairs of scenario and repetition that are run for an estimate, if there are as many.
constexpr double kSamplePairs = 5;
/// Memory of a task besides the limit of its runs.
constexpr double kOwnMemoryMb = 1024;

std::string decimal(double value) {
  char text[64];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return {text, end};
}

study::SlurmJob job_of(const SlurmArguments& arguments, const study::StudyPlan& plan) {
  study::SlurmJob job;
  job.program = fs::canonical("/proc/self/exe");
  job.study = plan.path;
  job.out = fs::absolute(arguments.out).lexically_normal();
  job.working_folder = fs::current_path();
  job.jobs = arguments.jobs;
  job.memory_mb = arguments.jobs * plan.file.budget.memory_mb + kOwnMemoryMb;
  auto& more = job.study_arguments;
  if (arguments.reuse > 1) {
    more.insert(more.end(), {"--reuse", std::to_string(arguments.reuse)});
  }
  if (arguments.traces) {
    more.push_back("--traces");
  }
  if (arguments.sample) {
    more.insert(more.end(), {"--sample", decimal(*arguments.sample)});
  }
  if (!arguments.filter.empty()) {
    more.insert(more.end(), {"--filter", arguments.filter});
  }
  for (const fs::path& folder : arguments.overrides.plugin_path) {
    more.insert(more.end(), {"--plugin-path", fs::absolute(folder).string()});
  }
  if (arguments.partition) {
    job.sbatch_arguments.push_back("--partition=" + *arguments.partition);
  }
  job.sbatch_arguments.insert(job.sbatch_arguments.end(), arguments.sbatch.begin(),
                              arguments.sbatch.end());
  return job;
}

/// The lines of a small file that an earlier call wrote; empty if there is none.
std::vector<std::string> lines_of(const fs::path& file) {
  std::vector<std::string> lines;
  if (!fs::exists(file)) {
    return lines;
  }
  formats::InputFile in(file.string());
  for (std::string line; std::getline(in, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// Throws Error if jobs of the study are queued: two tasks on one shard would block each other.
void expect_none_queued(const study::SlurmJob& job) {
  const std::string queued = study::still_queued(lines_of(job.folder() / "jobs"));
  if (!queued.empty()) {
    throw Error("jobs of this study are already queued: " + queued +
                "; wait for them or cancel them with scancel");
  }
}

/// The databases that an estimate can be based on. Throws Error if one belongs to another study.
std::vector<fs::path> stores_of(const study::SlurmJob& job, const study::StudyPlan& plan) {
  std::vector<fs::path> stores;
  std::error_code error;
  if (fs::exists(job.out, error)) {
    stores.push_back(job.out);
  }
  for (const auto& entry : fs::directory_iterator(job.folder(), error)) {
    if (entry.path().extension() == ".db") {
      stores.push_back(entry.path());
    }
  }
  std::sort(stores.begin(), stores.end());
  for (const fs::path& file : stores) {
    auto study = study::Store(file, study::StoreMode::read).study();
    if (!study.empty() && study["text"] != plan.text) {
      auto now = study;
      now["text"] = plan.text;
      throw Error("'" + file.string() + "' belongs to another study: " +
                  study::studies_differ(study, now) + "; remove it, or give --out another name");
    }
  }
  return stores;
}

/// Executes a few of the study's runs on this machine; returns their database.
fs::path take_sample(const study::SlurmJob& job, const study::StudyPlan& plan) {
  const double pairs = double(plan.scenarios.size()) * plan.file.repetitions;
  const double share = std::min(1.0, kSamplePairs / pairs);
  const fs::path file = job.folder() / "sample.db";
  std::vector<std::string> command{job.program.string(), "study",  job.study.string(),      "--out",
                                   file.string(),        "--jobs", std::to_string(job.jobs)};
  command.insert(command.end(), job.study_arguments.begin(), job.study_arguments.end());
  if (std::find(command.begin(), command.end(), "--sample") == command.end()) {
    command.insert(command.end(), {"--sample", decimal(share)});
  }
  info("no runs to estimate from: " + study::shell_text(command));
  const study::CommandResult result = study::run_command(command);
  if (result.code != 0) {
    throw Error("the sample for the time estimate ended with exit code " +
                std::to_string(result.code) + ": " + result.err);
  }
  return file;
}

/// The number of shards of an earlier call, so that its databases are continued; otherwise from the
/// estimated time of the runs (s).
int shards_of(const SlurmArguments& arguments, const study::SlurmJob& job,
              const study::StudyPlan& plan, double seconds) {
  const std::vector<std::string> before = lines_of(job.folder() / "shards");
  if (!before.empty()) {
    const int shards = std::atoi(before.front().c_str());
    if (shards < 1) {
      throw Error("'" + (job.folder() / "shards").string() + "': expected a number, found " +
                  excerpt(before.front()));
    }
    return shards;
  }
  const double wanted = std::ceil(seconds / job.jobs / (arguments.chunk_minutes * 60));
  const double max_shards = std::min(kMaxShards, double(plan.runs.size()));
  return int(std::clamp(wanted, 1.0, std::max(1.0, max_shards)));
}

void print_plan(const study::SlurmJob& job, const study::StudyPlan& plan, double seconds) {
  std::printf(
      "%zu runs, about %s minutes of computing time: %d task%s of %d process%s, about %s minutes "
      "each\n",
      plan.runs.size(), fixed(seconds / 60, 1).c_str(), job.shards, job.shards == 1 ? "" : "s",
      job.jobs, job.jobs == 1 ? "" : "es", fixed(seconds / 60 / job.shards / job.jobs, 1).c_str());
  std::printf("%s\n%s\n", job.array_file().c_str(), job.merge_file().c_str());
}

void submit_jobs(const study::SlurmJob& job, const study::StudyPlan& plan, double seconds) {
  const study::Submitted submitted = study::submit(job);
  host::write_file(job.folder() / "jobs", submitted.array + "\n" + submitted.merge + "\n");
  print_plan(job, plan, seconds);
  std::printf("submitted: array %s, then merge %s; the results will be in %s\n",
              submitted.array.c_str(), submitted.merge.c_str(), job.out.c_str());
}

int slurm(const SlurmArguments& arguments) {
  if (!arguments.dry_run && !host::find_on_path({"sbatch"})) {
    throw Error(
        "no sbatch on PATH: this machine cannot submit to Slurm (--dry-run only writes the "
        "scripts)");
  }
  expect_store_writable(arguments.out, "--out");
  const study::StudySelection selection{arguments.sample, arguments.filter, 1, 1};
  const study::StudyPlan plan =
      study::load_study(arguments.study, selection, arguments.overrides.plugin_path);
  if (plan.runs.empty()) {
    throw Error("--filter and --sample select no run of the study: expected at least one");
  }
  study::SlurmJob job = job_of(arguments, plan);
  fs::create_directories(job.folder());
  if (!arguments.dry_run) {
    expect_none_queued(job);
  }
  std::vector<fs::path> stores = stores_of(job, plan);
  double seconds = study::estimated_seconds(plan, stores);
  if (std::isnan(seconds)) {
    stores.push_back(take_sample(job, plan));
    seconds = study::estimated_seconds(plan, stores);
  }
  job.shards = shards_of(arguments, job, plan, seconds);
  // Twice the estimate, plus the time limit of the last run.
  const double chunk = std::max(arguments.chunk_minutes, seconds / 60 / job.shards / job.jobs);
  job.minutes = int(std::ceil(2 * chunk + plan.file.budget.wall_s / 60 + 2));
  host::write_file(job.folder() / "shards", std::to_string(job.shards) + "\n");
  host::write_file(job.array_file(), study::array_script(job));
  host::write_file(job.merge_file(), study::merge_script(job));
  if (arguments.dry_run) {
    print_plan(job, plan, seconds);
    std::printf("%s\n%s\n", study::shell_text(study::array_command(job)).c_str(),
                study::shell_text(study::merge_command(job, "ARRAY")).c_str());
    return kDone;
  }
  submit_jobs(job, plan, seconds);
  return kDone;
}

void add_selection(App& command, SlurmArguments& arguments) {
  command
      .add_option("--jobs", arguments.jobs, "parallel runs, and processors, per task (default 1)")
      ->check(Check::between(1, 1024));
  command
      .add_option("--reuse", arguments.reuse,
                  "runs per worker process, as for altiplan study (default 1)")
      ->check(Check::between(1, 1000000));
  command.add_flag("--traces", arguments.traces, "store search traces");
  command
      .add_option("--sample P", arguments.sample,
                  "fraction of the runs from 0 to 1, as for altiplan study")
      ->check(number_from(0, 1));
  command.add_option("--filter E", arguments.filter,
                     "regular expression for run names, as for altiplan study");
  add_plugin_path(command, arguments.overrides);
}
}  // namespace

void add_slurm(App& app, Action& action) {
  const auto prepare = [](SlurmArguments& arguments) {
    if (!arguments.sbatch.empty() && !arguments.sbatch.front().starts_with("-")) {
      throw UsageError{"sbatch: expected options of sbatch after --, found '" +
                       arguments.sbatch.front() + "'"};
    }
  };
  auto [command, arguments] = add_command<SlurmArguments>(
      app, action, "slurm", "run a study as a job array on a Slurm cluster", slurm, prepare);
  command.add_option("study", arguments.study, "study file (YAML)")->required();
  command.add_option("-o,--out DB", arguments.out, "results database (SQLite)")->required();
  command
      .add_option("--chunk-minutes M", arguments.chunk_minutes, "target duration of a task (min)")
      ->check(number_from(0.01, 100000))
      ->capture_default_str();
  command.add_option("--partition P", arguments.partition, "Slurm partition of the tasks");
  auto* dry = command.add_flag("--dry-run", arguments.dry_run,
                               "write the scripts and print the sbatch commands; submit nothing");
  command.add_flag("--submit", arguments.submit, "submit the jobs (default)")->excludes(dry);
  add_selection(command, arguments);
  command.add_option("sbatch", arguments.sbatch, "after --: additional sbatch options");
  set_example(command,
              "altiplan slurm study.yaml --out study.db --chunk-minutes 20 -- "
              "--account=uav");
}
}  // namespace altiplan::cli
