// SPDX-License-Identifier: Apache-2.0
#include "study/report/convergence.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "study/statistics/statistics.hpp"

namespace altiplan::study::report {
namespace {

constexpr std::size_t kMaxPoints = 150;  // of a figure
constexpr double kBestWithin = 1.01;
constexpr double kMeanWithin = 1.03;

/// The convergence of one run in one scenario.
using Run = std::vector<Iteration>;

/// The last iteration up to `number`; null before the first.
const Iteration* reached(const Run& run, double number) {
  const auto after = std::upper_bound(run.begin(), run.end(), number,
                                      [](double n, const Iteration& i) { return n < i.number; });
  return after == run.begin() ? nullptr : &*(after - 1);
}

/// Iteration numbers of all runs, evenly thinned.
std::vector<double> numbers_of(const std::vector<Run>& runs) {
  std::set<double> all;
  for (const Run& run : runs) {
    for (const Iteration& iteration : run) {
      all.insert(iteration.number);
    }
  }
  const std::vector<double> numbers(all.begin(), all.end());
  if (numbers.size() <= kMaxPoints) {
    return numbers;
  }
  std::vector<double> kept;
  for (std::size_t n = 0; n < kMaxPoints; ++n) {
    kept.push_back(numbers[n * (numbers.size() - 1) / (kMaxPoints - 1)]);
  }
  return kept;
}

/// The first iteration of a run for which `is_there` holds; infinite if none does.
template <typename Test>
double first(const Run& run, const Test& is_there) {
  const auto found = std::find_if(run.begin(), run.end(), is_there);
  return found == run.end() ? kInfinity : found->number;
}

void add_curves(Convergence& convergence, const std::vector<Run>& runs) {
  convergence.iterations = numbers_of(runs);
  for (const double number : convergence.iterations) {
    std::vector<double> best;
    std::vector<double> mean;
    std::vector<double> alive;
    for (const Run& run : runs) {
      const double unit = convergence.is_ratio ? run.back().best : 1;
      const Iteration* now = reached(run, number);
      const bool has_route = now != nullptr && std::isfinite(now->best);
      best.push_back(has_route ? now->best / unit : kInfinity);
      if (now != nullptr && number <= run.back().number) {
        mean.push_back(std::isfinite(unit) ? now->mean / unit : kNone);
        alive.push_back(now->alive);
      }
    }
    convergence.best.push_back(spread_of(best));
    convergence.mean.push_back(spread_of(mean));
    convergence.alive.push_back(spread_of(alive));
  }
}

Convergence convergence_of_runs(const std::vector<Run>& runs, bool is_ratio) {
  Convergence convergence;
  convergence.runs = runs.size();
  convergence.is_ratio = is_ratio;
  convergence.is_population =
      std::any_of(runs.begin(), runs.end(), [](const Run& run) { return run.front().alive >= 0; });
  add_curves(convergence, runs);
  std::vector<double> best_from;
  std::vector<double> mean_from;
  std::vector<double> alive;
  for (const Run& run : runs) {
    const double last = run.back().best;
    best_from.push_back(first(run, [&](const Iteration& i) {
      return std::isfinite(i.best) && i.best <= kBestWithin * last;
    }));
    mean_from.push_back(first(run, [&](const Iteration& i) {
      return std::isfinite(last) && i.mean <= kMeanWithin * last;
    }));
    alive.push_back(run.back().alive);
  }
  convergence.best_from = spread_of(best_from);
  convergence.mean_from = spread_of(mean_from);
  convergence.alive_at_end = spread_of(alive);
  return convergence;
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }),
               values.end());
  return {quantile(values, 0.1), median(values), quantile(values, 0.9)};
}

std::vector<Convergence> convergence_of(const StudyData& data, const TraceSource& traces) {
  std::map<std::size_t, std::map<std::string, std::vector<Run>>> runs;
  for (const RunRow& row : data.rows) {
    for (Progress& progress : progress_of(traces(row))) {
      runs[row.pipeline][progress.step].push_back(std::move(progress.iterations));
    }
  }
  std::vector<Convergence> all;
  for (const auto& [pipeline, steps] : runs) {
    for (const auto& [step, of_step] : steps) {
      all.push_back(convergence_of_runs(of_step, data.scenarios.size() > 1));
      all.back().pipeline = pipeline;
      all.back().step = step;
      all.back().is_only_step = steps.size() == 1;
    }
  }
  return all;
}
}  // namespace altiplan::study::report
