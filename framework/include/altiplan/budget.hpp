// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <stop_token>

namespace altiplan {

/// How far a call is, for another thread that watches it. Nothing may depend on it.
struct SearchProgress {
  std::atomic<std::uint64_t> expanded{0};   ///< iterations of the budget
  std::atomic<std::uint64_t> open{0};       ///< nodes on the open list, or in the tree; 0: none
  std::atomic<std::uint64_t> iteration{0};  ///< of a population or an anytime search, from 1
  std::atomic<double> best{
      std::numeric_limits<double>::infinity()};  ///< cost of the best route so far
};

/// Limits on what a call may use. One iteration is one unit of the planner's `expanded` counter.
struct Budget {
  using Clock = std::chrono::steady_clock;
  std::optional<Clock::time_point> deadline;
  std::uint64_t max_iterations = ~std::uint64_t{0};
  std::size_t max_memory_bytes = ~std::size_t{0};
  std::stop_token stop;
  SearchProgress* progress = nullptr;  ///< null where nobody watches

  /// To be called when a better route is found.
  void show_best(double cost) const {
    if (progress != nullptr) {
      progress->best.store(cost, std::memory_order_relaxed);
    }
  }
  void show_iteration(std::uint64_t iteration) const {
    if (progress != nullptr) {
      progress->iteration.store(iteration, std::memory_order_relaxed);
    }
  }
  void show_expanded(std::uint64_t expanded, std::uint64_t open) const {
    if (progress != nullptr && expanded > 0) {
      progress->expanded.store(expanded, std::memory_order_relaxed);
      progress->open.store(open, std::memory_order_relaxed);
    }
  }
};

/// Budget check, called once per iteration. The iteration limit is checked on every call; the stop
/// token and the clock on every call while iterations take a millisecond or more, else on down to
/// every 512th. Once spent, a budget stays spent. `open`, the number of nodes on the open list or
/// in the tree, is for those who watch.
class BudgetWatch {
 public:
  explicit BudgetWatch(const Budget& budget) : budget_(budget) {}
  bool spent(std::uint64_t iterations, std::uint64_t open = 0) {
    if (iterations >= budget_.max_iterations) {
      return true;
    }
    if (--calls_left_ > 0) {
      return false;
    }
    budget_.show_expanded(iterations, open);
    const Budget::Clock::time_point now = Budget::Clock::now();
    cancelled_ = budget_.stop.stop_requested();
    const bool ended = cancelled_ || (budget_.deadline && now >= *budget_.deadline);
    every_ = ended || now - asked_ >= std::chrono::milliseconds(1) ? 1 : std::min(2 * every_, 512);
    calls_left_ = every_;
    asked_ = now;
    return ended;
  }
  /// True if the stop token ended it, not a limit.
  bool cancelled() const { return cancelled_; }

 private:
  const Budget& budget_;
  Budget::Clock::time_point asked_ = Budget::Clock::now();
  int every_ = 1;
  int calls_left_ = 1;
  bool cancelled_ = false;
};
}  // namespace altiplan
