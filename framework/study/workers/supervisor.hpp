// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include "study/workers/work_folder.hpp"

namespace altiplan::study {

/// A process that briefly outlives the pool's parent: whatever kills the parent, the supervisor
/// ends the processes that the workers have started, and only then releases the folder's lock. (The
/// kernel kills the workers themselves with their parent.) It has its own session, so that signals
/// to the parent's group do not reach it.
class Supervisor {
 public:
  explicit Supervisor(const WorkFolder& folder);
  ~Supervisor();  ///< ends it: nothing is left to watch
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  pid_t process() const { return process_; }
  /// Replaces it after it was killed and reaped.
  void replace();

 private:
  void start();

  const WorkFolder& folder_;
  int leash_ = -1;  ///< end of a socket, which closes when the parent ends
  pid_t process_ = -1;
};
}  // namespace altiplan::study
