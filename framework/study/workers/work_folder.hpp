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

/// How a job of the worker pool ended.
enum class Ending {
  done,           ///< its record is whole
  threw,          ///< the work threw; the payload is what it said
  exited,         ///< the process ended by itself, without a record
  killed,         ///< by a signal that the pool did not send
  garbled,        ///< there is a record, and it is not as it was written
  too_large,      ///< the record, or another file that it wrote, is larger than allowed
  out_of_memory,  ///< the kernel killed it for lack of memory
  wall_limit,     ///< the pool killed it, with all its processes: …
  cpu_limit,      ///< …
  memory_limit,   ///< …
  process_limit,  ///< …
};

struct Ended {
  std::size_t job = 0;  ///< not set in what WorkFolder::records returns
  std::string key;
  Ending how = Ending::done;
  std::string payload;     ///< what the work returned
  std::string crash_report;  ///< where it did not return: the file Job::crash_report, if it was written
  std::string note;        ///< …: who was at work (Job::note)
  std::string said;        ///< …: the last 2 kB that was written to stdout and stderr
  int exit_code = 0;       ///< of `exited`
  int signal = 0;          ///< of `killed`
  double wall_s = 0;
  double cpu_s = 0;           ///< of all its processes
  double peak_memory_mb = 0;  ///< of all its processes, without what the parent had before
  int place = 0;              ///< how many jobs its process had done before
  int left_behind = 0;        ///< processes that were still there when the job had ended
};

/// The folder through which workers hand their records to the parent, for one parent at a time.
///
/// A worker appends records to a file of its own. A record holds a magic word, the lengths, a
/// CRC-32 and the rest, so that one that was cut off by a kill is told from a whole one. What a
/// killed parent had not stored is found in the files by the next one.
class WorkFolder {
 public:
  /// Makes the folder where there is none, locks it, and ends what is left of the processes of an
  /// earlier parent. Throws Error where it cannot be written to, or where another process holds it,
  /// with that one's id.
  explicit WorkFolder(const std::filesystem::path& folder);
  /// Unlocks; the folder goes with what is in it where all records were removed.
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  /// All whole records, of jobs that were done. Throws MachineFault where one cannot be read.
  std::vector<Ended> records() const;
  /// Removes the records: to be called when they have been stored.
  void clear();

  const std::filesystem::path& path() const { return path_; }
  int lock() const { return lock_; }  ///< the locked descriptor
  /// Name of a worker's file; "records" are those that count, and stay until they are stored.
  std::string file(std::size_t worker, std::string_view what) const;
  /// All processes of this folder's workers, of whichever parent.
  ProcessTree processes() const;
  /// Those of one worker.
  ProcessTree processes(pid_t root, std::size_t worker) const;

 private:
  std::filesystem::path path_;  ///< absolute
  int lock_ = -1;
  std::uint64_t mark_ = 0;
  pid_t owner_;  ///< the parent, also when a worker asks
  std::optional<host::Unfinished> unfinished_;
};
}  // namespace altiplan::study
