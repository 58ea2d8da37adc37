// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/plan/study_plan.hpp"

namespace altiplan::study {

/// A study as an array of tasks, each of which runs a shard, and a job that merges them.
struct SlurmJob {
  std::filesystem::path program;  ///< altiplan, as the nodes find it
  std::filesystem::path study;    ///< absolute, like all paths here
  std::filesystem::path out;      ///< the database of all runs
  std::filesystem::path working_folder;
  int shards = 1;
  int minutes = 0;                            ///< after which a task is stopped, and queued again
  int jobs = 1;                               ///< processes of a task
  double memory_mb = 0;                       ///< of a task
  std::vector<std::string> study_arguments;   ///< more of `altiplan study`
  std::vector<std::string> sbatch_arguments;  ///< more of sbatch, for both jobs

  /// Scripts, logs and shards.
  std::filesystem::path folder() const { return out.string() + ".slurm"; }
  std::filesystem::path array_file() const { return folder() / "array.sbatch"; }
  std::filesystem::path merge_file() const { return folder() / "merge.sbatch"; }
  std::filesystem::path shard(int number) const;
};

std::string array_script(const SlurmJob& job);
std::string merge_script(const SlurmJob& job);
/// The calls of sbatch; that of the merge waits for all of `array`, the other's number.
std::vector<std::string> array_command(const SlurmJob& job);
std::vector<std::string> merge_command(const SlurmJob& job, const std::string& array);
/// As a shell would read it.
std::string shell_text(const std::vector<std::string>& arguments);

struct Submitted {
  std::string array;
  std::string merge;
};
/// Submits both. Throws Error with sbatch's own words where it refuses; nothing is left in the
/// queue then.
Submitted submit(const SlurmJob& job);

/// The state of those of the jobs that are still in the queue, such as "12_[3-9] PENDING"; "" where
/// there is none.
std::string still_queued(const std::vector<std::string>& jobs);

/// Seconds that the runs of the plan will take, one after another, those left out whose keys are
/// stored: by the mean of the stored runs of the same pipeline and scenario, else of the same
/// pipeline, else of all. NaN without any stored run.
double estimated_seconds(const StudyPlan& plan, const std::vector<std::filesystem::path>& stores);
}  // namespace altiplan::study
