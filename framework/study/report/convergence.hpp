// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/model/progress.hpp"
#include "study/model/study_data.hpp"

namespace altiplan::study::report {

/// The trace of a run, "" if there is none.
using TraceSource = std::function<std::string(const RunRow&)>;

/// The 10th percentile, the median and the 90th percentile over runs; NaN without runs, infinite if
/// that share of the runs has no route.
struct Spread {
  double low = 0;
  double median = 0;
  double high = 0;
};

/// Of the values that are not NaN.
Spread spread_of(std::vector<double> values);

/// The convergence of the searches of a pipeline's step.
struct Convergence {
  std::size_t pipeline = 0;
  std::string step;
  bool is_only_step = true;  ///< of the pipeline
  std::size_t runs = 0;
  bool is_population = false;
  /// True if lengths are relative to the final best of their run, since scenarios differ in length.
  bool is_ratio = false;
  std::vector<double> iterations;
  std::vector<Spread> best;  ///< one per iteration; so far
  std::vector<Spread> mean;  ///< of the runs still going, as is `alive`
  std::vector<Spread> alive;
  Spread best_from;     ///< the first iteration with a best within 1 % of the final best
  Spread mean_from;     ///< the first one with a mean within 3 % of that best
  Spread alive_at_end;  ///< in the last iteration
};

/// The convergence of all runs with iterations in their trace, by pipeline and step.
std::vector<Convergence> convergence_of(const StudyData& data, const TraceSource& traces);
}  // namespace altiplan::study::report
