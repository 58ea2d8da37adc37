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

/// What a job may take, with all the processes that it starts. At a limit all of them are killed.
struct JobLimits {
  double wall_s = 600;
  std::optional<double> cpu_s;
  std::optional<double> memory_mb;
  std::size_t processes = 1000;
  double file_mb = 1024;  ///< each file that it writes, its record included
};

/// A job as its work sees it, in the worker.
struct Job {
  std::size_t index = 0;
  int place = 0;  ///< how many jobs this process has done before
  /// Where to write what shall be known should the process end before its time; read into
  /// Ended::crash_report. Absolute, and not there when the work begins.
  std::filesystem::path crash_report;
  /// A file for the work to use and to remove again, e.g. for a trace.
  std::filesystem::path scratch;
  /// Who is at work from now on: kept where no end of the process can take it away.
  std::function<void(std::string_view who)> note;
  /// The process shall do no other job after this one.
  std::function<void()> retire;
};

/// Called in the worker; returns the payload of the job's record.
using Work = std::function<std::string(const Job&)>;
/// Called in the parent with jobs that have ended; when it returns they are safe, and their records
/// are removed. What it throws ends the pool and goes to the caller of run.
using Keep = std::function<void(std::vector<Ended>)>;

/// What the caller makes of a job's end.
struct Appraisal {
  enum {
    final,     ///< it is the job's own
    doubtful,  ///< a fault of the machine that has passed may have caused it: it is final when the
               ///< next try ends alike, or the third
    fault,     ///< the machine's fault caused it: the job is done again, some times
    hopeless,  ///< no job can be done any more
  } verdict = final;
  std::string cause;  ///< ends are alike that have the same; told where the call ends by it
};

struct PoolOptions {
  int jobs = 1;   ///< workers at a time
  int reuse = 1;  ///< jobs that a worker does, one after another, before it ends
  JobLimits limits;
  std::function<std::string(std::size_t)> key;  ///< of a job: names its record for the next parent
  double keep_every_s = 0.25;                   ///< how often `keep` is called
  /// All ends are final where this is not given. One that is done again is not kept.
  std::function<Appraisal(const Ended&)> appraise;
  std::function<void(const std::string&)> say;  ///< likewise: a fault of the machine, now and then
};

/// Runs jobs in processes that may crash, hang, or eat what they can get.
///
/// Workers are forked without exec from this process, which must have one thread only. A worker has
/// a session of its own, keeps no descriptor of the parent's, and is killed when the parent ends;
/// processes that it has started are then ended by the supervisor. One that gets a signal that the pool
/// has not sent, and that somebody else may have sent (SIGKILL, SIGTERM …), or whose record is
/// damaged, is not blamed for it at once: its job is done again, up to three times. Where the
/// machine fails (no process, no file), the pool waits a little and tries again, for two seconds or
/// so.
class WorkerPool {
 public:
  WorkerPool(WorkFolder& folder, PoolOptions options);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  enum class Finish { all, interrupted };
  /// Runs the jobs in this order, and calls `keep` now and then. On SIGINT, SIGTERM and SIGHUP the
  /// jobs under way are killed, without an outcome, and what had ended before is kept. Throws Error
  /// where the machine goes on failing, and what failed; then likewise.
  Finish run(const std::vector<std::size_t>& jobs, const Work& work, const Keep& keep);

  /// How limits are kept: "process tree, every 20 ms", and cgroup v2 where there is one.
  std::string limits_kept() const;

 private:
  WorkFolder& folder_;
  PoolOptions options_;
  std::unique_ptr<ControlGroups> groups_;  ///< null where the system has delegated none
  std::size_t workers_started_ = 0;
};
}  // namespace altiplan::study
