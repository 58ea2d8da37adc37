// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <list>
#include <mutex>

namespace altiplan::host {

/// What must not be left behind where the program is interrupted: a file that is half written, a
/// temporary folder, a process. `undo` is called when this object goes before `is_finished`, or by
/// the interruption, on another thread; it must not throw.
class Unfinished {
 public:
  explicit Unfinished(std::function<void()> undo);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

  /// There is nothing to undo any more.
  void is_finished();

 private:
  std::list<std::function<void()>>::iterator at_;
  bool finished_ = false;
};

/// While it is held no interruption ends the process: for making what must be undone together with
/// the note that it must, and for what has to happen as a whole. May be held more than once.
[[nodiscard]] std::unique_lock<std::recursive_mutex> uninterrupted();

/// Undoes all that is unfinished, the latest first, and lets nobody go on: the caller ends the
/// process.
void undo_unfinished();
}  // namespace altiplan::host
