// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/plan/study_plan.hpp"

namespace altiplan::study {

/// A study as an array of tasks, each running one shard, and a job that merges the shards.
struct SlurmJob {
  std::filesystem::path program;  ///< path of altiplan on the nodes
  std::filesystem::path study;    ///< absolute, like all paths here
  std::filesystem::path out;      ///< the database of all runs
  std::filesystem::path working_folder;
  int shards = 1;
  int minutes = 0;                            ///< time limit of a task, which is then requeued
  int jobs = 1;                               ///< parallel runs per task
  double memory_mb = 0;                       ///< per task
  std::vector<std::string> study_arguments;   ///< further arguments of `altiplan study`
  std::vector<std::string> sbatch_arguments;  ///< further arguments of sbatch, for both jobs

  /// The folder of scripts, logs and shards.
  std::filesystem::path folder() const { return out.string() + ".slurm"; }
  std::filesystem::path array_file() const { return folder() / "array.sbatch"; }
  std::filesystem::path merge_file() const { return folder() / "merge.sbatch"; }
  std::filesystem::path shard(int number) const;
};

std::string array_script(const SlurmJob& job);
std::string merge_script(const SlurmJob& job);
/// The sbatch commands; the merge job waits for all tasks of the job with the number `array`.
std::vector<std::string> array_command(const SlurmJob& job);
std::vector<std::string> merge_command(const SlurmJob& job, const std::string& array);
/// The command quoted for a shell.
std::string shell_text(const std::vector<std::string>& arguments);

struct Submitted {
  std::string array;
  std::string merge;
};
/// Submits both jobs. Throws Error with sbatch's message if it refuses one, and leaves nothing in
/// the queue.
Submitted submit(const SlurmJob& job);

/// The state of those jobs that are still queued, such as "12_[3-9] PENDING"; "" if there is none.
std::string still_queued(const std::vector<std::string>& jobs);

/// Estimated total time (s) of the plan's runs whose keys are not stored: from the mean of the
/// stored runs of the same pipeline and scenario, else of the same pipeline, else of all. NaN
/// without any stored run.
double estimated_seconds(const StudyPlan& plan, const std::vector<std::filesystem::path>& stores);
}  // namespace altiplan::study
