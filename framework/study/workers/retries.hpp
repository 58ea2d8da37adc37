// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "study/workers/worker_pool.hpp"

namespace altiplan::study {

/// Decides which jobs of a pool are retried, and when the pool gives up.
class Retries {
 public:
  explicit Retries(const PoolOptions& options) : options_(options) {}

  /// True if another job or the machine may have caused that end, and the job is to be retried:
  /// after the others, the last time while no other job runs, to isolate its own faults.
  bool try_again(const Ended& ended);

  /// Records a failure of the machine: simultaneous consequences count once, and nothing is started
  /// before a pause.
  void fault(const std::string& what);
  /// Ends the pool with a failure.
  void give_up(const std::string& why) { failure_ = failure_.empty() ? why : failure_; }

  /// True if the job has been tried before.
  bool knows(std::size_t job) const { return tries_.contains(job); }
  bool is_last_try(std::size_t job) const;
  bool is_paused() const;
  const std::string& failure() const { return failure_; }  ///< "" until the pool gives up

 private:
  const PoolOptions& options_;
  std::map<std::size_t, int> tries_;           ///< that are not counted
  std::map<std::size_t, std::string> causes_;  ///< of doubtful ends
  int faults_in_a_row_ = 0;
  double paused_until_s_ = 0;
  std::string reported_;
  std::string failure_;
};
}  // namespace altiplan::study
