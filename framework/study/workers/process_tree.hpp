// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <vector>

namespace altiplan::study {

/// The processes that descend from a worker, including those in their own session and orphans.
///
/// They are found in two ways. Each is *marked* by its soft RLIMIT_RSS, a limit that Linux inherits
/// to children and across exec and otherwise ignores; and the children of those found are followed,
/// since a process may have changed the limit.
struct ProcessTree {
  pid_t root = 0;  ///< 0 for none: only marked processes
  std::uint64_t mark = 0;
  std::uint64_t mask = ~std::uint64_t(0);  ///< bits of the mark that count

  /// The running processes (without zombies), including the root.
  std::vector<pid_t> find() const;
  /// The root and its descendants: complete as long as the root adopts orphans.
  std::vector<pid_t> below_root() const;
  /// Stops all, so that none starts more, then kills them, repeatedly until none is left. Returns
  /// their maximum number. Reaps those that are children of this process, except `keep`.
  std::size_t kill(pid_t keep = 0) const;
};

bool is_marked(pid_t process, std::uint64_t mark, std::uint64_t mask);
/// Marks this process. False if its hard limit forbids it.
bool set_mark(std::uint64_t mark);

/// Children of all threads of the process.
std::vector<pid_t> children_of(pid_t process);

/// The resource use of one process.
struct ProcessUse {
  bool alive = false;
  double cpu_s = 0;  ///< with that of the children that it has waited for
  /// Anonymous and shared memory and swap, without file pages, which can be read again. Pages
  /// shared with other processes count in full.
  double memory_mb = 0;
  double file_mb = 0;
  double peak_resident_mb = 0;
};
ProcessUse use_of(pid_t process);

/// The same memory of one process, with a page that n processes share counted as 1/n.
double proportional_memory_mb(pid_t process);

/// CPU and memory of a whole tree; `memory_mb` without `base_mb`, the root's memory before.
struct TreeUse {
  std::size_t processes = 0;
  double cpu_s = 0;
  double memory_mb = 0;
};
TreeUse use_of(const std::vector<pid_t>& processes, double base_mb);
}  // namespace altiplan::study
