// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <vector>

namespace altiplan::study {

/// The processes that stem from a worker, also those that have begun a session of their own or
/// whose parents are gone.
///
/// They are found in two ways. Each is *marked* by its soft RLIMIT_RSS, a limit that Linux passes
/// on to children and programs and otherwise ignores; and the children of those found are followed,
/// as a process may have changed the limit.
struct ProcessTree {
  pid_t root = 0;  ///< 0 for none: marked ones alone
  std::uint64_t mark = 0;
  std::uint64_t mask = ~std::uint64_t(0);  ///< bits of the mark that count

  /// Those that have not ended (zombies have), the root among them.
  std::vector<pid_t> find() const;
  /// The root and those below it: all, as long as the root is there to take in orphans.
  std::vector<pid_t> below_root() const;
  /// Stops all, so that none makes more, then kills, and again, until none is left; they cannot
  /// refuse. How many there were at most. Reaps those that are children of this process, but leaves
  /// `keep` to the caller.
  std::size_t kill(pid_t keep = 0) const;
};

bool is_marked(pid_t process, std::uint64_t mark, std::uint64_t mask);
/// Marks this process. False where its hard limit forbids.
bool set_mark(std::uint64_t mark);

/// Children of all threads of the process.
std::vector<pid_t> children_of(pid_t process);

/// What one process uses.
struct ProcessUse {
  bool alive = false;
  double cpu_s = 0;  ///< with that of the children that it has waited for
  /// Anonymous and shared memory and swap; not pages of files, which can be read again. Pages that
  /// are shared with other processes count whole.
  double memory_mb = 0;
  double file_mb = 0;
  double peak_resident_mb = 0;
};
ProcessUse use_of(pid_t process);

/// The same memory of one process, with a page that n processes share counted as 1/n.
double proportional_memory_mb(pid_t process);

/// CPU and memory of a whole tree; `memory_mb` with `base_mb` taken off, what the root had before.
struct TreeUse {
  std::size_t processes = 0;
  double cpu_s = 0;
  double memory_mb = 0;
};
TreeUse use_of(const std::vector<pid_t>& processes, double base_mb);
}  // namespace altiplan::study
