// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "study/workers/process_tree.hpp"
#include "study/workers/worker.hpp"

namespace altiplan::study {

/// A worker slot of the parent: its process, its batch of jobs, its resource use.
class PoolWorker {
 public:
  PoolWorker();
  ~PoolWorker();
  PoolWorker(const PoolWorker&) = delete;
  PoolWorker& operator=(const PoolWorker&) = delete;

  bool busy() const { return process_ > 0; }
  pid_t process() const { return process_; }
  const WorkerTask& task() const { return task_; }

  /// Starts a process for the batch of the task; false if the system refuses one (errno).
  bool start(const WorkFolder& folder, std::size_t serial, WorkerTask task, const Work& work);

  /// Checks the resource use of the current job; returns the limit that it exceeds, if any. Also
  /// truncates its stderr.
  std::optional<Ending> watch(const JobLimits& limits);
  /// Kills all its processes; the worker itself remains to be reaped.
  void kill() { tree_.kill(process_); }

  /// Jobs whose records have arrived since the last call. See unread.
  std::vector<Ended> take_records();
  /// The current job when the process ended or was killed; nullopt between jobs.
  std::optional<Ended> unfinished(Ending how);
  /// Call after it was reaped: ends the processes that it has left behind, frees the slot and
  /// returns their number. `others` are children of this process that do not belong to it.
  std::size_t clear_away(const std::vector<pid_t>& others);

  /// Jobs of the batch whose end is known.
  std::size_t known() const { return known_; }
  /// True if it has begun any job.
  bool born() const { return board_->begun > 0; }
  /// True if it has written a record that take_records has not found.
  bool lost_record() const { return board_->handed_in > known_; }
  int error() const { return board_->error; }
  /// The subject of error(): "FILE: cannot be written".
  std::string note() const;
  /// The last read that the machine refused, "FILE: cannot be read: …"; "" if none matters.
  const std::string& unread() const { return unread_; }
  void add_cpu(double seconds) { reaped_cpu_s_ += seconds; }

 private:
  std::string output() const;
  void look_at_job();
  std::string read(const std::string& file, std::size_t offset, std::size_t at_most);

  WorkerStatus* board_ = nullptr;  ///< shared with the process
  int output_ = -1;                ///< memory file with its stdout and stderr
  pid_t process_ = -1;
  WorkerTask task_;
  ProcessTree tree_;
  ProcessTree family_;  ///< of all workers
  std::size_t known_ = 0;
  std::size_t read_ = 0;  ///< bytes of its records
  std::string unread_;
  std::uint32_t seen_ = 0;  ///< the job of the following values
  double peak_mb_ = 0;
  double cpu_s_ = 0;         ///< at the last check
  double reaped_cpu_s_ = 0;  ///< of the process and its left-over processes, when reaped
};
}  // namespace altiplan::study
