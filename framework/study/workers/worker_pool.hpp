// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/workers/work_folder.hpp"

namespace altiplan::study {

class ControlGroups;

/// Limits of a job, including all processes that it starts. At a limit all of them are killed.
struct JobLimits {
  double wall_s = 600;
  std::optional<double> cpu_s;
  std::optional<double> memory_mb;
  std::size_t processes = 1000;
  double file_mb = 1024;  ///< each file that it writes, its record included
};

/// The job's interface in the worker.
struct Job {
  std::size_t index = 0;
  int place = 0;  ///< run index in this process
  /// File for the report in case the process ends prematurely; read into Ended::crash_report.
  /// Absolute path; the file does not exist when the work begins.
  std::filesystem::path crash_report;
  /// A temporary file for the work, which removes it, e.g. for a trace.
  std::filesystem::path scratch;
  /// Notes the step or plugin at work from now on; survives the end of the process.
  std::function<void(std::string_view who)> note;
  /// Makes this the last job of the process.
  std::function<void()> retire;
};

/// Called in the worker; returns the payload of the job's record.
using Work = std::function<std::string(const Job&)>;
/// Called in the parent with ended jobs, to store them; their records are removed when it returns.
/// An exception from it ends the pool and passes to the caller of run.
using Keep = std::function<void(std::vector<Ended>)>;

/// The caller's assessment of a job's end.
struct Appraisal {
  enum {
    final,     ///< caused by the job
    doubtful,  ///< possibly caused by a transient fault of the machine: final when the
               ///< next try ends alike, or the third
    fault,     ///< caused by the machine: the job is retried several times
    hopeless,  ///< no job can be done any more
  } verdict = final;
  std::string cause;  ///< equal for ends that are alike; reported if it ends the call
};

struct PoolOptions {
  int jobs = 1;   ///< workers at a time
  int reuse = 1;  ///< jobs that a worker does, one after another, before it ends
  JobLimits limits;
  std::function<std::string(std::size_t)> key;  ///< identifies a job's record for the next parent
  double keep_every_s = 0.25;                   ///< how often `keep` is called
  /// All ends are final if this is not set. The end of a retried job is not kept.
  std::function<Appraisal(const Ended&)> appraise;
  std::function<void(const std::string&)> say;  ///< reports faults of the machine
};

/// Runs jobs in processes that may crash, hang, or exhaust memory.
///
/// Workers are forked without exec from this process, which must be single-threaded. A worker has
/// its own session, keeps no descriptor of the parent's, and is killed when the parent ends;
/// processes that it has started are then ended by the supervisor. If a worker receives a signal
/// that another process may have sent (SIGKILL, SIGTERM …), or if its record is damaged, its job is
/// retried, up to three times. If the machine fails (no process, no file), the pool waits and tries
/// again, for about two seconds.
class WorkerPool {
 public:
  WorkerPool(WorkFolder& folder, PoolOptions options);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  enum class Finish { all, interrupted };
  /// Runs the jobs in this order, and calls `keep` periodically. On SIGINT, SIGTERM and SIGHUP the
  /// current jobs are killed without an outcome, and ended ones are kept. Likewise if the machine
  /// keeps failing: throws Error with the cause.
  Finish run(const std::vector<std::size_t>& jobs, const Work& work, const Keep& keep);

  /// How limits are enforced: "process tree, every 20 ms", and cgroup v2 if available.
  std::string limits_kept() const;

 private:
  WorkFolder& folder_;
  PoolOptions options_;
  std::unique_ptr<ControlGroups> groups_;  ///< null where the system has delegated none
  std::size_t workers_started_ = 0;
};
}  // namespace altiplan::study
