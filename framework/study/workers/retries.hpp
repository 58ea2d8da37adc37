// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "study/workers/worker_pool.hpp"

namespace altiplan::study {

/// Which jobs of a pool are done again, and when the pool gives up.
class Retries {
 public:
  explicit Retries(const PoolOptions& options) : options_(options) {}

  /// Whether that end may have been the work of another, or of the machine, and the job deserves
  /// another try: after the others, and the last one while no other runs, so that what is of this
  /// job alone is told apart.
  bool try_again(const Ended& ended);

  /// The machine has failed: what comes of a moment of that counts once, and nothing is to be
  /// started before a pause.
  void fault(const std::string& what);
  /// The pool is to end.
  void give_up(const std::string& why) { failure_ = failure_.empty() ? why : failure_; }

  /// Whether the job has been tried before.
  bool knows(std::size_t job) const { return tries_.contains(job); }
  bool is_last_try(std::size_t job) const;
  bool is_paused() const;
  const std::string& failure() const { return failure_; }  ///< "" while there is hope

 private:
  const PoolOptions& options_;
  std::map<std::size_t, int> tries_;           ///< that did not count
  std::map<std::size_t, std::string> causes_;  ///< of doubtful ends
  int faults_in_a_row_ = 0;
  double paused_until_s_ = 0;
  std::string said_;
  std::string failure_;
};
}  // namespace altiplan::study
