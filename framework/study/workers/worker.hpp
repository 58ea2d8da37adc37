// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "study/workers/worker_pool.hpp"

namespace altiplan::study {

/// A worker's status for its parent, in shared memory. A plugin may overwrite it: the parent uses
/// it only as a hint and trusts the records.
struct WorkerStatus {
  std::atomic<std::uint32_t> begun = 0;      ///< jobs of its batch that have begun
  std::atomic<std::uint32_t> handed_in = 0;  ///< records that it has written
  std::atomic<std::int64_t> began_ns = 0;  ///< start of the last of them, on the steady clock (ns)
  std::atomic<double> base_cpu_s = 0;      ///< CPU time of the process before it (s)
  std::atomic<double> base_memory_mb = 0;
  std::atomic<int> error = 0;  ///< errno if there is no record; `note` names the subject
  std::array<char, 512> note{};
};

/// Nanoseconds of the steady clock, which parent and worker share.
std::int64_t steady_ns();
/// The same in seconds.
inline double steady_s() { return double(steady_ns()) * 1e-9; }

/// The task of a worker.
struct WorkerTask {
  std::vector<std::size_t> batch;  ///< jobs, one after the other
  std::vector<std::string> keys;
  std::string records;       ///< the files for its records, …
  std::string crash_report;  ///< …
  std::string scratch;
  std::string group;  ///< file to enter its control group, if it has one
  std::uint64_t mark = 0;
  int output = -1;  ///< descriptor for stdout and stderr
  JobLimits limits;
  pid_t parent = 0;
};

/// The life of a worker, in the process that was forked for it.
[[noreturn]] void be_worker(const WorkerTask& task, WorkerStatus& board, const Work& work);
}  // namespace altiplan::study
