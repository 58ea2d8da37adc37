// SPDX-License-Identifier: Apache-2.0
#include "study/slurm/slurm.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "altiplan/error.hpp"
#include "study/slurm/command.hpp"
#include "study/statistics/statistics.hpp"
#include "study/store/store.hpp"

namespace altiplan::study {
namespace fs = std::filesystem;
namespace {

/// A task that gains nothing from being started again must not be for ever.
constexpr int kMaxRestarts = 20;
/// In which a study ends its runs before Slurm ends the task.
constexpr int kGraceSeconds = 60;

std::string quoted(const std::string& text) {
  std::string word = "'";
  for (const char c : text) {
    word += c == '\'' ? "'\\''" : std::string(1, c);
  }
  return word + "'";
}

/// What sbatch takes for a job's name without a second thought.
std::string job_name(const SlurmJob& job) {
  std::string name = "altiplan-" + job.out.stem().string();
  for (char& c : name) {
    const bool kept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    c = kept || c == '_' || c == '.' ? c : '-';
  }
  return name;
}

std::vector<std::string> command(const SlurmJob& job, const std::string& log,
                                 const fs::path& script, const std::vector<std::string>& options) {
  std::string output = (job.folder() / "").string();
  for (std::size_t at = 0; (at = output.find('%', at)) != output.npos; at += 2) {
    output.insert(at, "%");  // sbatch's own sign
  }
  std::vector<std::string> all{"sbatch", "--parsable", "--chdir=" + job.working_folder.string(),
                               "--output=" + output + log};
  all.insert(all.end(), options.begin(), options.end());
  all.insert(all.end(), job.sbatch_arguments.begin(), job.sbatch_arguments.end());
  all.push_back(script.string());
  return all;
}

/// The number that sbatch gave the job.
std::string number_of_job(const std::vector<std::string>& arguments) {
  const CommandResult result = run_command(arguments);
  const std::string number = result.out.substr(0, result.out.find_first_of(";\n"));
  const bool is_number = !number.empty() && number.find_first_not_of("0123456789") == number.npos;
  if (result.code != 0 || !is_number) {
    std::string words = result.err.empty() ? result.out : result.err;
    while (words.ends_with('\n')) {
      words.pop_back();
    }
    std::replace(words.begin(), words.end(), '\n', ' ');
    throw Error("sbatch refused '" + arguments.back() + "' (exit code " +
                std::to_string(result.code) + "): " + words);
  }
  return number;
}

/// Sums by what is alike in runs; the mean of as near a kind as there is.
class Means {
 public:
  void add(const std::string& pipeline, const std::string& scenario, double seconds) {
    for (const std::string& kind : {pipeline + "\n" + scenario, pipeline, std::string()}) {
      sums_[kind] += seconds;
      ++counts_[kind];
    }
  }
  double mean(const std::string& pipeline, const std::string& scenario) const {
    for (const std::string& kind : {pipeline + "\n" + scenario, pipeline, std::string()}) {
      if (const auto count = counts_.find(kind); count != counts_.end()) {
        return sums_.at(kind) / double(count->second);
      }
    }
    return kNone;
  }

 private:
  std::map<std::string, double> sums_;
  std::map<std::string, int> counts_;
};
}  // namespace

fs::path SlurmJob::shard(int number) const {
  return folder() / ("shard-" + std::to_string(number) + ".db");
}

std::string shell_text(const std::vector<std::string>& arguments) {
  std::string text;
  for (const std::string& argument : arguments) {
    const bool plain =
        !argument.empty() && argument.find_first_not_of(
                                 "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                 "-_./=:,%+@") == argument.npos;
    text += (text.empty() ? "" : " ") + (plain ? argument : quoted(argument));
  }
  return text;
}

std::string array_script(const SlurmJob& job) {
  std::ostringstream script;
  script
      << "#!/bin/bash\n"
      << "#SBATCH --job-name=" << job_name(job) << "\n"
      << "#SBATCH --array=1-" << job.shards << "\n"
      << "#SBATCH --ntasks=1\n"
      << "#SBATCH --cpus-per-task=" << job.jobs << "\n"
      << "#SBATCH --mem=" << std::ceil(job.memory_mb) << "M\n"
      << "#SBATCH --time=" << job.minutes << "\n"
      << "#SBATCH --requeue\n"
      << "#SBATCH --open-mode=append\n"
      << "#SBATCH --signal=B:USR1@" << kGraceSeconds << "\n\n"
      << "# Each task runs a part of the study. One that is cancelled, preempted or out of time\n"
      << "# leaves its runs in its database; started again, it does the rest.\n"
      << "task=$SLURM_ARRAY_TASK_ID\n"
      << "out_of_time=false\n"
      << "trap 'out_of_time=true; kill -TERM $study' USR1\n"
      << shell_text({job.program.string(), "study", job.study.string(), "--out"}) << " "
      << quoted((job.folder() / "shard-").string()) << "\"$task.db\" \\\n"
      << "  --shard \"$task/" << job.shards << "\" --jobs " << job.jobs
      << (job.study_arguments.empty() ? "" : " ") << shell_text(job.study_arguments) << " &\n"
      << "study=$!\n"
      << "wait $study\n"
      << "code=$?\n"
      << "if $out_of_time; then\n"
      << "  wait $study\n"
      << "  code=$?\n"
      << "  if [[ $code -ne 0 && ${SLURM_RESTART_COUNT:-0} -lt " << kMaxRestarts << " ]]; then\n"
      << "    echo \"out of time: queued again\"\n"
      << "    scontrol requeue \"${SLURM_ARRAY_JOB_ID}_$task\" && sleep " << kGraceSeconds << "\n"
      << "  fi\n"
      << "fi\n"
      << "exit $code\n";
  return script.str();
}

std::string merge_script(const SlurmJob& job) {
  std::ostringstream script;
  script << "#!/bin/bash\n"
         << "#SBATCH --job-name=" << job_name(job) << "-merge\n"
         << "#SBATCH --ntasks=1\n"
         << "#SBATCH --requeue\n"
         << "#SBATCH --open-mode=append\n\n"
         << "# Runs that are in the database already stay in it.\n"
         << "out=" << quoted(job.out.string()) << "\n"
         << "shards=" << quoted((job.folder() / "shard-").string()) << "\n"
         << "stores=()\n"
         << "if [[ -e $out ]]; then stores+=(\"$out\"); fi\n"
         << "for ((task = 1; task <= " << job.shards << "; ++task)); do\n"
         << "  stores+=(\"$shards$task.db\")\n"
         << "done\n"
         << "exec " << shell_text({job.program.string()})
         << " merge \"${stores[@]}\" -o \"$out\"\n";
  return script.str();
}

std::vector<std::string> array_command(const SlurmJob& job) {
  return command(job, "task-%a.log", job.array_file(), {});
}

std::vector<std::string> merge_command(const SlurmJob& job, const std::string& array) {
  return command(job, "merge.log", job.merge_file(),
                 {"--dependency=afterok:" + array, "--kill-on-invalid-dep=yes"});
}

Submitted submit(const SlurmJob& job) {
  Submitted submitted;
  submitted.array = number_of_job(array_command(job));
  try {
    submitted.merge = number_of_job(merge_command(job, submitted.array));
  } catch (const Error&) {
    run_command({"scancel", submitted.array});
    throw;
  }
  return submitted;
}

std::string still_queued(const std::vector<std::string>& jobs) {
  std::string all;
  for (const std::string& job : jobs) {
    // Of a job that it has forgotten squeue says that its number is invalid.
    const CommandResult result =
        run_command({"squeue", "--noheader", "--jobs=" + job, "--format=%i %T"});
    std::istringstream lines(result.code == 0 ? result.out : "");
    for (std::string line; std::getline(lines, line);) {
      all += (all.empty() ? "" : ", ") + line;
    }
  }
  return all;
}

double estimated_seconds(const StudyPlan& plan, const std::vector<fs::path>& stores) {
  Means means;
  std::set<std::string> stored;
  for (const fs::path& file : stores) {
    for (const StoredRun& run : Store(file, StoreMode::read).runs()) {
      means.add(run.pipeline, run.scenario, run.wall_time_s);
      stored.insert(run.key);
    }
  }
  double seconds = 0;
  for (const PlannedRun& run : plan.runs) {
    const double mean =
        means.mean(plan.pipelines[run.pipeline].name, plan.scenarios[run.scenario].name);
    seconds += stored.contains(run.key) ? 0 * mean : mean;
  }
  return plan.runs.empty() ? 0 : seconds;
}
}  // namespace altiplan::study
