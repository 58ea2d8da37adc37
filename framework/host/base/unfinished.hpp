// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <list>
#include <mutex>

namespace altiplan::host {

/// Cleanup of something that an interruption must not leave behind: a half-written file, a
/// temporary folder, a process. `undo` is called if this object is destroyed before `is_finished`,
/// or by the interruption, on another thread; it must not throw.
class Unfinished {
 public:
  explicit Unfinished(std::function<void()> undo);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

  /// Cancels the cleanup.
  void is_finished();

 private:
  std::list<std::function<void()>>::iterator at_;
  bool finished_ = false;
};

/// While this lock is held, no interruption ends the process: for creating a resource together with
/// its Unfinished, and for actions that must complete. Recursive.
[[nodiscard]] std::unique_lock<std::recursive_mutex> uninterrupted();

/// Undoes everything unfinished, the latest first, and keeps the lock for good: the caller ends the
/// process.
void undo_unfinished();
}  // namespace altiplan::host
