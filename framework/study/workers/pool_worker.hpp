// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "study/workers/process_tree.hpp"
#include "study/workers/worker.hpp"

namespace altiplan::study {

/// A place for a worker, as the parent sees it: its process, its batch of jobs, what it has used.
class PoolWorker {
 public:
  PoolWorker();
  ~PoolWorker();
  PoolWorker(const PoolWorker&) = delete;
  PoolWorker& operator=(const PoolWorker&) = delete;

  bool busy() const { return process_ > 0; }
  pid_t process() const { return process_; }
  const WorkerTask& task() const { return task_; }

  /// Starts a process for the batch of the task; false where the system has none to give (errno).
  bool start(const WorkFolder& folder, std::size_t serial, WorkerTask task, const Work& work);

  /// Looks at what the job under way uses; the limit that it has gone beyond, if any. Also keeps
  /// what it writes to stderr from growing.
  std::optional<Ending> watch(const JobLimits& limits);
  /// Kills all its processes; the worker itself is still to be reaped.
  void kill() { tree_.kill(process_); }

  /// Jobs whose records have come since the last call. See unread.
  std::vector<Ended> take_records();
  /// The job under way when the process ended, or was killed; nullopt where it was between jobs.
  std::optional<Ended> unfinished(Ending how);
  /// After it was reaped: the processes that it has left behind are ended, and the place is free.
  /// How many there were. `others` are children of this process that are none of them.
  std::size_t clear_away(const std::vector<pid_t>& others);

  /// Jobs of the batch whose end is known.
  std::size_t known() const { return known_; }
  /// Whether it has begun with any.
  bool born() const { return board_->begun > 0; }
  /// Whether it has written a record that take_records has not found.
  bool lost_record() const { return board_->handed_in > known_; }
  int error() const { return board_->error; }
  /// What error() is of: "FILE: cannot be written".
  std::string note() const;
  /// What the machine has kept this process from reading, "FILE: cannot be read: …", when it was
  /// last asked for; "" where nothing that matters.
  const std::string& unread() const { return unread_; }
  void add_cpu(double seconds) { reaped_cpu_s_ += seconds; }

 private:
  std::string said() const;
  void look_at_job();
  std::string read(const std::string& file, std::size_t offset, std::size_t at_most);

  WorkerStatus* board_ = nullptr;  ///< shared with the process
  int said_ = -1;                ///< a file in memory: its stdout and stderr
  pid_t process_ = -1;
  WorkerTask task_;
  ProcessTree tree_;
  ProcessTree family_;  ///< of all workers
  std::size_t known_ = 0;
  std::size_t read_ = 0;  ///< bytes of its records
  std::string unread_;
  std::uint32_t seen_ = 0;  ///< the job that the following are of
  double peak_mb_ = 0;
  double cpu_s_ = 0;         ///< as last seen
  double reaped_cpu_s_ = 0;  ///< of the process and of those that it left, when they were reaped
};
}  // namespace altiplan::study
