// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/unfinished.hpp"
#include "study/workers/process_tree.hpp"

namespace altiplan::study {

/// The end of a job of the worker pool.
enum class Ending {
  done,           ///< its record is complete
  threw,          ///< the work threw; the payload is the message
  exited,         ///< the process exited without a record
  killed,         ///< by a signal that the pool did not send
  garbled,        ///< its record is damaged
  too_large,      ///< the record, or another file that it wrote, exceeds the size limit
  out_of_memory,  ///< killed by the kernel for lack of memory
  wall_limit,     ///< killed by the pool with all its processes: …
  cpu_limit,      ///< …
  memory_limit,   ///< …
  process_limit,  ///< …
};

struct Ended {
  std::size_t job = 0;  ///< not set by WorkFolder::records
  std::string key;
  Ending how = Ending::done;
  std::string payload;  ///< what the work returned
  std::string
      crash_report;    ///< if it did not return: content of the file Job::crash_report, if written
  std::string note;    ///< …: the step or plugin at work (Job::note)
  std::string output;  ///< …: the last 2 kB of stdout and stderr
  int exit_code = 0;   ///< of `exited`
  int signal = 0;      ///< of `killed`
  double wall_s = 0;
  double cpu_s = 0;           ///< of all its processes
  double peak_memory_mb = 0;  ///< of all its processes, without the parent's memory at the fork
  int place = 0;              ///< run index in its process
  int left_behind = 0;        ///< number of processes still running after the job
};

/// The folder through which workers pass their records to the parent; one parent at a time.
///
/// Each worker appends records to its own file. A record has a magic word, lengths, a CRC-32 and
/// the content, so that a record truncated by a kill is detected. The next parent recovers from the
/// files what a killed parent had not stored.
class WorkFolder {
 public:
  /// Creates the folder if needed, locks it, and ends remaining processes of an earlier parent.
  /// Throws Error if the folder is not writable, or locked by another process, with its id.
  explicit WorkFolder(const std::filesystem::path& folder);
  /// Unlocks; removes the folder with its contents if all records were removed.
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  /// All complete records. Throws MachineFault if one cannot be read.
  std::vector<Ended> records() const;
  /// Removes the records. Call once they are stored.
  void clear();

  const std::filesystem::path& path() const { return path_; }
  int lock() const { return lock_; }  ///< the locked descriptor
  /// Name of a worker's file; "records" files stay until their records are stored.
  std::string file(std::size_t worker, std::string_view what) const;
  /// All processes of this folder's workers, of any parent.
  ProcessTree processes() const;
  /// The processes of one worker.
  ProcessTree processes(pid_t root, std::size_t worker) const;

 private:
  std::filesystem::path path_;  ///< absolute
  int lock_ = -1;
  std::uint64_t mark_ = 0;
  pid_t owner_;  ///< the parent, in a worker too
  std::optional<host::Unfinished> unfinished_;
};
}  // namespace altiplan::study
