// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "python/bindings.hpp"

namespace altiplan::python {

/// What a thread hands over: a value or an exception, the first of them alone.
template <class T>
class Outcome {
 public:
  void give(T value) {
    set([&] { value_.emplace(std::move(value)); });
  }
  void fail(std::exception_ptr error) {
    set([&] { error_ = std::move(error); });
  }
  /// True once there is one.
  bool wait(std::chrono::milliseconds max_wait) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, max_wait, [&] { return is_there_; });
  }
  T take() {
    const std::lock_guard lock(mutex_);
    if (error_) {
      std::rethrow_exception(error_);
    }
    return std::move(*value_);
  }
  /// The thread has nothing more to do.
  void finish() { finished_ = true; }
  bool is_finished() const { return finished_; }

 private:
  template <class Set>
  void set(const Set& apply) {
    const std::lock_guard lock(mutex_);
    if (!std::exchange(is_there_, true)) {
      apply();
    }
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_there_ = false;
  std::optional<T> value_;
  std::exception_ptr error_;
  std::atomic<bool> finished_ = false;
};

/// Waits without the interpreter's lock until `wait` returns true. If a signal's handler raises
/// meanwhile, as Ctrl-C does, requests a stop, waits for a short while, and returns what was
/// raised.
std::optional<py::error_already_set> attend(
    const std::function<bool(std::chrono::milliseconds)>& wait, const std::stop_source& stop);

/// Does the work in a thread of its own, so that the calling thread can attend to Ctrl-C. `work`
/// gets an outcome, for a value that is ready before it returns (if ever), and a stop token. It
/// must not hold Python objects. A thread that does not end is left to itself.
template <class T>
T attended(std::function<T(const std::shared_ptr<Outcome<T>>&, const std::stop_token&)> work) {
  const auto outcome = std::make_shared<Outcome<T>>();
  std::stop_source stop;
  std::thread thread([outcome, stop, work = std::move(work)]() mutable {
    try {
      T value = work(outcome, stop.get_token());
      work = nullptr;  // nothing of it outlives the outcome
      outcome->finish();
      outcome->give(std::move(value));
    } catch (...) {
      outcome->finish();
      outcome->fail(std::current_exception());
    }
  });
  const auto raised =
      attend([&](std::chrono::milliseconds max_wait) { return outcome->wait(max_wait); }, stop);
  if (outcome->is_finished()) {
    const py::gil_scoped_release released;
    thread.join();
  } else {
    thread.detach();
  }
  if (raised) {
    throw *raised;
  }
  return outcome->take();
}
}  // namespace altiplan::python
