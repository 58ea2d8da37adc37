// SPDX-License-Identifier: Apache-2.0
#include "study/workers/retries.hpp"

#include <signal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "study/workers/worker.hpp"

namespace altiplan::study {
namespace {

constexpr int kTries = 3;
constexpr int kTriesAtFaults = 5;
constexpr int kFaultsInARow = 6;
constexpr double kFirstPauseS =
    0.05;  ///< after a fault; each pause is twice as long as the previous one

/// Also true for a damaged record, which another process may have caused.
bool killed_from_outside(const Ended& ended) {
  constexpr std::array kFromOutside = {SIGKILL, SIGTERM, SIGINT, SIGHUP, SIGQUIT};
  return ended.how == Ending::garbled ||
         (ended.how == Ending::killed && std::ranges::count(kFromOutside, ended.signal) > 0);
}
}  // namespace

bool Retries::try_again(const Ended& ended) {
  if (killed_from_outside(ended)) {
    return ++tries_[ended.job] < kTries;
  }
  const Appraisal appraisal = options_.appraise ? options_.appraise(ended) : Appraisal{};
  switch (appraisal.verdict) {
    case Appraisal::final:
      break;
    case Appraisal::doubtful:
      if (std::exchange(causes_[ended.job], appraisal.cause) != appraisal.cause &&
          ++tries_[ended.job] < kTries) {
        return true;
      }
      break;
    case Appraisal::fault:
      fault(appraisal.cause);
      if (++tries_[ended.job] >= kTriesAtFaults) {
        give_up(appraisal.cause);
      }
      return true;
    case Appraisal::hopeless:
      give_up(appraisal.cause);
      return true;
  }
  faults_in_a_row_ = 0;
  return false;
}

void Retries::fault(const std::string& what) {
  if (is_paused()) {
    return;
  }
  paused_until_s_ = steady_s() + std::ldexp(kFirstPauseS, faults_in_a_row_);
  if (++faults_in_a_row_ >= kFaultsInARow) {
    give_up(what);
  } else if (options_.say && std::exchange(reported_, what) != what) {
    options_.say(what + "; trying again");
  }
}

bool Retries::is_last_try(std::size_t job) const {
  const auto tries = tries_.find(job);
  return tries != tries_.end() && tries->second == kTries - 1;
}

bool Retries::is_paused() const { return steady_s() < paused_until_s_; }
}  // namespace altiplan::study
