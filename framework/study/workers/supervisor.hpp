// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include "study/workers/work_folder.hpp"

namespace altiplan::study {

/// A process beside the pool's parent that outlives it by a moment: whatever kills the parent, the
/// supervisor ends what the workers have started, and only then lets go of the folder's lock. (The
/// workers themselves the kernel kills with their parent.) It has a session of its own, so that no
/// signal to the parent's group meets it.
class Supervisor {
 public:
  explicit Supervisor(const WorkFolder& folder);
  ~Supervisor();  ///< it ends, as there is nothing left to watch
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  pid_t process() const { return process_; }
  /// In its place, after somebody has killed it and it has been reaped.
  void replace();

 private:
  void start();

  const WorkFolder& folder_;
  int leash_ = -1;  ///< end of a socket: when it closes, the parent is no more
  pid_t process_ = -1;
};
}  // namespace altiplan::study
