// SPDX-License-Identifier: Apache-2.0
#include "host/base/unfinished.hpp"

#include <utility>

namespace altiplan::host {
namespace {

// Never destroyed: an interruption may arrive while the program exits.
std::recursive_mutex& mutex() {
  static auto* const kMutex = new std::recursive_mutex;
  return *kMutex;
}

std::list<std::function<void()>>& undos() {
  static auto* const kAll = new std::list<std::function<void()>>;
  return *kAll;
}
}  // namespace

std::unique_lock<std::recursive_mutex> uninterrupted() { return std::unique_lock(mutex()); }

Unfinished::Unfinished(std::function<void()> undo) {
  const auto lock = uninterrupted();
  at_ = undos().insert(undos().end(), std::move(undo));
}

Unfinished::~Unfinished() {
  const auto lock = uninterrupted();
  if (!finished_) {
    (*at_)();
    is_finished();
  }
}

void Unfinished::is_finished() {
  const auto lock = uninterrupted();
  if (!std::exchange(finished_, true)) {
    undos().erase(at_);
  }
}

void undo_unfinished() {
  uninterrupted().release();  // never unlocked again
  for (auto undo = undos().rbegin(); undo != undos().rend(); ++undo) {
    (*undo)();
  }
}
}  // namespace altiplan::host
