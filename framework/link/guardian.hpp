// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <functional>

#include "link/mission_transfer.hpp"

namespace altiplan::link {

/// Makes sure that a vehicle is not left on a stale command: a process of its own that calls `hold`
/// when this one dies, or is late, while it commands.
class Guardian {
 public:
  /// `patience`: between calls of commanding(). Throws MachineFault if there can be no process.
  Guardian(const std::function<void()>& hold, Time max_silence);
  /// The same as dying.
  ~Guardian();
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  /// A command has been sent.
  void commanding();
  /// Nothing is commanded any more.
  void stand_down();

 private:
  int pipe_ = -1;
  pid_t process_ = -1;
};
}  // namespace altiplan::link
