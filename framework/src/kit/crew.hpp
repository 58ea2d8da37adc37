// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace altiplan::kit {

/// Threads that live as long as a plan: an iteration is too short to start new ones.
class Crew {
 public:
  explicit Crew(std::size_t size) {
    failed_.resize(size);
    try {
      for (std::size_t n = 1; n < size; ++n) {
        others_.emplace_back([this, n] { live(n); });
      }
    } catch (const std::system_error&) {
      // No more threads are available: the existing ones do all the work.
    }
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;
  ~Crew() {
    work_ = nullptr;
    begin();
  }

  /// Runs `work` on every thread, this one as number 0; returns when all have finished, and
  /// rethrows an exception from any of them.
  void all_do(const std::function<void(std::size_t)>& work) {
    work_ = &work;
    busy_ = others_.size();
    begin();
    attempt(0);
    for (std::size_t busy = busy_; busy > 0; busy = busy_) {
      busy_.wait(busy);
    }
    for (std::exception_ptr& failed : failed_) {
      if (failed != nullptr) {
        std::rethrow_exception(std::exchange(failed, nullptr));
      }
    }
  }

 private:
  void begin() {
    ++round_;
    round_.notify_all();
  }
  void live(std::size_t n) {
    for (std::uint32_t done = 0;;) {
      round_.wait(done);
      done = round_;
      if (work_ == nullptr) {
        return;
      }
      attempt(n);
      if (--busy_ == 0) {
        busy_.notify_one();
      }
    }
  }
  void attempt(std::size_t n) {
    try {
      (*work_)(n);
    } catch (...) {
      failed_[n] = std::current_exception();
    }
  }

  const std::function<void(std::size_t)>* work_ = nullptr;
  std::atomic<std::uint32_t> round_{0};
  std::atomic<std::size_t> busy_{0};
  std::vector<std::exception_ptr> failed_;
  std::vector<std::jthread> others_;  // last: they use the members above
};
}  // namespace altiplan::kit
