// SPDX-License-Identifier: Apache-2.0
#include "run_watch.hpp"

#include <algorithm>
#include <cmath>

#include "commands.hpp"
#include "host/base/words.hpp"

namespace altiplan::cli {
namespace {

using host::grouped;
using host::readable;

/// "812", "12.3 k", "4.56 M".
std::string rough(std::uint64_t count) {
  return count < 10'000          ? grouped(count)
         : count < 1'000'000     ? readable(double(count) / 1e3, 3) + " k"
         : count < 1'000'000'000 ? readable(double(count) / 1e6, 3) + " M"
                                 : readable(double(count) / 1e9, 3) + " G";
}

/// "; best 28310.2; 1.2 M expanded, 34.5 k nodes", of what the step shows.
std::string how_far(const host::RunProgress& progress) {
  const SearchProgress& search = progress.search;
  std::string words;
  if (const double best = search.best; std::isfinite(best)) {
    words += "; best " + readable(best, 6);
  }
  if (const std::uint64_t iteration = search.iteration; iteration > 0) {
    words += "; iteration " + grouped(iteration);
  }
  if (const std::uint64_t expanded = search.expanded; expanded > 0) {
    words += "; " + rough(expanded) + " expanded";
  }
  if (const std::uint64_t open = search.open; open > 0) {
    words += ", " + rough(open) + " nodes";
  }
  if (const double flown_s = progress.flown_s; flown_s > 0) {
    words += "; " + duration(flown_s) + " flown";
  }
  return words;
}
}  // namespace

RunWatch::RunWatch(const host::Config& config, double timeout_s) : timeout_s_(timeout_s) {
  for (const host::StepEntry& step : config.steps) {
    note_budgets(step);
  }
}

void RunWatch::note_budgets(const host::StepEntry& step) {
  if (step.within_s) {
    budgets_.try_emplace(step.id, *step.within_s);
  }
  for (const host::StepEntry& other : step.otherwise) {
    note_budgets(other);
  }
}

void RunWatch::call(const host::RunResult& result) {
  if (has_begun_ && steps_ == result.steps.size()) {
    return;  // the same attempt of a step
  }
  has_begun_ = true;
  steps_ = result.steps.size();
  if (steps_ == 0) {
    activity_.begin("building the world");
    return;
  }
  const host::StepResult& step = result.steps.back();
  const auto budget = budgets_.find(step.id);
  const double budget_s = budget == budgets_.end() ? timeout_s_ : budget->second;
  activity_.begin([this, name = step.id + " (" + step.plugin + ")", budget_s](double seconds) {
    const double left = std::max(0.0, budget_s - seconds);
    return name + ": " + fixed(seconds, 0) + " s, " +
           (left < 100 ? fixed(left, 0) + " s" : duration(left)) + " left" + how_far(progress_);
  });
}
}  // namespace altiplan::cli
